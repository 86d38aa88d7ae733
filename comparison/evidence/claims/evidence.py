"""Evidence of one case in one reading of (5.1): its surfaces, their smoothness, and facts about its motion."""

from dataclasses import dataclass, field, replace

import numpy as np

import reference
from comparison.evidence.claims.readings import STATEMENT_CASES, PeakReading
from comparison.evidence.claims.smoothness import SharpestCurvature, find_sharpest_curvatures
from comparison.result_types import Array
from comparison.runner.task import TaskResult
from reference.problem import Amplification, Scene, exponents, ground_peak, phase_grid
from reference.problem.symmetry import complete_surface

# Relative error of the amplification where the checks compute it: small enough to count peaks
SURFACE_TOLERANCE = 1e-3
CURVATURE_TOLERANCE = 1e-6  # relative error of amplifications whose second differences tell a fold from a smooth curve
FLAT_RANGE_RATIO = 0.05  # range of a surface divided by its mean, up to which it counts as flat: no resonance
MOTION_PHASES = ((0.3, 1.1), (2.0, 0.7), (4.0, 5.5), (0.0, np.pi))  # rad, phase pairs for checks of displacements


@dataclass(frozen=True)
class Evidence:
    """Facts on a scene by the paper's small equations (4.3)-(4.4), in one reading of the peak (5.1), for the checks."""

    # Amplification (n, n, N): n phases alpha1, n phases alpha2, N bodies; NaN if unknown
    mu: Array = field(default_factory=lambda: np.full((0, 0, 0), np.nan))
    error: float = float("nan")  # largest absolute error estimate of the amplification
    statuses: tuple[str, ...] = ()  # distinct outcomes of the phase pairs
    bends: tuple[SharpestCurvature, ...] = ()  # sharpest curvature of each body's amplification over the phases
    # For each body, largest |x - y| of its displacements, divided by the largest displacement, at MOTION_PHASES
    apart: tuple[float, ...] = ()
    swing: float = float("nan")  # largest (platform displacement / bearing radius rho)^2, at MOTION_PHASES
    resonance: tuple[tuple[float, float], ...] = ()  # period of each harmonic and the closest natural period, s
    ground: SharpestCurvature | None = None  # sharpest curvature of the ground peak, divisor in (5.1)
    error_message: str = ""  # why nothing was computed, or ""
    case: str = ""  # name of the scene in STATEMENT_CASES

    def flat(self, body: int) -> bool:
        """Return whether a body's amplification varies by no more than its errors, or too little for a resonance."""
        mu = self.mu[..., body - 1]
        return bool(np.ptp(mu) <= max(2.0 * self.error, FLAT_RANGE_RATIO * abs(float(mu.mean()))))

    @property
    def complete(self) -> bool:
        """Return whether the amplification has a value at every phase pair."""
        return self.mu.size > 0 and bool(np.isfinite(self.mu).all())


@dataclass(frozen=True)
class CaseInReading:
    """
    One scene in one reading of (5.1), that is one definition of the peak acceleration, on `grid` phases per axis.

    known: its amplification, if the study has computed it already.
    """

    case: str
    reading: PeakReading
    grid: int
    known: Evidence | None = None


def gather_evidence(question: CaseInReading) -> Evidence:
    """
    Compute what the checks need to know of a scene in one reading of (5.1). Runs inside a worker process.

    A scene of a platform alone has only its amplification: it is correlated with others.
    """
    scene, cutoff = STATEMENT_CASES[question.case](), question.reading.cutoff

    def solve(scene: Scene, phases: Array, tolerance: float = SURFACE_TOLERANCE) -> Amplification:
        """Return the amplification by the paper's small-vibration equations at phase pairs (M, 2), rad."""
        return reference.amplification(scene, phases, equations="small", cutoff=cutoff, tolerance=tolerance)

    surfaces = question.known
    if surfaces is None:
        mu, error, statuses = complete_surface(scene, question.grid, solve)
        largest = float(np.nanmax(error, initial=0.0))
        surfaces = Evidence(mu=mu, error=largest, statuses=tuple(statuses), case=question.case)
    if not surfaces.complete or len(scene.bodies) == 1:
        return surfaces

    def ground(phases: Array) -> Array:
        """Return the peak ground acceleration, m/s^2, the divisor in (5.1), at phase pairs (M, 2), rad."""
        return ground_peak(scene, phases)[:, None]

    grid, natural = len(surfaces.mu), reference.modes(scene).period.ravel()
    periods = 2.0 * np.pi / exponents(scene).imag
    apart, swing = _measure_motions(scene)
    return replace(
        surfaces,
        bends=find_sharpest_curvatures(surfaces.mu, lambda phases: solve(scene, phases, CURVATURE_TOLERANCE).mu),
        apart=apart,
        swing=swing,
        resonance=tuple((float(each), float(natural[np.abs(each / natural - 1.0).argmin()])) for each in periods),
        ground=find_sharpest_curvatures(ground(phase_grid(grid)).reshape(grid, grid, 1), ground)[0],
    )


def make_failed_evidence(question: CaseInReading, failed: TaskResult) -> Evidence:
    """Return evidence without values, for a task that ended without a result."""
    return Evidence(error_message=failed.reason)


def _measure_motions(scene: Scene) -> tuple[tuple[float, ...], float]:
    """
    Return two facts of the displacements at MOTION_PHASES.

    They are each body's largest |x - y|, over its largest displacement, and the platform's largest
    (displacement / rho)^2.
    """
    apart, swing = np.zeros(len(scene.bodies)), 0.0
    for phase in MOTION_PHASES:
        place = reference.trajectory(scene, phase, equations="small").position[..., :2]
        reach = np.abs(place).max(axis=(0, 2))
        apart = np.maximum(apart, np.abs(place[..., 0] - place[..., 1]).max(axis=0) / np.where(reach > 0, reach, 1.0))
        swing = max(swing, float((place[:, 0] ** 2).sum(axis=-1).max()) / scene.radius**2)
    return tuple(map(float, apart)), swing
