"""What a study leaves out of its scenes, as rows for `--plan`: what, in which models, what that saves, and why."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from comparison.study.models import Rung
from comparison.study.speedup import LEFT_OUT
from comparison.study.study import Study
from reference.problem import Scene, half_turn, no_friction, own_axes, unused_harmonics


class Row(NamedTuple):
    """cost: what is left of that of the models, "none" where they are not computed."""

    what: str
    scene: str
    models: str
    cost: str
    why: str


def left_out(study: Study) -> list[Row]:
    """Everything that the scenes of the study do not require and that is therefore not computed."""
    return [] if study.full else [row for scene in study.scenes for row in _of(study, scene)]


def _of(study: Study, scene: Scene) -> list[Row]:
    rungs = [rung for rung in study.ladder if rung.applies(scene)]
    rows = []
    for factor, some in _by_factor(
        [(study.points(rung, scene) / len(study.solved(scene, rung)), rung) for rung in rungs]
    ):
        rows.append(Row("mirrored phases", scene.name, _titles(some, rungs), f"1/{factor:.3g}", _mirror(scene)))
    if no_friction(scene):
        alike = [rung for rung in study.ladder if rung not in rungs and rung.settings.get("regularization") is not None]
        alike += [rung for rung in study.ladder if rung not in rungs and "cutoff" in rung.settings]
        if alike:
            rows.append(Row("laws of friction", scene.name, _titles(alike, rungs), "none", no_friction(scene).reason))
    for part in LEFT_OUT:
        some = [rung for rung in rungs if part.concerns(rung)]
        if some and (decided := part.decided(scene)):
            rows.append(Row(part.name, scene.name, _titles(some, rungs), f"1/{part.factor:.3g}", decided.reason))
    return rows


def _by_factor(found: Sequence[tuple[float, Rung]]) -> list[tuple[float, list[Rung]]]:
    factors = sorted({factor for factor, _ in found if factor > 1.0}, reverse=True)
    return [(factor, [rung for own, rung in found if own == factor]) for factor in factors]


def _mirror(scene: Scene) -> str:
    if unused_harmonics(scene):
        return "a harmonic without amplitude: its phase changes nothing"
    return (own_axes(scene) or half_turn(scene)).reason


def _titles(some: Sequence[Rung], rungs: Sequence[Rung]) -> str:
    return "all" if len(some) == len(rungs) else ", ".join(rung.key for rung in some)
