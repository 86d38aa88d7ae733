"""
Waterfall of one body: the total difference as signed bars that add up, one for each effect of the model sequence.

A bar is the mean difference of two successive models, relative to the first of all models, over the finest grid of
phases that both have. The total is a mean over the grid of the coarsest model. What the bars leave of it, because their
grids are finer, is a bar of its own.
"""

from dataclasses import replace
from typing import Annotated

from comparison.result_types import Number, Phases, Text, result
from comparison.study.models import Pair
from comparison.surfaces.body_comparison import BodyComparison
from comparison.surfaces.differences import Difference
from comparison.surfaces.model_difference import RESOLVED_RATIO

NAN = float("nan")
UNEQUAL_PHASES = "phases"  # key of the bar for what remains because the models have different phase pairs
MAX_ROUNDING_SHARE = 1e-9  # share of the amplification mu: a smaller remainder is rounding and has no bar


@result
class WaterfallBar:
    """Size of one effect, by which successive models differ, or of the total; relative to the first of all models."""

    model: Annotated[str, "key of the model that the effect leads to; phases for phase pairs that not all models have"]
    size: Annotated[Number, "signed size; null where a model has no value"]
    error: Annotated[Number, "error estimate of the size, sampling of the phases included"]
    resolved: Annotated[bool, "whether the size exceeds the sampling error, and five times the numerical one"]


@result
class LargestDifference:
    """Largest absolute difference of an engine model and the first model, split into effects at its phase pair."""

    bars: tuple[WaterfallBar, ...]
    """one per effect, up to the model that has the difference; they add up to the total"""
    total: Annotated[WaterfallBar, "the difference itself"]
    phases: Annotated[Phases, "(alpha1, alpha2), rad; null under a record"]
    phases_per_axis: int
    """of the grid of phase pairs that both models were asked for; 1 under a record, 0 without a difference"""


@result
class Waterfall:
    """Total difference of one body between the first and the last model, as signed bars that add up to it."""

    scene: Annotated[Text, "name of the scene"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    bars: tuple[WaterfallBar, ...]
    """one per effect, each the mean over the finest grid of phases that both of its models have, and what they leave"""
    total: Annotated[WaterfallBar, "mean of the total over the phase pairs of its models: the sum of the bars"]
    largest: Annotated[LargestDifference, "the same at the phase pair of the largest difference"]


def make_waterfall(comparison: BodyComparison) -> Waterfall:
    """Return the total difference of one body as bars, one for each effect, that add up to it."""
    total = comparison.total
    bars = [_mean_bar(row) for row in comparison.consecutive_rows]
    left = total.mean - sum(bar.size for bar in bars)
    if abs(left) > MAX_ROUNDING_SHARE:
        bars.append(WaterfallBar(model=UNEQUAL_PHASES, size=left, error=abs(left), resolved=False))
    return Waterfall(
        scene=comparison.scene.name,
        body=comparison.body,
        bars=tuple(bars),
        total=_mean_bar(total),
        largest=find_largest_difference(comparison),
    )


def find_largest_difference(comparison: BodyComparison) -> LargestDifference:
    """Return the largest difference of any engine model (without one, of the last model) from the first model."""
    models = comparison.model_sequence
    later = [model for model in models[1:] if model.side == "engine"] or models[-1:]
    totals = [replace(comparison.total_pair, second=model, base=models[0]) for model in later]
    known = [pair for pair in totals if comparison.difference(pair).known.any()]
    if not known:
        nothing = WaterfallBar(model=models[-1].key, size=NAN, error=NAN, resolved=False)
        return LargestDifference(bars=(), total=nothing, phases=(NAN, NAN), phases_per_axis=0)

    def size(pair: Pair) -> float:
        """Return the largest absolute difference of a pair of models at any phase pair."""
        difference = comparison.difference(pair)
        return abs(difference.at(difference.size, difference.largest_place))

    largest = max(known, key=size)
    total = comparison.difference(largest)
    assert total.largest_place is not None
    chain = comparison.consecutive_model_pairs[: models.index(largest.second)]
    bars = tuple(_bar_at(comparison, pair, total.largest_place) for pair in chain)
    return LargestDifference(
        bars=bars,
        total=_bar_at(comparison, largest, total.largest_place),
        phases=total.phases,
        phases_per_axis=len(total.size),
    )


def _mean_bar(row: Difference) -> WaterfallBar:
    """Return the bar of two successive models: their mean difference over the phases."""
    return WaterfallBar(model=row.second, size=row.mean, error=row.error, resolved=row.mean_is_resolved)


def _bar_at(comparison: BodyComparison, pair: Pair, place: tuple[int, int]) -> WaterfallBar:
    """Return the bar of a pair of models: their difference at one phase pair."""
    difference = comparison.difference(pair)
    size, error = difference.at(difference.size, place), difference.at(difference.uncertainty, place)
    resolved = bool(abs(size) > RESOLVED_RATIO * error)
    return WaterfallBar(model=pair.second.key, size=size, error=error, resolved=resolved)
