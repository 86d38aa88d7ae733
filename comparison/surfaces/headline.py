"""One plain sentence for every body of a scene: how far the engine and the paper's equations differ, and why."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Annotated

import xarray as xr

from comparison.result_types import Number, Phases, Text, result
from comparison.study.models import Model, steps_of
from comparison.study.study import Study
from comparison.surfaces.budget import known_to_all, steps
from comparison.surfaces.differences import Difference
from comparison.surfaces.steps import RESOLVED
from comparison.surfaces.waterfall import NAN, Waterfall, WaterfallBar
from comparison.wording import degrees, difference, more_or_less, percent, signed
from reference.problem import Scene

MAIN_CAUSE = 0.5  # of the largest real step: a step of that size is named as a cause, too
MOST = 0.5  # fraction of the phase pairs
SMALL = 0.2  # of the largest: geometry below it is no cause, the two codes agree below it


@result
class Cause:
    """The models whose steps make a difference, from the bars of a waterfall."""

    models: tuple[str, ...] = ()
    """keys of the models whose real steps have the sign of the difference, largest first; empty where it is not real"""
    offset: Annotated[tuple[str, ...], "keys of the models whose real steps offset these, largest first"] = ()


@result
class Headline:
    """The total difference of one body in numbers and in a plain sentence; relative to mu of the first model."""

    scene: Annotated[Text, "name of the scene"]
    body: Annotated[int, "number of the body; 1 is the platform"]
    name: Annotated[str, "name of the body"]
    first: Annotated[str, "key of the first model"]
    second: Annotated[str, "key of the last model"]
    mean: Number
    """mean of the signed difference over the phase pairs where every compared model has a value: the total of the
    waterfall"""
    mean_error: Annotated[Number, "error estimate of the mean"]
    spread: Annotated[Number, "standard deviation of the signed difference over the same phase pairs"]
    phases_per_axis: int
    """of the grid of phase pairs that every compared model was asked for; 1 under a record"""
    points: Annotated[int, "phase pairs of this grid where every compared model has a value"]
    independent: Annotated[int, "of these, not related by a symmetry of the scene"]
    real: Annotated[Number, "fraction of these where the difference exceeds five times its error estimate"]
    maximum: Number
    """signed; the largest absolute difference of the first and any engine model, at any phase pair where both have a
    value"""
    maximum_error: Annotated[Number, "error estimate of the maximum"]
    maximum_phases: Annotated[Phases, "(alpha1, alpha2) of the maximum, rad; null under a record"]
    maximum_model: Annotated[str, "key of the engine model that has the maximum"]
    maximum_phases_per_axis: Annotated[int, "of the grid of phase pairs that this model and the first were asked for"]
    cause: Annotated[Cause, "of the mean, from the bars of the means"]
    maximum_cause: Annotated[Cause, "of the maximum, from the bars at its phase pair"]
    like_for_like: Number
    """largest absolute difference of the two codes given the same equations and friction law"""
    sentence: Annotated[Text, "all that in words"]

    @property
    def statement(self) -> str:
        """The sentence below a heading that names the scene."""
        return self.sentence.removeprefix(f"{self.scene}, ")


def headline(study: Study, surfaces: xr.Dataset, scene: Scene, bars: Waterfall, rows: Sequence[Difference]) -> Headline:
    """The headline of one body: its mean is the total of the bars, its largest difference theirs."""
    body, largest = bars.body, bars.largest
    pair = next(pair for pair in study.pairs(scene) if pair.key == "total")
    hierarchy = steps(study, surfaces, scene.name, body)
    stride, common = known_to_all(hierarchy)
    real = hierarchy[-1].every(stride, hierarchy[-1].real)[common]
    alike = [row.maximum for row in rows if (row.scene, row.body, row.pair) == (scene.name, body, "like-for-like")]
    name, engines = "platform" if body == 1 else f"body {body}", _of_engines(study, scene, body, rows)
    numbers = Headline(
        scene=scene.name,
        body=body,
        name=name,
        first=pair.first.key,
        second=pair.second.key,
        mean=bars.total.size,
        mean_error=bars.total.error,
        spread=bars.spread,
        phases_per_axis=len(common),
        points=bars.points,
        independent=bars.independent,
        real=float(real.mean()) if real.size else NAN,
        maximum=largest.total.size,
        maximum_error=largest.total.error,
        maximum_phases=largest.phases,
        maximum_model=largest.total.model,
        maximum_phases_per_axis=largest.phases_per_axis,
        cause=cause_of(bars.bars, bars.total),
        maximum_cause=cause_of(largest.bars, largest.total),
        like_for_like=alike[0] if alike else NAN,
        sentence="",
    )
    rest = _sentence(study, scene, numbers, bars, of_codes=not engines)
    sentences = [*engines, f"{rest[0].upper()}{rest[1:]}" if engines else rest]
    return replace(numbers, sentence=f"{scene.name}, {name}: {' '.join(sentences)}")


def cause_of(bars: Sequence[WaterfallBar], total: WaterfallBar) -> Cause:
    """
    What makes a total.

    Its causes are the largest real bar of its sign and those of at least half that size; what offsets them are the bars
    of the other sign and at least that size. A total that is not real has no cause.
    """
    real = sorted((bar for bar in bars if bar.real and total.real), key=lambda bar: -abs(bar.size))
    along = [bar for bar in real if bar.size * total.size > 0.0]
    if not along:
        return Cause()
    named = [bar for bar in real if abs(bar.size) >= MAIN_CAUSE * abs(along[0].size)]
    return Cause(
        tuple(bar.model for bar in named if bar in along), tuple(bar.model for bar in named if bar not in along)
    )


def _of_engines(study: Study, scene: Scene, body: int, rows: Sequence[Difference]) -> list[str]:
    """How far each engine of the user is from the equations with its friction law, in a sentence each."""
    row_of = {row.pair: row for row in rows if (row.scene, row.body) == (scene.name, body)}
    sentences = []
    for pair in study.pairs(scene):
        if pair.second.side != "user":
            continue
        row = row_of[pair.key]
        known, axis = row.asked - row.unanswered, math.isqrt(row.asked)
        if not known:
            sentences.append(f"{pair.second.title} and the {pair.first.title} have no value in common.")
            continue
        places = f"{f'{known} of ' if row.unanswered else ''}{axis} × {axis} initial phases"
        spread = f"standard deviation {percent(row.spread)}"
        where = ", ".join(degrees(phase) for phase in row.phases)
        grid = f" (mean {signed(row.mean)} over {places}; {spread}; largest at ({where}))" if axis > 1 else ""
        # an unknown error explains no difference
        how = "agrees to {} with" if row.ratio <= 1.0 else "differs by up to {} from"
        sentences.append(f"{pair.second.title} {how.format(percent(row.maximum))} the {pair.first.title}{grid}.")
    return sentences


def _sentence(study: Study, scene: Scene, numbers: Headline, bars: Waterfall, of_codes: bool) -> str:
    """What is said of the models; of_codes: also how far the two codes agree, for which engines of the user stand."""
    models = {model.key: model for model in study.compared(scene)}
    asked = steps_of(scene, study.hierarchy)
    first, second = models[numbers.first], models[numbers.second]
    paper = "the paper's equations" if first is asked[0] else f"the {first.title}"
    engine = "the engine" if second is asked[-1] and second.side == "engine" else f"the {second.title}"
    if first is second:
        return f"only {paper} were computed, there is nothing to compare."
    if not numbers.points:
        where = "" if scene.recorded else " at any phase pair"
        return f"the models from {paper} to {engine} have no value in common{where}."
    real = bars.total.real or bars.largest.total.real
    parts = [(_difference if real else _agreement)(numbers, models, paper, engine)]
    parts += _causes(numbers, models, bars) if real else []
    if of_codes and math.isfinite(numbers.like_for_like):
        agree = numbers.like_for_like <= SMALL * abs(numbers.maximum) or not real
        parts.append(
            "Given the same equations and friction law, the two codes "
            f"{'agree to' if agree else 'differ by up to'} {percent(numbers.like_for_like)}."
        )
    return " ".join(parts)


def _agreement(numbers: Headline, models: Mapping[str, Model], paper: str, engine: str) -> str:
    start = f"no difference beyond the numerical error: {engine} and {paper} agree"
    if numbers.phases_per_axis == 1:
        return f"{start} under the record (difference {difference(numbers.mean, numbers.mean_error)})."
    return f"{start} (mean difference {difference(numbers.mean, numbers.mean_error)} {_over(numbers, models)})."


def _difference(numbers: Headline, models: Mapping[str, Model], paper: str, engine: str) -> str:
    in_the_mean = abs(numbers.mean) > RESOLVED * numbers.mean_error
    gives = f"{engine} gives {more_or_less(numbers.mean, numbers.mean_error)} than {paper}"
    if numbers.phases_per_axis == 1:
        return f"{gives} under the record."
    if numbers.real >= MOST and in_the_mean:
        return f"{gives} (mean {_over(numbers, models)})."
    apart = "differ at most initial phases, but not in the mean"
    where = apart if numbers.real >= MOST else "agree at most initial phases"
    mean = difference(numbers.mean, numbers.mean_error)
    return f"{engine} and {paper} {where} (mean difference {mean} {_over(numbers, models)})."


def _largest(numbers: Headline, models: Mapping[str, Model]) -> str:
    """The largest difference, which may be that of a model with more phases and fewer effects than the last."""
    model, count = models[numbers.maximum_model], numbers.maximum_phases_per_axis
    which = "" if model.key == numbers.second else f" by the {model.title} on {count} × {count} phases"
    place = ", ".join(degrees(phase) for phase in numbers.maximum_phases)
    return f"up to {more_or_less(numbers.maximum, numbers.maximum_error)}{which} at ({place})"


def _causes(numbers: Headline, models: Mapping[str, Model], bars: Waterfall) -> list[str]:
    """At most one sentence, from the bars that are shown: the means, and those at the largest difference."""

    def words(cause: Cause) -> str:
        named, offset = (
            " and ".join(models[key].effect or f"the step to the {models[key].title}" for key in keys)
            for keys in (cause.models, cause.offset)
        )
        return f"{named} (partly offset by {offset})" if offset else named

    mean, largest = words(numbers.cause), words(numbers.maximum_cause)
    if set(numbers.cause.models) == set(numbers.maximum_cause.models):
        shown = (bars.bars, numbers.cause), (bars.largest.bars, numbers.maximum_cause)
        denied = ", not geometry" if all(_without_geometry(*each, models) for each in shown) else ""
        return [f"Cause: {mean}{denied}."] if mean else []
    if mean and largest:
        return [f"Cause: {mean} in the mean, {largest} at the largest."]
    return [f"Cause of the mean: {mean}." if mean else f"Cause of the largest: {largest}."]


def _without_geometry(bars: Sequence[WaterfallBar], cause: Cause, models: Mapping[str, Model]) -> bool:
    """Whether there is a bar of the geometry, and it is small beside the largest cause."""
    size = {bar.model: abs(bar.size) for bar in bars}
    geometry = [size[key] for key in size if models[key].effect == "geometry"]
    return bool(geometry and cause.models) and geometry[0] < SMALL * size[cause.models[0]]


def _over(numbers: Headline, models: Mapping[str, Model]) -> str:
    """Over which phase pairs the mean is, how far the differences scatter, and the largest of them."""
    grid = f"{numbers.phases_per_axis} × {numbers.phases_per_axis} initial phases"
    count = "" if numbers.points == numbers.phases_per_axis**2 else f"{numbers.points} of "
    over = f"over {count}{grid}, {numbers.independent} of them independent"
    return f"{over}; standard deviation {percent(numbers.spread)}; {_largest(numbers, models)}"
