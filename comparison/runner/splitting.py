"""A batch cut in two and its answer put together again: how the points that kill a worker are found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from comparison.study.batches import Batch, BatchResult


def split_batch(batch: Batch) -> list[Batch]:
    """
    The two halves of a batch's phases.

    Parameters
    ----------
    batch : Batch

    Returns
    -------
    list of Batch
        Empty for a single point.
    """
    middle = len(batch.phases) // 2
    if not middle:
        return []
    late = replace(batch, first=batch.first + middle, phases=batch.phases[middle:])
    return [replace(batch, phases=batch.phases[:middle]), late]


def merge(batch: Batch, answers: Sequence[BatchResult]) -> BatchResult:
    """
    The answer of a batch from those of its parts.

    Parameters
    ----------
    batch : Batch
    answers : sequence of BatchResult
        In the order of their phases.

    Returns
    -------
    BatchResult
        Costs added up; each error message once.
    """
    mu, error, instant, displacement = (
        np.concatenate([getattr(answer, name) for answer in answers])
        for name in ("mu", "error", "instant", "displacement")
    )
    status = [outcome for answer in answers for outcome in answer.status]
    error_message = "; ".join(dict.fromkeys(answer.error_message for answer in answers if answer.error_message))
    return BatchResult(mu, error, status, instant, sum(answer.cost for answer in answers), error_message, displacement)
