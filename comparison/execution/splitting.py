"""A tile cut in two and its answer put together again: how the points that kill a worker are found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from comparison.study.batches import Answer, Tile


def halves(tile: Tile) -> list[Tile]:
    """The two halves of the tile's phases; nothing for a single point."""
    middle = len(tile.phases) // 2
    if not middle:
        return []
    late = replace(tile, first=tile.first + middle, phases=tile.phases[middle:])
    return [replace(tile, phases=tile.phases[:middle]), late]


def joined(tile: Tile, answers: Sequence[Answer]) -> Answer:
    """The answer of the tile from those of its parts, in order; costs add up, complaints are kept once each."""
    mu, error, instant, cap_share = (
        np.concatenate([getattr(answer, name) for answer in answers])
        for name in ("mu", "error", "instant", "cap_share")
    )
    status = [outcome for answer in answers for outcome in answer.status]
    fault = "; ".join(dict.fromkeys(answer.fault for answer in answers if answer.fault))
    return Answer(mu, error, status, instant, sum(answer.cost for answer in answers), fault, cap_share)
