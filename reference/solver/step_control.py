"""What every phase of a run does with a step: begin, judge its length, commit it."""

from __future__ import annotations

from math import sqrt

from reference.solver.chain import chain_acceleration
from reference.solver.collocation import MONOMIALS, NODES, STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.platform import moving
from reference.solver.ground import ground_at, knot_after
from reference.solver.peaks import take_peaks, take_reach
from reference.solver.record import record_step
from reference.solver.steps import lifted
from reference.solver.system import (
    LENGTH,
    OLD_LENGTH,
    REST,
    SLIDING,
    STEPS,
    STOPPING,
    TIME,
    UNSOLVED,
    Array,
    Demand,
    Record,
    System,
    Work,
)

MIN_LENGTH_FACTOR, MAX_LENGTH_FACTOR, SAFETY_FACTOR = 0.1, 5.0, 0.85
ERROR_ORDER = 7.0  # order of the error estimate in the step length
MIN_SCALE_FRACTION = 0.02  # of the loading: lower bound on the acceleration that the error of a body is relative to
FATAL_STEP = 1e-9  # of the period (Demand.period): a step this short that still fails has located the instant
MIN_STEP = 1e-16  # of the period: shortest step
NEGLIGIBLE_TIME = 1e-11  # of the shorter of period and duration: no acceleration changes within it
NEWTON_FRACTION = 0.01  # of the tolerance: change of the accelerations at which Newton's method ends


@compiled
def drive(system: System, work: Work, ux: float, uy: float) -> tuple[float, float]:
    """Driving acceleration of the platform in the state x (equations.py), m/s^2."""
    fx, fy = -ux, -uy
    if work.x.shape[0] > 1:
        fx += system.above[0, 0] * (work.x[1, 0] - work.x[0, 0])
        fy += system.above[0, 1] * (work.x[1, 1] - work.x[0, 1])
    return fx, fy


@compiled
def begin(system: System, phase: Array, work: Work, contact: int) -> None:
    """Accelerations of the state; a slide that has no direction yet is begun by sliding_phase. No guess for a step."""
    ux, uy, uz = ground_at(system, phase, work.run[TIME])
    chain_acceleration(system, work, ux, uy)
    ax = ay = 0.0
    still = work.v[0, 0] == 0.0 and work.v[0, 1] == 0.0
    if contact != REST and not (contact == SLIDING and still):
        fx, fy = drive(system, work, ux, uy)
        ax, ay, _, _, _ = moving(
            system, contact, work.x[0, 0], work.x[0, 1], work.v[0, 0], work.v[0, 1], fx, fy, ux, uy, system.gravity + uz
        )
    begin_with(system, work, ax, ay, ux, uy, uz, contact == REST)


@compiled
def begin_with(
    system: System, work: Work, ax: float, ay: float, ux: float, uy: float, uz: float, resting: bool
) -> None:
    """The platform's acceleration at the start of a phase, and with it the absolute accelerations there."""
    work.a0[0, 0], work.a0[0, 1] = ax, ay
    vertical = uz
    if not resting:
        vertical += lifted(system, work.x[0, 0], work.x[0, 1], work.v[0, 0], work.v[0, 1], ax, ay)
    for i in range(work.x.shape[0]):
        work.total0[i, 0] = work.a0[i, 0] + ux
        work.total0[i, 1] = work.a0[i, 1] + uy
        work.total0[i, 2] = vertical
    work.run[OLD_LENGTH] = 0.0


@compiled
def next_step(work: Work, demand: Demand) -> bool:
    """Count one more step and set what its error is measured against; False past the limit of steps."""
    for i in range(work.x.shape[0]):
        work.scale[i] = max(sqrt(work.best[i]), MIN_SCALE_FRACTION * demand.unit)
    work.run[STEPS] += 1.0
    return work.run[STEPS] <= demand.step_limit


@compiled
def remaining(system: System, work: Work, demand: Demand) -> float:
    """Time left, s; 0 when it is so little that nothing changes."""
    left = system.duration - work.run[TIME]
    return left if left > NEGLIGIBLE_TIME * min(demand.period, system.duration) else 0.0


@compiled
def next_break(system: System, work: Work, demand: Demand) -> float:
    """Where the loading has its next kink, s, or the motion ends: a step beyond it would lose its order."""
    if system.record.shape[0] > 0:
        k = knot_after(system.record, work.run[TIME] + NEGLIGIBLE_TIME * min(demand.period, system.duration))
        if k < system.record.shape[0]:
            return min(system.record[k, 0], system.duration)
    return system.duration


@compiled
def unbroken(system: System, work: Work, demand: Demand) -> float:
    """Time that a step may take, s: to the loading's next kink, or what remains."""
    return min(remaining(system, work, demand), next_break(system, work, demand) - work.run[TIME])


@compiled
def first_guess(work: Work, h: float) -> None:
    """Stage accelerations of the platform to start Newton's method: the last step's polynomial where it reaches."""
    old = work.run[OLD_LENGTH]
    for axis in range(2):
        for k in range(STAGES):
            guess = work.a0[0, axis]
            if 0.0 < h <= 1.1 * old:
                theta = 1.0 + NODES[k] * h / old
                guess = 0.0
                for m in range(STAGES - 1, -1, -1):
                    guess = guess * theta + work.guess[axis, m]
            work.a[0, axis, k] = guess


@compiled
def length_factor(error: float, tolerance: float) -> float:
    """By what to multiply the step length so that the next error meets the tolerance."""
    if error <= 0.0:
        return MAX_LENGTH_FACTOR
    return min(MAX_LENGTH_FACTOR, max(MIN_LENGTH_FACTOR, SAFETY_FACTOR * (tolerance / error) ** (1.0 / ERROR_ORDER)))


@compiled
def too_short(demand: Demand, h: float, code: int) -> bool:
    """Whether a step that failed with `code` need not be tried with a shorter one."""
    return h < (MIN_STEP if code == UNSOLVED else FATAL_STEP) * demand.period


@compiled
def shortened(work: Work, demand: Demand, h: float, factor: float) -> bool:
    """Set a shorter length for a step that misses the tolerance; False if it is as short as steps get."""
    if h < MIN_STEP * demand.period:
        return False
    work.run[LENGTH] = h * min(0.7, factor)
    return True


@compiled
def adapt(work: Work, h: float, factor: float) -> None:
    """The length after a step that was made; one cut short for another reason does not shorten the next."""
    if h * factor > work.run[LENGTH] or h == work.run[LENGTH]:
        work.run[LENGTH] = h * factor


@compiled
def commit(work: Work, record: Record, h: float, contact: int, low: float, high: float) -> None:
    """Make the step's end the new state; its part [low, high] counts for the peaks."""
    if record.start.shape[0] > 0:
        record_step(work, record, h, contact)
    if high > low:
        take_peaks(work, low, high)
    if contact != REST:
        take_reach(work, h, contact == STOPPING)
    for axis in range(2):
        for k in range(STAGES):
            coefficient = 0.0
            for m in range(STAGES):
                coefficient += MONOMIALS[k, m] * work.a[0, axis, m]
            work.guess[axis, k] = coefficient
    for i in range(work.x.shape[0]):
        for axis in range(2):
            work.x[i, axis] = work.x1[i, axis]
            work.v[i, axis] = work.v1[i, axis]
            work.a0[i, axis] = work.a[i, axis, STAGES - 1]
        for axis in range(3):
            work.total0[i, axis] = work.total[i, axis, STAGES - 1]
    work.run[OLD_LENGTH] = 0.0 if contact in (STOPPING, REST) else h
    if contact != STOPPING:
        work.run[TIME] += h
