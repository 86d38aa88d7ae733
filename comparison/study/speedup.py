"""
What a model leaves out of a scene, and how many times less a point then costs.

What may be left out is decided in reference.problem.reductions, by the scene alone, and the end of a run by the
solver. Here stands what that was measured to save (tests/benchmarks/test_reductions.py): it sets the size of a batch
and the cost that is predicted.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from comparison.study.models import Model
from reference.problem import Reduction, Scene, linear, planar, planar_chain, untilted


@dataclass(frozen=True)
class RecordedReduction:
    """
    name: what is left out. decided: whether a scene lets it be. models: a setting, and the values of models that can
    do without it. factor: recorded saving per point.
    """

    name: str
    decided: Callable[[Scene], Reduction]
    models: tuple[str, ...]
    factor: float

    def concerns(self, model: Model) -> bool:
        """Whether the model may leave it out of some scene: not an engine of the user, which is asked for all."""
        key, *values = self.models
        return model.side != "entered" and model.settings.get(key) in values


def _always(_scene: Scene) -> Reduction:
    """Of every scene: where a run may stop, a look ahead or the run before it shows."""
    return Reduction(True, "runs stop soon after the last large value, where a look ahead or a run before shows it")


REDUCTIONS: tuple[RecordedReduction, ...] = (
    RecordedReduction("every run but one per harmonic", linear, ("equations", "small"), 40.0),
    RecordedReduction("motion across its plane", planar, ("equations", "small"), 1.15),
    RecordedReduction("motion across its plane", planar, ("equations", "exact"), 1.2),
    RecordedReduction("motion across its plane, of the bodies", planar_chain, ("model", "translational"), 1.15),
    RecordedReduction("end of every run", _always, ("equations", "exact", "small"), 1.7),
    RecordedReduction("end of every run", _always, ("model", "translational", "spatial"), 1.7),
    RecordedReduction("rotations, all supports but one", untilted, ("model", "spatial"), 1.7),
)


def speedup(scene: Scene, model: Model) -> float:
    """
    How many times less a point costs for what the scene does not require.

    Parameters
    ----------
    scene : Scene
    model : Model

    Returns
    -------
    float
        Recorded cost of a point in full over that of one from which all of it is left out.
    """
    factor = 1.0
    for part in REDUCTIONS:
        if part.concerns(model) and part.decided(scene):
            factor *= part.factor
    return factor
