"""What one case shows under one reading of the paper: its surfaces, how smooth they are, and facts about its motion."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

import reference
from comparison.analyses.claims.cases import CASES
from comparison.analyses.claims.literal import literal_peaks
from comparison.analyses.claims.readings import Reading, has_stops, settings
from comparison.analyses.claims.smoothness import Bend, bends
from comparison.runner.task import TaskResult
from reference.problem import Amplification, Outcome, Scene, exponents, ground_peak, phase_grid
from reference.problem.reductions import half_turn
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

    mu: (n, n, N) on phases 2 pi k / n, NaN where a point has no answer. error: largest absolute error estimate; 0 of
    the literal integration, which has none.
    statuses: the outcomes met. bends: sharpest bend of each body's surface. apart: max |x_i - y_i| over the largest of
    |x_i| and |y_i|, for each body over MOTIONS. swing: max (x_1^2 + y_1^2) / rho^2 over the same. resonance: for each
    harmonic its period and the natural period closest to it, s. twins: whether mu is the same where both phases are
    shifted by pi. ground: sharpest bend of the denominator of (5.1). numerators: of each body's numerator, where the
    case is lubricated. error_message: why there is nothing, or "".
    """

    mu: Array = field(default_factory=lambda: np.full((0, 0, 0), np.nan))
    error: float = float("nan")
    statuses: tuple[str, ...] = ()
    bends: tuple[Bend, ...] = ()
    apart: tuple[float, ...] = ()
    swing: float = float("nan")
    resonance: tuple[tuple[float, float], ...] = ()
    twins: bool = False
    ground: Bend | None = None
    numerators: tuple[Bend, ...] = ()
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

    @property
    def literal(self) -> bool:
        """Whether it is integrated by `literal`: where friction has no corner, (4.6) says nothing."""
        return self.reading.peak == "literal (4.6)" and has_stops(self.scene)


def gathered(question: Question) -> Evidence:
    """Surface, bends and motions of one case under one reading. Runs inside a worker process."""
    scene, literal = question.scene, question.literal
    law = settings(scene, question.reading)

    def solved(scene: Scene, phases: Array, tolerance: float = TOLERANCE) -> Amplification:
        return reference.amplification(scene, phases, equations="small", tolerance=tolerance, **law)

    def factors(phases: Array) -> Array:
        return literal_peaks(scene, phases).mu if literal else solved(scene, phases, SHARP).mu

    def ground(phases: Array) -> Array:
        return ground_peak(scene, phases)[:, None]

    grid = question.grid
    if literal:
        mu, error, statuses = factors(phase_grid(grid)).reshape(grid, grid, -1), np.zeros(1), [str(Outcome.OK)]
    else:
        mu, error, statuses = surface(scene, grid, solved)
    surfaces = Evidence(mu, float(np.nanmax(error, initial=0.0)), tuple(statuses))
    if not surfaces.complete:
        return replace(surfaces, statuses=(*statuses, str(Outcome.RIM_REACHED))) if literal else surfaces
    if len(scene.bodies) == 1:
        return surfaces
    apart, swing = _literal_motion(scene) if literal else _motion(scene, law.get("regularization"))
    peaks = ground(phase_grid(grid)).reshape(grid, grid, 1)
    return replace(
        surfaces,
        bends=tuple(bends(mu, factors)),
        apart=apart,
        swing=swing,
        resonance=_resonance(scene),
        twins=bool(half_turn(scene)),
        ground=bends(peaks, ground)[0],
        numerators=tuple(bends(mu * peaks, lambda phases: factors(phases) * ground(phases)))
        if scene.lubricated
        else (),
    )


def without_value(question: Question, failed: TaskResult) -> Evidence:
    """In place of what a task did not return."""
    return Evidence(error_message=failed.reason)


def _motion(scene: Scene, v_reg: float | None) -> tuple[tuple[float, ...], float]:
    apart, swing = np.zeros(len(scene.bodies)), 0.0
    for phase in MOTIONS:
        place = reference.trajectory(scene, phase, equations="small", regularization=v_reg).position[..., :2]
        reach = np.abs(place).max(axis=(0, 2))
        apart = np.maximum(apart, np.abs(place[..., 0] - place[..., 1]).max(axis=0) / np.where(reach > 0, reach, 1.0))
        swing = max(swing, float((place[:, 0] ** 2).sum(axis=-1).max()) / scene.radius**2)
    return tuple(map(float, apart)), swing


def _literal_motion(scene: Scene) -> tuple[tuple[float, ...], float]:
    motions = literal_peaks(scene, np.array(MOTIONS))
    return tuple(map(float, motions.apart.max(axis=0))), float(motions.swing.max())


def _resonance(scene: Scene) -> tuple[tuple[float, float], ...]:
    natural, periods = reference.modes(scene).period.ravel(), 2.0 * np.pi / exponents(scene).imag
    return tuple((float(period), float(natural[np.abs(period / natural - 1.0).argmin()])) for period in periods)
