"""Acceptance limits of a study, stated by its scenes or by default for a user's engine, compared with the results."""

from collections.abc import Iterator, Sequence
from math import isnan
from typing import Annotated

from pydantic import computed_field

from comparison.result_types import Number, Phases, Text, result
from comparison.study.models import models_of, pairs_of
from comparison.study.study import Study
from comparison.surfaces.body_comparison import BodyComparison
from comparison.surfaces.budget import compute_closure_error
from comparison.surfaces.differences import MAX_AGREEING_RATIO, Difference
from comparison.surfaces.missing_values import MissingValues
from comparison.surfaces.statements import word_breach
from reference.problem import Scene

NAN = float("nan")


@result
class Breach:
    """One place where the results exceed an acceptance limit."""

    body: Annotated[int, "number of the body; 0 where the limit is of the scene"]
    found: Annotated[Number, "value that exceeds the limit; null without one"]
    reason: Annotated[Text, "why there is no value, or what was counted; empty otherwise"] = ""
    largest: Annotated[Number, "largest difference, signed, where the limit is on one; null otherwise"] = NAN
    phases: Annotated[Phases, "(alpha1, alpha2) of it, rad"] = (NAN, NAN)


@result
class Limit:
    """An acceptance limit, compared with the results."""

    scene: Annotated[Text, "name of the scene"]
    key: Annotated[str, "as written below acceptance"]
    allowed: Annotated[float, "largest value that holds it"]
    breaches: Annotated[tuple[Breach, ...], "where it is broken; empty if it holds"]
    default: Annotated[bool, "whether it holds for an engine of the user of which the scene states no limit"] = False

    @property
    def breach_texts(self) -> list[str]:
        """Return a text for each breach, with body, value found and value allowed, without the scene's name."""
        return [word_breach(self, breach) for breach in self.breaches]

    @computed_field  # type: ignore[prop-decorator]
    @property
    def broken(self) -> list[str]:
        """Return one line for each breach."""
        return [f"{self.scene}: {text}" for text in self.breach_texts]


def list_pairs_without_limit(study: Study, scene: Scene) -> list[str]:
    """Return the keys of the pairs of models that are compared on a scene without any limit on their difference."""
    stated = [(pair, measure) for _, pair, measure, _ in scene.acceptance.list_limited_differences()]
    limited = {_find_equal_pair(study, scene, pair) for pair, _ in stated} | set(_engines_without_limits(study, scene))
    return [pair.key for pair in study.pairs(scene) if pair.key not in limited]


def _engines_without_limits(study: Study, scene: Scene) -> list[str]:
    """Return the keys of the user's engines for which the scene states no limit, so that the default limits hold."""
    stated = {pair for _, pair, _, _ in scene.acceptance.list_limited_differences()}
    models = models_of(scene, study.hierarchy)
    return [model.key for model in models if model.side == "user" and model.key not in stated]


def check_limits(bodies: Sequence[BodyComparison], gaps: Sequence[MissingValues]) -> list[Limit]:
    """
    Return every acceptance limit of a scene, compared with the results.

    bodies: the comparison of the models for each body. gaps: the models without a value at some phase pairs.
    """
    closure = bodies[0].scene.acceptance.closure
    limits = list(_check_differences(bodies, gaps))
    if closure is not None:
        remainders = [(body.body, compute_closure_error(body), None) for body in bodies]
        limits.append(
            Limit(
                scene=bodies[0].scene.name,
                key="closure",
                allowed=closure,
                breaches=_list_breaches(remainders, closure),
            )
        )
    return [*limits, *_check_missing_points(bodies[0].study, bodies[0].scene, gaps)]


def _check_differences(bodies: Sequence[BodyComparison], gaps: Sequence[MissingValues]) -> Iterator[Limit]:
    """Yield the limits on the differences of models, and the default limits of a user's engines."""
    study, scene = bodies[0].study, bodies[0].scene
    stated, rows = scene.acceptance, [row for body in bodies for row in body.rows.values()]
    engines = _engines_without_limits(study, scene)
    defaults = [(f"{key}.ratio", key, "ratio", MAX_AGREEING_RATIO) for key in engines]
    for key, pair, measure, allowed in (*stated.list_limited_differences(), *defaults):
        compared = [row for row in rows if row.pair == _find_equal_pair(study, scene, pair)]
        if any(row.asked > row.unanswered for row in compared):
            missing = "an error estimate is missing" if measure == "ratio" else "no phase pair to compare"
            breaches = _list_breaches([(row.body, getattr(row, measure), row) for row in compared], allowed, missing)
        else:
            reason = f"nothing to compare ({_explain_missing_pair(study, scene, pair, gaps)})"
            breaches = (Breach(body=0, found=NAN, reason=reason),)
        yield Limit(scene=scene.name, key=key, allowed=allowed, breaches=breaches, default=pair in engines)


def _check_missing_points(study: Study, scene: Scene, gaps: Sequence[MissingValues]) -> Iterator[Limit]:
    """Yield the limit on the number of phase pairs without an answer; by default it is 0 for a user's engine."""
    stated, engines = scene.acceptance, _engines_without_limits(study, scene)
    allowed_points = 0 if engines and stated.allowed_failures is None else stated.allowed_failures
    if allowed_points is not None:
        counted = [gap for gap in gaps if stated.allowed_failures is not None or gap.model in engines]
        lacks = {gap: gap.points + gap.unusable for gap in counted}
        count = sum(lacks.values())
        models = ", ".join(f"{gap.title} {points} of {gap.asked}" for gap, points in lacks.items())
        excess = Breach(body=0, found=count, reason=f"{count} points without an answer ({models})")
        yield Limit(
            scene=scene.name,
            key="failed",
            allowed=allowed_points,
            breaches=(excess,) if count > allowed_points else (),
            default=stated.allowed_failures is None,
        )


def _list_breaches(
    values: Sequence[tuple[int, float, Difference | None]], allowed: float, missing: str = "no phase pair to compare"
) -> tuple[Breach, ...]:
    """
    Return a breach for each body whose value exceeds the limit or is missing.

    values: number of the body, its value, and the row of differences that the value is of, or None. missing: the reason
    to state where a value is missing.
    """
    return tuple(
        Breach(body, value, missing if isnan(value) else "", *((row.largest, row.phases) if row else ()))
        for body, value, row in values
        if not value <= allowed
    )


def _find_equal_pair(study: Study, scene: Scene, pair: str) -> str:
    """
    Return the key under which the pair of models `pair` is compared on a scene.

    It is "total" for "translational" where the last model is the only engine model: both keys then mean the same pair.
    """
    compared = {known.key: known for known in study.pairs(scene)}
    engines = [model.key for model in study.compared(scene) if model.side == "engine"]
    alone = pair == "translational" and engines == [compared["total"].second.key]
    return "total" if alone else pair


def _explain_missing_pair(study: Study, scene: Scene, pair: str, gaps: Sequence[MissingValues]) -> str:
    """Return why a pair of models is not compared."""
    wanted = next((known for known in pairs_of(scene, study.hierarchy) if known.key == pair), None)
    if wanted is None and pair in scene.acceptance.user_engine_limits:
        return f"no engine {pair} in this study: --model {pair}=module:function enters it"
    if wanted is None:
        return "no engine in this study"
    reasons = [gap.description for gap in gaps if gap.model in (wanted.first.key, wanted.second.key)]
    return reasons[0] if reasons else "no phase pair in common"
