"""
Equations (4.3)-(4.6) taken to the letter, by an explicit method of fixed step.

A platform at rest compares |F_F| and |F_3| of (4.6) as printed. Where F_3 exceeds F_F, its direction takes the place of
the direction of the velocity in (4.3) for the first step, and the acceleration of that instant counts in (5.1). F_3 is
printed with two wrong signs, so that it does not point along the force that drives the platform: this acceleration is a
spike of one step. Its height does not fade as the step becomes shorter.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import reference
from comparison.analyses.claims import evidence
from comparison.analyses.claims.evidence import MOTIONS, Evidence, Question, with_facts
from comparison.analyses.claims.readings import CASES, LITERAL, SPEED, Reading, has_stops
from comparison.analyses.claims.table import Claims
from comparison.runner.task import Task
from reference.problem import GRAVITY, Outcome, Scene, exponents, ground_peak, phase_grid
from reference.solver.compiled import cached_entry_point

Array = NDArray[np.float64]

STEP = 1e-3  # s, 540 steps in the shortest period of the loading
STEPS = (8e-3, 4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4, 1.25e-4)  # s, of the spike
CASE = "fig3-I"
PHASES = ((0.3, 1.1), (2.0, 0.7), (4.0, 5.5))  # rad


class LiteralPeaks(NamedTuple):
    """
    What the motions show.

    mu: (M, N), of (5.1), NaN where the platform reaches the rim (4.1). apart: (M, N), max |x_i - y_i| over the largest
    of |x_i| and |y_i|. swing: (M,), max (x_1^2 + y_1^2) / rho^2. spikes: (M,), first steps of slip.
    """

    mu: Array
    apart: Array
    swing: Array
    spikes: NDArray[np.int64]


def literal_peaks(scene: Scene, phases: Array, step: float = STEP, spike: bool = True) -> LiteralPeaks:
    """
    Motions from rest of a chain with dry friction on two frequencies, under (4.3)-(4.6) as printed.

    phases: (M, 2), rad. step: s. spike: whether the instant at which slip begins counts in (5.1). The loading is
    horizontal and the links have no dampers.
    """
    masses, count = scene.masses, len(scene.bodies)
    below, above = np.zeros((count, 2)), np.zeros((count, 2))
    below[1:] = scene.stiffness / masses[1:, None]
    above[:-1] = scene.stiffness / masses[:-1, None]
    steps = round(scene.duration / step)
    support = scene.total_mass / masses[0] * GRAVITY
    turns, growth = np.exp(1j * np.asarray(phases, float)), np.exp(step * exponents(scene))
    square, apart, reach, swing, spikes = _motions(
        turns, scene.amplitudes[:2].copy(), growth, below, above, support, scene.friction_coefficient,
        1.0 / scene.radius, step, steps, spike,
    )  # fmt: skip
    mu = np.sqrt(square) / ground_peak(scene, phases)[:, None]
    mu[~(swing < scene.radius**2)] = np.nan
    return LiteralPeaks(mu, apart / np.where(reach > 0.0, reach, 1.0), swing / scene.radius**2, spikes)


@cached_entry_point
def _motions(
    turns: Any, amplitudes: Array, growth: Any, below: Array, above: Array, support: float, friction: float,
    curvature: float, h: float, steps: int, spike: bool,
) -> Any:  # fmt: skip
    """
    Largest squares of absolute accelerations, differences x_i - y_i, displacements, swings; numbers of first steps.

    turns: (M, 2), exp(i phase). growth: (2,), of the harmonics in a step. below, above: (N, 2), stiffness of the links
    over the mass of the body, 1/s^2. support: R_N = m_sum g / m_1.
    Semi-implicit Euler: v += h a(x, v), x += h v.
    """
    runs, n = len(turns), len(below)
    square, apart, reach = np.zeros((runs, n)), np.zeros((runs, n)), np.zeros((runs, n))
    swing, spikes = np.zeros(runs), np.zeros(runs, np.int64)
    x, v, a = np.empty((n, 2)), np.empty((n, 2)), np.empty((n, 2))
    for run in range(runs):
        x[:] = 0.0
        v[:] = 0.0
        z1, z2 = turns[run, 0], turns[run, 1]
        for _ in range(steps):
            ux = amplitudes[0, 0] * z1.real + amplitudes[0, 1] * z2.real
            uy = amplitudes[1, 0] * z1.real + amplitudes[1, 1] * z2.real
            for i in range(n):
                for axis in range(2):
                    force = -uy if axis else -ux
                    if i > 0:
                        force -= below[i, axis] * (x[i, axis] - x[i - 1, axis])
                    if i + 1 < n:
                        force -= above[i, axis] * (x[i, axis] - x[i + 1, axis])
                    a[i, axis] = force
            p, q = x[0, 0] * curvature, x[0, 1] * curvature
            vx, vy = v[0, 0], v[0, 1]
            resting = vx == 0.0 and vy == 0.0
            starts = False
            if resting:  # (4.6): the signs of both restoring forces are those of the print
                limit_x = friction * (support - p * ux - q * ux)
                limit_y = friction * (support - q * uy - p * uy)
                ex = -2.0 * ux - a[0, 0] + support * p
                ey = -2.0 * uy - a[0, 1] + support * q
                starts = limit_x * limit_x + limit_y * limit_y < ex * ex + ey * ey
            else:
                ex, ey = vx, vy
            if resting and not starts:
                a[0, 0] = a[0, 1] = 0.0
            else:  # (4.3)
                size = np.sqrt(ex * ex + ey * ey)
                ex, ey = ex / size, ey / size
                a[0, 0] -= support * p + friction * ((support - p * ux) * ex - q * ux * ey)
                a[0, 1] -= support * q + friction * ((support - q * uy) * ey - p * uy * ex)
            spikes[run] += starts
            swing[run] = max(swing[run], x[0, 0] ** 2 + x[0, 1] ** 2)
            for i in range(n):
                if spike or not starts:
                    square[run, i] = max(square[run, i], (a[i, 0] + ux) ** 2 + (a[i, 1] + uy) ** 2)
                apart[run, i] = max(apart[run, i], abs(x[i, 0] - x[i, 1]))
                reach[run, i] = max(reach[run, i], abs(x[i, 0]), abs(x[i, 1]))
                for axis in range(2):
                    v[i, axis] += h * a[i, axis]
            if not resting and vx * v[0, 0] + vy * v[0, 1] <= 0.0:  # it reversed: v = 0 within the step
                v[0, 0] = v[0, 1] = 0.0
            for i in range(n):
                for axis in range(2):
                    x[i, axis] += h * v[i, axis]
            z1, z2 = z1 * growth[0], z2 * growth[1]
    return square, apart, reach, swing, spikes


def gathered(question: Question) -> Evidence:
    """Surface, bends and motions of one case under one reading. Runs inside a worker process."""
    scene, grid = question.scene, question.grid
    if question.reading.peak != "literal (4.6)" or not has_stops(scene):
        return evidence.gathered(question)

    def factors(phases: Array) -> Array:
        return literal_peaks(scene, phases).mu

    surfaces = Evidence(factors(phase_grid(grid)).reshape(grid, grid, -1), 0.0, (str(Outcome.OK),), case=question.case)
    if not surfaces.complete:
        return replace(surfaces, statuses=(*surfaces.statuses, str(Outcome.RIM_REACHED)))
    if len(scene.bodies) == 1:
        return surfaces
    motions = literal_peaks(scene, np.array(MOTIONS))
    apart = tuple(map(float, motions.apart.max(axis=0)))
    return with_facts(surfaces, scene, factors, apart, float(motions.swing.max()))


class LiteralClaims(Claims):
    """The claims with the literal readings computed, not as recorded."""

    recorded = False

    def asking(self, question: Question) -> Task:
        """What gathers the evidence of a question, by the literal integration where the reading asks for it."""
        return Task(gathered, question, self.stage)


@dataclass(frozen=True)
class Spike:
    """
    mu_1 of the literal integration over its step.

    counted, left_out: for each of STEPS mu_1 at each of PHASES, with and without the instants at which slip begins.
    starts: how many these are. limit: mu_1 of the reference, with (4.6) as its condition of rest alone.
    """

    counted: list[list[float]]
    left_out: list[list[float]]
    starts: list[list[int]]
    limit: list[float]


def spike_over_the_step(reading: Reading = LITERAL) -> Spike:
    """The spike under a reading."""
    scene, phases = CASES[CASE](reading), np.array(PHASES)
    runs = [[literal_peaks(scene, phases, step, spike) for step in STEPS] for spike in (True, False)]
    limit = reference.amplification(scene, phases, "small", cutoff=SPEED, tolerance=1e-4, rest_condition="printed")
    counted, left_out = ([run.mu[:, 0].tolist() for run in each] for each in runs)
    return Spike(counted, left_out, [run.spikes.tolist() for run in runs[0]], limit.mu[:, 0].tolist())
