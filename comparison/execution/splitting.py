"""A batch cut in two and its answer put together again: how the points that kill a worker are found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from comparison.study.batches import Batch, BatchResult


def split_batch(batch: Batch) -> list[Batch]:
    """The two halves of the batch's phases; nothing for a single point."""
    middle = len(batch.phases) // 2
    if not middle:
        return []
    late = replace(batch, first=batch.first + middle, phases=batch.phases[middle:])
    return [replace(batch, phases=batch.phases[:middle]), late]


def merge(batch: Batch, answers: Sequence[BatchResult]) -> BatchResult:
    """The answer of the batch from those of its parts, in order; costs add up, complaints are kept once each."""
    mu, error, instant, cap_share = (
        np.concatenate([getattr(answer, name) for answer in answers])
        for name in ("mu", "error", "instant", "cap_share")
    )
    status = [outcome for answer in answers for outcome in answer.status]
    error_message = "; ".join(dict.fromkeys(answer.error_message for answer in answers if answer.error_message))
    return BatchResult(mu, error, status, instant, sum(answer.cost for answer in answers), error_message, cap_share)
