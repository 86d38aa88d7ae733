"""What a study leaves out of its scenes, as rows for `--plan`: what, in which models, what that saves, and why."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from comparison.study.models import Model
from comparison.study.speedup import REDUCTIONS
from comparison.study.study import Study
from reference.problem import Scene, half_turn, no_friction, own_axes, unused_harmonics


class Row(NamedTuple):
    """cost: what is left of that of the models, "none" where they are not computed."""

    what: str
    scene: str
    models: str
    cost: str
    why: str


def reductions(study: Study) -> list[Row]:
    """Everything that the scenes of the study do not require and that is therefore not computed."""
    return [] if study.full else [row for scene in study.scenes for row in _of(study, scene)]


def _of(study: Study, scene: Scene) -> list[Row]:
    models = [model for model in study.hierarchy if model.applies(scene)]
    rows = []
    for factor, concerned in _by_factor(
        [(study.points(model, scene) / len(study.solved(scene, model)), model) for model in models]
    ):
        rows.append(Row("mirrored phases", scene.name, _titles(concerned, models), f"1/{factor:.3g}", _mirror(scene)))
    if no_friction(scene):
        alike = [
            model
            for model in study.hierarchy
            if model not in models and model.settings.get("regularization") is not None
        ]
        alike += [model for model in study.hierarchy if model not in models and "cutoff" in model.settings]
        if alike:
            rows.append(Row("laws of friction", scene.name, _titles(alike, models), "none", no_friction(scene).reason))
    for part in REDUCTIONS:
        concerned = [model for model in models if part.concerns(model)]
        if concerned and (decided := part.decided(scene)):
            rows.append(Row(part.name, scene.name, _titles(concerned, models), f"1/{part.factor:.3g}", decided.reason))
    return rows


def _by_factor(models_by_factor: Sequence[tuple[float, Model]]) -> list[tuple[float, list[Model]]]:
    factors = sorted({factor for factor, _ in models_by_factor if factor > 1.0}, reverse=True)
    return [(factor, [model for its_factor, model in models_by_factor if its_factor == factor]) for factor in factors]


def _mirror(scene: Scene) -> str:
    if unused_harmonics(scene):
        return "a harmonic without amplitude: its phase changes nothing"
    return (own_axes(scene) or half_turn(scene)).reason


def _titles(concerned: Sequence[Model], models: Sequence[Model]) -> str:
    return "all" if len(concerned) == len(models) else ", ".join(model.key for model in concerned)
