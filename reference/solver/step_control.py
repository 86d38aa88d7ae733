"""Control of the time steps in every contact phase: their first accelerations, length and acceptance."""

from __future__ import annotations

from math import exp, sqrt

from reference.solver.chain import set_chain_acceleration
from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.platform import load_in_state, moving_acceleration
from reference.solver.ground import ground_at, next_knot
from reference.solver.peaks import update_displacement, update_peaks
from reference.solver.polynomial import NODES_ROW, set_coefficients
from reference.solver.record import record_step
from reference.solver.rows import broadcast_like, put, row
from reference.solver.steps import vertical_acceleration
from reference.solver.system import REST, SLIDING, STOPPING, UNSOLVED, Ground, RunSettings, StepRecord, System
from reference.solver.work import CLOCK, Workspace

# Bounds on the ratio of the next step length to the present one, and the safety factor in it (`length_factor`)
MIN_LENGTH_FACTOR, MAX_LENGTH_FACTOR, SAFETY_FACTOR = 0.1, 5.0, 0.85
MAX_SHORTENING = 0.7  # a step that misses the tolerance is repeated with at most this share of its length
FAILURE_SHORTENING = 0.3  # share of its length with which a step is repeated whose equations were not solved
ERROR_ORDER = 7.0  # power of the step length with which the estimated error of a step falls
# Smallest acceleration to which a body's error is related, as a share of the loading's acceleration
MIN_SCALE_FRACTION = 0.02
# The shortest steps, in units of RunSettings.period. An outcome such as the rim is located by the steps that fail
# before it, down to FATAL_STEP; a step whose equations have no solution is shortened down to MIN_STEP.
FATAL_STEP = 1e-9  # share of RunSettings.period; if a shorter step fails at the rim, say, that outcome ends the run
MIN_STEP = 1e-16  # a step whose equations have no solution is shortened down to this length, in RunSettings.period
# Time within which no acceleration changes, as a share of the shorter of RunSettings.period and the duration
NEGLIGIBLE_TIME = 1e-11
NEWTON_FRACTION = 0.01  # Newton's method ends if accelerations change by less than this share of the tolerance
MAX_EXTRAPOLATION = 1.1  # largest ratio of a step to the last one at which the last polynomial gives its first guess


@compiled
def begin_from_state(system: System, work: Workspace, contact: int) -> None:
    """Set all accelerations at the start of a contact phase; `begin_sliding` replaces them for a slide from rest."""
    ground = ground_at(system, work, work.time)
    set_chain_acceleration(system, work, ground)
    ax = ay = 0.0
    still = work.v[0, 0] == 0.0 and work.v[0, 1] == 0.0
    if contact != REST and not (contact == SLIDING and still):
        load = load_in_state(system, work, ground)
        ax, ay, _, _, _ = moving_acceleration(system, contact, load, work.v[0, 0], work.v[0, 1])
    begin_with_acceleration(system, work, ground, ax, ay, contact)


@compiled
def begin_with_acceleration(
    system: System, work: Workspace, ground: Ground, ax: float, ay: float, contact: int
) -> None:
    """Set the platform's acceleration ax, ay and all bodies' absolute accelerations at the start of a contact phase."""
    work.a0[0, 0], work.a0[0, 1] = ax, ay
    vertical = ground.z
    if contact != REST:
        vertical += vertical_acceleration(system, work.x[0, 0], work.x[0, 1], work.v[0, 0], work.v[0, 1], ax, ay)
    for i in range(work.x.shape[0]):
        work.total0[i, 0] = work.a0[i, 0] + ground.x
        work.total0[i, 1] = work.a0[i, 1] + ground.y
        work.total0[i, 2] = vertical
    work.last_length = 0.0


@compiled
def count_step(work: Workspace, settings: RunSettings) -> bool:
    """Count one more step, and return False if it is past the limit of steps.

    Set work.scale, the accelerations to which the errors of the step are related.
    """
    for i in range(work.x.shape[0]):
        work.scale[i] = max(sqrt(work.best[i]), MIN_SCALE_FRACTION * settings.unit)
    work.steps += 1.0
    return work.steps <= settings.step_limit


@compiled
def negligible_time(system: System, settings: RunSettings) -> float:
    """Return the longest time, s, in which accelerations count as unchanged."""
    return NEGLIGIBLE_TIME * min(settings.period, system.duration)


@compiled
def remaining_time(system: System, work: Workspace, settings: RunSettings) -> float:
    """Return the time to the end of the run, s; 0 if it is so short that no acceleration changes in it."""
    left = work.end - work.time
    return left if left > negligible_time(system, settings) else 0.0


