"""Assembly of the engine's system for a scene and the name of a model, with its arguments checked."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from multibody.models.engine import reset_when_unused
from multibody.models.spatial import assemble_spatial
from multibody.models.system import EngineModel
from multibody.models.translational import assemble_translational
from reference.problem import Scene
from reference.problem.ranges import REGULARIZATION_RANGE
from reference.problem.reductions import body_cannot_tilt
from reference.support.arguments import check_choice, check_number

# function that assembles each model, by the model's name
BUILDERS: dict[str, Callable[..., EngineModel]] = {"translational": assemble_translational, "spatial": assemble_spatial}


def choose_model(scene: Scene, model: str, full: bool) -> str:
    """Return the name of the model to run: "translational" for a platform that cannot tilt, unless `full`."""
    return "translational" if model == "spatial" and not full and body_cannot_tilt(scene).allowed else model


def assemble(
    scene: Scene,
    model: str,
    regularization: float | None,
    *,
    contact_force: bool = False,
    **options: int,
) -> EngineModel:
    """Assemble the engine's system of `scene`. Raises ValueError for an unknown model or a wrong regularization."""
    check_choice("model", model, sorted(BUILDERS))
    if regularization is not None:
        regularization = check_number("regularization", regularization, REGULARIZATION_RANGE)
    elif scene.has_dry_friction:
        raise ValueError("regularization: None: the engine's dry friction needs v_reg in m/s, greater than 0")
    built = BUILDERS[model](scene, regularization, contact_force=contact_force, **options)
    if scene.isolator.travel is not None:
        built = replace(built, travel=scene.isolator.travel / built.units.length)
    # copies of the model with other settings share its recorders, so that the memory is freed with the recorders
    reset_when_unused(built.recorders, built.container)
    return built
