"""One plain sentence for every body of a scene: how far the engine and the paper's equations differ, and why."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr

from comparison.analysis.differences import Difference, pair_step
from comparison.analysis.independent import independent_phases
from comparison.analysis.steps import RESOLVED
from comparison.analysis.waterfall import NAN, Waterfall, WaterfallBar
from comparison.study.models import Model, steps_of
from comparison.study.study import Study
from comparison.wording import degrees, percent, signed
from reference.problem import Scene

MAIN_CAUSE = 0.5  # of the largest real step: a step of that size is named as a cause, too
MOST = 0.5  # fraction of the phase pairs
SMALL = 0.2  # of the largest: geometry below it is no cause, the two codes agree below it


@dataclass(frozen=True)
class Headline:
    """The total difference of one body, in numbers and as a sentence. Sizes are relative to mu of the first model."""

    scene: str
    body: int  # from 1
    name: str  # of the body: platform, body 2, ...
    first: str  # key of the first model
    second: str  # key of the last model
    median: float  # median of the signed difference over the phase pairs; NaN without any
    phases_per_axis: int  # of the grid of phase pairs that both models were asked for; 1 under a record
    points: int  # phase pairs of it where both have a value
    independent: int  # of these, not related by a symmetry of the scene
    real: float  # fraction of these where the difference is real (the five-fold rule)
    maximum: float  # signed, the largest absolute difference of the first and any engine model, anywhere
    maximum_error: float  # error estimate of it
    maximum_phases: tuple[float, float]  # (alpha1, alpha2), rad; NaN under a record
    maximum_model: str  # key of the engine model that has it
    maximum_phases_per_axis: int  # of the grid of phase pairs that this model and the first were asked for
    cause: tuple[str, ...]  # keys of the models whose mean steps make the difference, largest first; empty if none does
    maximum_cause: tuple[str, ...]  # likewise at the phase pair of the maximum
    like_for_like: float  # largest absolute difference of the two codes given the same equations; NaN if not compared
    sentence: str  # all that in words


def headline(study: Study, surfaces: xr.Dataset, scene: Scene, bars: Waterfall, rows: Sequence[Difference]) -> Headline:
    """
    The headline of one body.

    Parameters
    ----------
    bars : Waterfall
        Of this body.
    rows : sequence of Difference
        Of the study.

    Returns
    -------
    Headline
        Its largest difference is the largest that the page shows of the first and any engine model.
    """
    body, pair = bars.body, next(pair for pair in study.pairs(scene) if pair.key == "total")
    total = pair_step(surfaces, scene.name, pair, body)
    known, largest = total.known, bars.largest
    alike = [row.maximum for row in rows if (row.scene, row.body, row.pair) == (scene.name, body, "like-for-like")]
    numbers = Headline(
        scene=scene.name,
        body=body,
        name="platform" if body == 1 else f"body {body}",
        first=pair.first.key,
        second=pair.second.key,
        median=float(np.median(total.size[known])) if known.any() else NAN,
        phases_per_axis=len(known),
        points=int(known.sum()),
        independent=independent_phases(study, scene, (pair.first, pair.second), known, total.stride),
        real=float(total.real[known].mean()) if known.any() else NAN,
        maximum=largest.total.size,
        maximum_error=largest.total.error,
        maximum_phases=largest.phases,
        maximum_model=largest.total.model,
        maximum_phases_per_axis=largest.phases_per_axis,
        cause=causes(bars.bars),
        maximum_cause=causes(largest.bars),
        like_for_like=alike[0] if alike else NAN,
        sentence="",
    )
    return replace(numbers, sentence=_with_engines(study, surfaces, scene, numbers, bars))


def causes(bars: Sequence[WaterfallBar]) -> tuple[str, ...]:
    """The models whose steps are real and at least half as large as the largest of them, largest first."""
    real = sorted((bar for bar in bars if bar.real), key=lambda bar: -abs(bar.size))
    return tuple(bar.model for bar in real if abs(bar.size) >= MAIN_CAUSE * abs(real[0].size))


def _with_engines(study: Study, surfaces: xr.Dataset, scene: Scene, numbers: Headline, bars: Waterfall) -> str:
    """The sentence; those of the user's engines come first and take the place of what it says of the two codes."""
    engines = _of_engines(study, surfaces, scene, numbers.body)
    if not engines:
        return _sentence(study, scene, numbers, bars)
    start = f"{scene.name}, {numbers.name}: "
    rest = _sentence(study, scene, replace(numbers, like_for_like=NAN), bars).removeprefix(start)
    return f"{start}{' '.join(engines)} {rest[0].upper()}{rest[1:]}"


