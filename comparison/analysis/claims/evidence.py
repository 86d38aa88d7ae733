"""What one case shows under one reading of the paper: its surfaces, how smooth they are, and facts about its motion."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from comparison.analysis.claims.readings import CASES, Reading, settings
from comparison.analysis.claims.smoothness import Bend, bends
from comparison.execution.task import TaskResult
from reference import amplification, trajectory
from reference.problem import Amplification, Scene
from reference.problem.symmetry import surface

Array = NDArray[np.float64]

TOLERANCE = 1e-3  # relative, of the surfaces: peaks are counted in parts of their range
SHARP = 1e-6  # of the values that tell a fold from a curvature
FLAT = 0.05  # range of a surface over its mean, below which it has no peaks to speak of
MOTIONS = ((0.3, 1.1), (2.0, 0.7), (4.0, 5.5), (0.0, np.pi))  # rad, whose motion is looked at


@dataclass(frozen=True)
class Evidence:
    """
    One case under one reading, by the printed equations (4.3)-(4.4).

    mu: (n, n, N) on phases 2 pi k / n, NaN where a point has no answer. error: largest absolute error estimate.
    statuses: the outcomes met. bends: sharpest bend of each body's surface. apart: max |x_i - y_i| over the largest of
    |x_i| and |y_i|, for each body over MOTIONS. swing: max (x_1^2 + y_1^2) / rho^2 over the same. error_message: why
    there is nothing, or "".
    """

    mu: Array = field(default_factory=lambda: np.full((0, 0, 0), np.nan))
    error: float = float("nan")
    statuses: tuple[str, ...] = ()
    bends: tuple[Bend, ...] = ()
    apart: tuple[float, ...] = ()
    swing: float = float("nan")
    error_message: str = ""

    def flat(self, body: int) -> bool:
        """Whether a surface varies by less than its errors, or so little that it shows no resonance."""
        mu = self.mu[..., body - 1]
        return bool(np.ptp(mu) <= max(2.0 * self.error, FLAT * abs(float(mu.mean()))))

    @property
    def complete(self) -> bool:
        """Whether every point has a value."""
        return self.mu.size > 0 and bool(np.isfinite(self.mu).all())


@dataclass(frozen=True)
class Question:
    """One case under one reading, on a grid of `grid` phases per axis."""

    case: str
    reading: Reading
    grid: int

    @property
    def scene(self) -> Scene:
        """The case under the reading."""
        return CASES[self.case](self.reading)


def gathered(question: Question) -> Evidence:
    """
    Surface, bends and motions of one case under one reading. Runs inside a worker process.

    Parameters
    ----------
    question : Question
        Case, reading and grid.

    Returns
    -------
    Evidence
    """
    scene = question.scene
    law = settings(scene, question.reading)

    def solved(scene: Scene, phases: Array, tolerance: float = TOLERANCE) -> Amplification:
        return amplification(scene, phases, equations="small", tolerance=tolerance, **law)

    mu, error, statuses = surface(scene, question.grid, solved)
    surfaces = Evidence(mu, float(np.nanmax(error, initial=0.0)), tuple(statuses))
    if not surfaces.complete or len(scene.bodies) == 1:
        return surfaces
    sharp = bends(mu, lambda phases: solved(scene, phases, SHARP).mu)
    return Evidence(mu, surfaces.error, surfaces.statuses, tuple(sharp), *_motion(scene, law.get("regularization")))


def without_value(question: Question, failed: TaskResult) -> Evidence:
    """In place of what a task did not return."""
    return Evidence(error_message=failed.reason)


def _motion(scene: Scene, v_reg: float | None) -> tuple[tuple[float, ...], float]:
    apart, swing = np.zeros(len(scene.bodies)), 0.0
    for phase in MOTIONS:
        place = trajectory(scene, phase, equations="small", regularization=v_reg).position[..., :2]
        reach = np.abs(place).max(axis=(0, 2))
        apart = np.maximum(apart, np.abs(place[..., 0] - place[..., 1]).max(axis=0) / np.where(reach > 0, reach, 1.0))
        swing = max(swing, float((place[:, 0] ** 2).sum(axis=-1).max()) / scene.radius**2)
    return tuple(map(float, apart)), swing
