"""What one case shows under one reading of the paper: its surfaces, how smooth they are, and facts about its motion."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

import reference
from comparison.analyses.claims.readings import CASES, Reading, settings
from comparison.analyses.claims.smoothness import Bend, bends
from comparison.result_types import Array
from comparison.runner.task import TaskResult
from reference.problem import Amplification, Scene, exponents, ground_peak, phase_grid
from reference.problem.reductions import half_turn
from reference.problem.symmetry import surface

TOLERANCE = 1e-3  # relative, of the surfaces: peaks are counted in parts of their range
SHARP = 1e-6  # of the values that tell a fold from a curvature
FLAT = 0.05  # range of a surface over its mean, below which it has no peaks to speak of
MOTIONS = ((0.3, 1.1), (2.0, 0.7), (4.0, 5.5), (0.0, np.pi))  # rad, whose motion is looked at


@dataclass(frozen=True)
class Evidence:
    """One case under one reading, by the printed equations (4.3)-(4.4)."""

    mu: Array = field(default_factory=lambda: np.full((0, 0, 0), np.nan))  # (n, n, N), NaN without an answer
    error: float = float("nan")  # largest absolute error estimate
    statuses: tuple[str, ...] = ()  # the outcomes met
    bends: tuple[Bend, ...] = ()  # sharpest bend of each body's surface
    apart: tuple[float, ...] = ()  # max |x_i - y_i| over the largest of |x_i| and |y_i|, for each body over MOTIONS
    swing: float = float("nan")  # max (x_1^2 + y_1^2) / rho^2 over MOTIONS
    resonance: tuple[tuple[float, float], ...] = ()  # period of each harmonic and the closest natural period, s
    twins: bool = False  # whether mu is the same where both phases are shifted by pi
    ground: Bend | None = None  # sharpest bend of the denominator of (5.1)
    numerators: tuple[Bend, ...] = ()  # of each body's numerator, where the case is lubricated
    error_message: str = ""  # why there is nothing
    case: str = ""  # its name

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
    """Surface, bends and motions of one case under one reading. Runs inside a worker process."""
    scene = question.scene
    law = settings(scene, question.reading)

    def solved(scene: Scene, phases: Array, tolerance: float = TOLERANCE) -> Amplification:
        return reference.amplification(scene, phases, equations="small", tolerance=tolerance, **law)

    mu, error, statuses = surface(scene, question.grid, solved)
    surfaces = Evidence(mu, float(np.nanmax(error, initial=0.0)), tuple(statuses), case=question.case)
    if not surfaces.complete or len(scene.bodies) == 1:
        return surfaces
    motions = _motion(scene, law.get("regularization"))
    return with_facts(surfaces, scene, lambda phases: solved(scene, phases, SHARP).mu, *motions)


def with_facts(
    surfaces: Evidence, scene: Scene, factors: Callable[[Array], Array], apart: tuple[float, ...], swing: float
) -> Evidence:
    """The surfaces with their bends and with facts of the scene and its motion; factors: mu at phases (M, 2)."""

    def ground(phases: Array) -> Array:
        return ground_peak(scene, phases)[:, None]

    grid, natural = len(surfaces.mu), reference.modes(scene).period.ravel()
    periods = 2.0 * np.pi / exponents(scene).imag
    peaks = ground(phase_grid(grid)).reshape(grid, grid, 1)
    numerators = bends(surfaces.mu * peaks, lambda at: factors(at) * ground(at)) if scene.lubricated else ()
    return replace(
        surfaces,
        bends=bends(surfaces.mu, factors),
        apart=apart,
        swing=swing,
        resonance=tuple((float(each), float(natural[np.abs(each / natural - 1.0).argmin()])) for each in periods),
        twins=bool(half_turn(scene)),
        ground=bends(peaks, ground)[0],
        numerators=numerators,
    )


def without_value(question: Question, failed: TaskResult) -> Evidence:
    """In place of what a task did not return."""
    return Evidence(error_message=failed.reason, case=question.case)


def _motion(scene: Scene, v_reg: float | None) -> tuple[tuple[float, ...], float]:
    apart, swing = np.zeros(len(scene.bodies)), 0.0
    for phase in MOTIONS:
        place = reference.trajectory(scene, phase, equations="small", regularization=v_reg).position[..., :2]
        reach = np.abs(place).max(axis=(0, 2))
        apart = np.maximum(apart, np.abs(place[..., 0] - place[..., 1]).max(axis=0) / np.where(reach > 0, reach, 1.0))
        swing = max(swing, float((place[:, 0] ** 2).sum(axis=-1).max()) / scene.radius**2)
    return tuple(map(float, apart)), swing