@compiled
def next_kink(system: System, work: Workspace, settings: RunSettings) -> float:
    """Return the time, s, of the next kink of the loading or of the temperature factor k_T, or the end of the run.

    A step across a kink would lose its order of accuracy.
    """
    after, end = work.time + negligible_time(system, settings), work.end
    for kinks in (system.record, system.kinks):
        k = next_knot(kinks, after)
        if k < kinks.shape[0]:
            end = min(end, kinks[k, 0])
    return end


@compiled
def propose_plain_length(system: System, work: Workspace, settings: RunSettings) -> float:
    """Return the length, s, of the next step in time: work.length, or less to the end of the run or the next kink."""
    return min(min(work.length, remaining_time(system, work, settings)), next_kink(system, work, settings) - work.time)


@compiled
def guess_from_last_step(work: Workspace, h: float) -> None:
    """Set the first guess of the platform's stage accelerations: the last step's polynomial, or the present one."""
    old = work.last_length
    theta = row(NODES_ROW, ())
    near = 0.0 < h <= MAX_EXTRAPOLATION * old
    if near:
        theta = 1.0 + theta * h / old
    for axis in range(2):
        guess = broadcast_like(0.0 if near else work.a0[0, axis], theta)
        if near:
            for m in range(STAGES - 1, -1, -1):
                guess = guess * theta + work.guess[axis, m]
        put(work.a, (0, axis), guess)


@compiled
def length_factor(error: float, tolerance: float) -> float:
    """Return the ratio, within bounds, of the length that would just meet the tolerance to the present length."""
    # The error falls like h^7, so the length that just meets the tolerance is the present one times
    # (tolerance / error)^(1/7) (Hairer and Wanner, IV.8). SAFETY_FACTOR makes the next step likely to pass, and the
    # bounds limit what a single estimate can change.
    if error <= 0.0:
        return MAX_LENGTH_FACTOR
    return min(MAX_LENGTH_FACTOR, max(MIN_LENGTH_FACTOR, SAFETY_FACTOR * (tolerance / error) ** (1.0 / ERROR_ORDER)))


@compiled
def step_duration(work: Workspace, contact: int, h: float) -> float:
    """Return how long, s, a step of length h takes, about: near a stop, h is in stretched time (near_stop.py)."""
    return h * exp(work.log_speed) if contact == STOPPING else h


@compiled
def is_too_short(work: Workspace, contact: int, settings: RunSettings, h: float, code: int) -> bool:
    """Return True if a step of length h is too short to be tried after one that failed with the outcome `code`."""
    shortest = (MIN_STEP if code == UNSOLVED else FATAL_STEP) * settings.period
    if contact == STOPPING and code == UNSOLVED:
        shortest *= 1e-3 * exp(min(0.0, work.log_speed))
    return step_duration(work, contact, h) < shortest


@compiled
def set_length(work: Workspace, contact: int, h: float) -> None:
    """Set the length of the next step: in stretched time tau (dt = speed dtau) near a stop, in s otherwise."""
    if contact == STOPPING:
        work.stretched_length = h
    else:
        work.length = h


@compiled
def adapt_length(work: Workspace, h: float, factor: float) -> None:
    """Set the next step's length after one that met the tolerance; a step cut short by an event does not reduce it."""
    if h * factor > work.length or h == work.length:
        work.length = h * factor


@compiled
def commit_step(system: System, work: Workspace, record: StepRecord, h: float, contact: int, parts: int) -> None:
    """Make the end of the step the new state, and update the peaks.

    For the peaks only those parts of the step count, `parts` in number, whose starts and ends are in work.edges.
    """
    if record.start.shape[0] > 0:
        record_step(work, record, h, contact)
    peaking = False
    for part in range(parts):
        low, high = work.edges[2 * part], work.edges[2 * part + 1]
        peaking = update_peaks(system, work, contact, h, low, high) or peaking
    far = contact != REST and update_displacement(work, h, contact == STOPPING)
    for axis in range(2):
        set_coefficients(row(work.a, (0, axis)), work.guess[axis])
    for i in range(work.x.shape[0]):
        for axis in range(2):
            work.x[i, axis] = work.x1[i, axis]
            work.v[i, axis] = work.v1[i, axis]
            work.a0[i, axis] = work.a[i, axis, STAGES - 1]
        for axis in range(3):
            work.total0[i, axis] = work.total[i, axis, STAGES - 1]
    work.last_length = 0.0 if contact in (STOPPING, REST) else h
    if contact != STOPPING:
        work.time += h
    if peaking or far:
        work.last_large = work.turning[CLOCK, STAGES - 1] if contact == STOPPING else work.time
    if peaking:
        work.last_peak = work.last_large
