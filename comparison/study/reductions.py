"""Computations that a study skips because its scenes do not require them, as rows for `--plan`."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from comparison.study.models import Model
from comparison.study.study import Study
from reference.problem import Scene
from reference.problem.reductions import (
    body_cannot_tilt,
    find_unused_harmonics,
    has_half_turn_symmetry,
    has_no_friction_law,
    has_one_axis_per_harmonic,
    has_planar_chain,
    is_linear,
    is_planar,
)

# Each row: what is skipped, in words; the function that tells whether a scene allows that; the name of a setting of
# models, and its values in the models that skip it.
SKIPPED_COMPUTATIONS = (
    ("every run but one per harmonic", is_linear, "equations", ("small",)),
    ("motion across its plane", is_planar, "equations", ("small", "exact")),
    ("motion across its plane, of the bodies", has_planar_chain, "model", ("translational",)),
    ("rotations, all supports but one", body_cannot_tilt, "model", ("spatial",)),
)


class SkippedComputation(NamedTuple):
    """One computation that is skipped: what, by which models, why, and in which scenes."""

    what: str
    models: str
    why: str
    scenes: tuple[str, ...]


def list_skipped_computations(study: Study) -> list[SkippedComputation]:
    """Return every computation that the scenes of the study do not require and that is skipped."""
    scenes: dict[tuple[str, str, str], list[str]] = {}
    for scene in () if study.full else study.scenes:
        for row in _omissions_of_scene(study, scene):
            scenes.setdefault(row, []).append(scene.name)
    return [SkippedComputation(*row, tuple(names)) for row, names in scenes.items()]


def _omissions_of_scene(study: Study, scene: Scene) -> Iterator[tuple[str, str, str]]:
    """Yield each computation that a scene makes needless, for example by symmetry: what, by which models, and why."""
    models = [model for model in study.hierarchy if model.applies(scene)]
    # how many phase pairs of its surface each computed pair of a model stands for
    shares = [study.points(model, scene) / len(study.solved(scene, model)) for model in models]
    for share in sorted(set(shares) - {1.0}, reverse=True):
        concerned = [model for model, own in zip(models, shares) if own == share]
        yield f"mirrored phases, all but 1/{share:.3g}", _name_models(concerned, models), _word_mirror(scene)
    if has_no_friction_law(scene):
        laws = [model for model in study.hierarchy if model.side == "reference" and model not in models]
        if laws:
            yield "laws of friction", _name_models(laws, study.hierarchy), has_no_friction_law(scene).reason
    for what, decided, setting, values in SKIPPED_COMPUTATIONS:
        concerned = [model for model in models if model.settings.get(setting) in values]
        if concerned and (reduction := decided(scene)):
            yield what, _name_models(concerned, models), reduction.reason


def _word_mirror(scene: Scene) -> str:
    """Return why mirrored phases give the same motion."""
    if find_unused_harmonics(scene):
        return "a harmonic without amplitude: its phase changes nothing"
    return (has_one_axis_per_harmonic(scene) or has_half_turn_symmetry(scene)).reason


def _name_models(concerned: Sequence[Model], models: Sequence[Model]) -> str:
    """Return the keys of the concerned models, or "all models" if they are all of `models`."""
    return "all models" if len(concerned) == len(models) else ", ".join(model.key for model in concerned)
