"""The limits that a scene states before the run, compared with what was found."""

from collections.abc import Iterator, Sequence
from itertools import groupby
from math import isnan
from typing import Annotated

from pydantic import computed_field

from comparison.result_types import Number, Text, result
from comparison.study.models import pairs_of
from comparison.study.study import Study
from comparison.surfaces.body_comparison import BodyComparison
from comparison.surfaces.budget import closure
from comparison.surfaces.unanswered import Unanswered
from reference.problem import Scene


@result
class Breach:
    """Where an acceptance limit is broken."""

    body: Annotated[int, "number of the body; 0 where the limit is of the scene"]
    found: Annotated[Number, "value that exceeds the limit; null without one"]
    reason: Annotated[Text, "why there is no value, or what was counted; empty otherwise"] = ""


@result
class Limit:
    """An acceptance limit that the scene states, compared with the results."""

    scene: Annotated[Text, "name of the scene"]
    key: Annotated[str, "as written below acceptance"]
    allowed: Annotated[float, "largest value that holds it"]
    breaches: Annotated[tuple[Breach, ...], "where it is broken; empty if it holds"]

    @property
    def broken_texts(self) -> list[str]:
        """One text for each breach, without the scene."""
        return [
            f"{f'body {breach.body}: ' if breach.body else ''}acceptance.{self.key}: "
            f"{breach.reason or f'{breach.found:.3g} found'}, {self.allowed:g} allowed"
            for breach in self.breaches
        ]

    @computed_field  # type: ignore[prop-decorator]
    @property
    def broken(self) -> list[str]:
        """One line for each breach."""
        return [f"{self.scene}: {text}" for text in self.broken_texts]


def checked_limits(comparisons: Sequence[BodyComparison], lacking: Sequence[Unanswered]) -> list[Limit]:
    """Every limit that the scenes of a study state, compared with what was found, in the order of scenes and keys."""
    limits = []
    for scene, bodies in groupby(comparisons, lambda comparison: comparison.scene):
        gaps = [gap for gap in lacking if gap.scene == scene.name]
        checked = _breaches(list(bodies), gaps)
        limits += [Limit(scene.name, key, allowed, tuple(breaches)) for key, allowed, breaches in checked]
    return limits


def _breaches(
    bodies: Sequence[BodyComparison], gaps: Sequence[Unanswered]
) -> Iterator[tuple[str, float, list[Breach]]]:
    """Key, limit and what breaks it, of every limit that the scene states."""
    study, scene = bodies[0].study, bodies[0].scene
    stated, rows = scene.acceptance, [row for body in bodies for row in body.rows.values()]
    for key, pair, measure, allowed in stated.differences():
        compared = [row for row in rows if row.pair == _same(study, scene, pair)]
        if any(row.asked > row.unanswered for row in compared):
            missing = "an error estimate is missing" if measure == "ratio" else "no phase pair to compare"
            yield key, allowed, _beyond([(row.body, getattr(row, measure)) for row in compared], allowed, missing)
        else:
            reason = f"nothing to compare ({_why_not(study, scene, pair, gaps)})"
            yield key, allowed, [Breach(0, float("nan"), reason)]
    if stated.closure is not None:
        remainders = [(body.body, closure(body)) for body in bodies]
        yield "closure", stated.closure, _beyond(remainders, stated.closure)
    if (allowed_points := stated.failures) is not None:
        lacks = {gap: gap.points + gap.unusable for gap in gaps}
        count = sum(lacks.values())
        models = ", ".join(f"{gap.title} {points} of {gap.asked}" for gap, points in lacks.items())
        excess = f"{count} points without an answer ({models})"
        yield "failed", allowed_points, [Breach(0, count, excess)] if count > allowed_points else []


def _beyond(
    values: Sequence[tuple[int, float]], allowed: float, missing: str = "no phase pair to compare"
) -> list[Breach]:
    """The bodies whose value is not within the limit; no value is not within any, for the reason `missing`."""
    return [Breach(body, value, missing if isnan(value) else "") for body, value in values if not value <= allowed]


def _same(study: Study, scene: Scene, pair: str) -> str:
    """The pair under which a study compares these models: the translational difference may be the total one."""
    compared = {known.key: known for known in study.pairs(scene)}
    engines = [model.key for model in study.compared(scene) if model.side == "engine"]
    alone = pair == "translational" and pair not in compared and engines == [compared["total"].second.key]
    return "total" if alone else pair


def _why_not(study: Study, scene: Scene, pair: str, gaps: Sequence[Unanswered]) -> str:
    """Why a pair of models is not compared."""
    wanted = next((known for known in pairs_of(scene, study.hierarchy) if known.key == pair), None)
    if wanted is None and pair in scene.acceptance.of_engines:
        return f"no engine {pair} in this study: --model {pair}=module:function enters it"
    if wanted is None:
        return "no engine in this study"
    reasons = [gap.description for gap in gaps if gap.model in (wanted.first.key, wanted.second.key)]
    return reasons[0] if reasons else "no phase pair in common"