def _of_engines(study: Study, surfaces: xr.Dataset, scene: Scene, body: int) -> list[str]:
    """How far each engine of the user is from the equations with its friction law."""
    sentences = []
    for pair in study.pairs(scene):
        if pair.second.side != "entered":
            continue
        found = pair_step(surfaces, scene.name, pair, body)
        size, uncertainty = found.size[found.known], found.uncertainty[found.known]
        if not size.size:
            sentences.append(f"{pair.second.title} and the {pair.first.title} have no value in common.")
            continue
        largest = percent(float(np.abs(size).max()))
        within = (np.abs(size) <= np.nan_to_num(uncertainty)).all()  # an unknown error explains no difference
        count = "" if size.size == found.size.size else f"{size.size} of "
        places = f"{count}{len(found.size)} × {len(found.size)} initial phases"
        where = ", ".join(degrees(phase) for phase in found.phases)
        grid = (
            f" (mean {signed(float(size.mean()))} over {places}, largest at ({where}))" if found.size.size > 1 else ""
        )
        how = f"agrees to {largest} with" if within else f"differs by up to {largest} from"
        sentences.append(f"{pair.second.title} {how} the {pair.first.title}{grid}.")
    return sentences


def _sentence(study: Study, scene: Scene, numbers: Headline, bars: Waterfall) -> str:
    models = {model.key: model for model in study.compared(scene)}
    asked = steps_of(scene, study.hierarchy)
    first, second = models[numbers.first], models[numbers.second]
    paper = "the paper's equations" if first is asked[0] else f"the {first.title}"
    engine = "the engine" if second is asked[-1] and second.side == "engine" else f"the {second.title}"
    start = f"{scene.name}, {numbers.name}: "
    if first is second:
        return f"{start}only {paper} were computed, there is nothing to compare."
    if not numbers.points:
        return f"{start}{engine} and {paper} have no value in common{'' if scene.recorded else ' at any phase pair'}."
    real = abs(numbers.maximum) > RESOLVED * numbers.maximum_error
    parts = [start + (_difference if real else _agreement)(numbers, models, paper, engine)]
    parts += _causes(numbers, models, bars) if real else []
    if math.isfinite(numbers.like_for_like):
        agree = numbers.like_for_like <= SMALL * abs(numbers.maximum) or not real
        parts.append(
            "Given the same equations and friction law, the two codes "
            f"{'agree to' if agree else 'differ by up to'} {percent(numbers.like_for_like)}."
        )
    return " ".join(parts)


def _agreement(numbers: Headline, models: Mapping[str, Model], paper: str, engine: str) -> str:
    if numbers.phases_per_axis == 1:
        size = percent(abs(numbers.maximum))
        return f"no difference beyond the numerical error: {engine} and {paper} agree to {size} {_under(numbers)}."
    return (
        f"no difference beyond the numerical error: {engine} and {paper} agree to {percent(abs(numbers.median))} "
        f"(median over {_over(numbers)}; {_largest(numbers, models)})."
    )


def _difference(numbers: Headline, models: Mapping[str, Model], paper: str, engine: str) -> str:
    if numbers.phases_per_axis == 1:
        return f"{engine} gives {_than(numbers.median)} than {paper} {_under(numbers)}."
    if numbers.real < MOST:
        apart = f"median difference {percent(abs(numbers.median))} over {_over(numbers)}; {_largest(numbers, models)}"
        return f"{engine} and {paper} agree at most initial phases ({apart})."
    return (
        f"{engine} gives {_than(numbers.median)} than {paper} "
        f"(median over {_over(numbers)}; {_largest(numbers, models)})."
    )


def _largest(numbers: Headline, models: Mapping[str, Model]) -> str:
    """The largest difference, which may be that of a model with more phases and fewer effects than the last."""
    keys = list(models)
    without = [models[key] for key in keys[keys.index(numbers.maximum_model) + 1 :]]
    count = numbers.maximum_phases_per_axis
    effects = " and ".join(model.effect or model.title for model in without)
    which = f" without {effects}, over {count} × {count} phases" if without else ""
    place = ", ".join(degrees(phase) for phase in numbers.maximum_phases)
    return f"up to {_than(numbers.maximum)}{which}, at ({place})"


def _causes(numbers: Headline, models: Mapping[str, Model], bars: Waterfall) -> list[str]:
    def words(keys: Sequence[str]) -> str:
        return " and ".join(models[key].effect or f"the step to the {models[key].title}" for key in keys)

    geometry = [bar for bar in bars.bars if models[bar.model].effect == "geometry"]
    main = next((abs(bar.size) for bar in bars.bars if numbers.cause and bar.model == numbers.cause[0]), NAN)
    denied = ", not geometry" if geometry and abs(geometry[0].size) < SMALL * main else ""
    parts = [f"Cause: {words(numbers.cause)}{denied}."] if numbers.cause else []
    if numbers.maximum_cause and numbers.maximum_cause != numbers.cause:
        parts.append(f"Cause of the largest: {words(numbers.maximum_cause)}.")
    return parts


def _than(size: float) -> str:
    return f"{percent(abs(size))} {'less' if size < 0.0 else 'more'}"


def _under(numbers: Headline) -> str:
    return "under the record" if math.isnan(numbers.maximum_phases[0]) else "at the one phase pair"


def _over(numbers: Headline) -> str:
    """The phase pairs of the median in words."""
    grid = f"{numbers.phases_per_axis} × {numbers.phases_per_axis} initial phases"
    count = "" if numbers.points == numbers.phases_per_axis**2 else f"{numbers.points} of "
    return f"{count}{grid}, {numbers.independent} of them independent"
