"""Mistakes in the real programs: a scene that is read wrongly, or a step and tolerances that are too coarse."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

import multibody
from comparison.study.batches import import_function
from reference.problem import Amplification, Scene, ground_peak

NEWTON = 1e-5  # tolerance of the coarse engine's iteration
PENETRATION = 1e-6  # of rho, of its contact


def misread(
    scene: Scene,
    phases: NDArray[np.float64],
    tolerance: float,
    program: str,
    stiffness: float = 1.0,
    mass: float = 1.0,
    friction: float = 1.0,
    **settings: Any,
) -> Amplification:
    """A program with every link `stiffness` times as stiff as stated, the last body `mass` times as heavy."""
    data: dict[str, Any] = scene.model_dump(exclude_none=True)
    for body, link in zip(data["bodies"][1:], scene.stiffness):
        body.pop("period", None)
        body["stiffness"] = (stiffness * link).tolist()
    data["bodies"][-1]["mass"] *= mass
    data["isolator"]["friction"] *= friction
    answer: Amplification = import_function(program)(
        Scene.model_validate(data), phases, tolerance=tolerance, **settings
    )
    return answer


def coarse(
    scene: Scene, phases: NDArray[np.float64], tolerance: float, step: float, model: str, regularization: float
) -> Amplification:
    """The engine once at a constant step, s, its peaks read at the steps; the errors claimed are what was asked for."""
    runs = [
        multibody.single_run(
            scene, phase, model, regularization, step=step, penetration=PENETRATION, newton=NEWTON, residual=NEWTON
        )
        for phase in phases
    ]
    assert all(run.status == "ok" for run in runs)
    peaks = [np.linalg.norm(run.absolute_acceleration, axis=2).max(axis=0) for run in runs]
    mu = np.array(peaks) / ground_peak(scene, phases)[:, None]
    return Amplification(mu, tolerance * mu, np.full(len(mu), "ok"), np.full(len(mu), np.nan), 0.0)
