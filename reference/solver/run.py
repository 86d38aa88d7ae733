"""
One run from the start to the end of the motion: rest, sliding and stopping (4.6), each change of contact located.

    rest      -> sliding                     when friction can no longer hold the platform
    sliding   -> stopping                    when the slide would stop within a step
    stopping  -> rest, creep or sliding      at the stop, below v_reg, or past the stop
    creep     -> sliding                     at v_reg (regularized law)
A lubricated contact stays lubricated. Each phase moves the state in `Workspace` on until the contact changes.
"""

from __future__ import annotations

from math import pi, sqrt

from reference.solver.compiled import cached_entry_point, compiled
from reference.solver.contact.platform import load_in_state, moving_acceleration, rest_excess
from reference.solver.contact.stop_arc import can_begin_slide
from reference.solver.ground import ground_at
from reference.solver.phases.follow import follow_phase
from reference.solver.phases.sliding import barely_slips, squared_speed_in_state
from reference.solver.step_control import remaining_time
from reference.solver.system import (
    CREEPING,
    LUBRICATED,
    LUBRICATED_SLIDING,
    PAINLEVE,
    REGULARIZED,
    REST,
    RIM,
    SET_VALUED,
    SLIDING,
    SOLVED,
    STEP_LIMIT,
    STOPPING,
    TRAVEL,
    UNSOLVED,
    Array,
    RunSettings,
    StepRecord,
    System,
)
from reference.solver.work import (
    Workspace,
    allocate_workspace,
    record_by_reference,
    reset_workspace,
    system_by_reference,
)

# Lengths of time below are in units of RunSettings.period, the time in which forces change.
FIRST_STEP = 0.02  # length of the first step of a run, as share of RunSettings.period, the time in which forces change
NEGLIGIBLE_REMAINDER = 1e-8  # share of RunSettings.period: a run that fails this close to its end counts as finished
HOLDING_TIME = 1e-6  # share of RunSettings.period: duration forced on rest or creep where two phases each end at once
RIM_SQUARED_FRACTION = 0.998  # squared displacement over the rim's, rho^2, above which a run that fails has reached it
# Largest number of successive phases of zero length: after more of them the state counts as on the border of two
# phases, each of which ends at once in favor of the other.
MAX_IDLE_PHASES = 4
# Inertia matrix determinant over that without friction, below which a run that fails has come to Painleve's paradox
MIN_DETERMINANT_FRACTION = 0.02
# A slide that cannot go on counts as rest below this share of (loading's acceleration * RunSettings.period / 2 pi)
MAX_CRAWL_SPEED = 1e-8


@compiled
def initial_contact(system: System, work: Workspace) -> int:
    """Return the state of the contact at the start of the motion."""
    if system.law == LUBRICATED:
        return LUBRICATED_SLIDING
    speed = squared_speed_in_state(system, work)
    if system.law == REGULARIZED:
        return CREEPING if speed < system.v_reg**2 else SLIDING
    if speed > 0.0:
        return SLIDING
    excess, reaction = rest_excess(system, load_in_state(system, work, ground_at(system, work, 0.0)))
    return SLIDING if excess > 0.0 and reaction > 0.0 else REST


@compiled
def classify_failure(system: System, work: Workspace, contact: int, settings: RunSettings, code: int) -> int:
    """Return how a run ends that failed with `code`: SOLVED if it is nearly at its end, RIM, PAINLEVE, or `code`."""
    if code == TRAVEL:
        return code
    if code != STEP_LIMIT and work.end - work.time < NEGLIGIBLE_REMAINDER * settings.period:
        return SOLVED
    if code not in (UNSOLVED, STEP_LIMIT):
        return code
    if work.x[0, 0] ** 2 + work.x[0, 1] ** 2 > RIM_SQUARED_FRACTION * system.radius**2:
        return RIM
    return PAINLEVE if contact != REST and is_paradox(system, work, contact) else code


@compiled
def is_paradox(system: System, work: Workspace, contact: int) -> bool:
    """Return True if the state is at Painleve's paradox: no slide can begin, or the reaction grows without bound."""
    load = load_in_state(system, work, ground_at(system, work, work.time))
    if contact == SLIDING and squared_speed_in_state(system, work) == 0.0:
        return not can_begin_slide(system, load, work.angle)
    moves = SLIDING if contact == STOPPING else contact
    _, _, _, determinant, _ = moving_acceleration(system, moves, load, work.v[0, 0], work.v[0, 1])
    tilt2 = (load.px * load.px + load.py * load.py) / system.radius**2
    without_friction: float = 1.0 + (system.mass_ratio - 1.0) * tilt2
    return determinant < MIN_DETERMINANT_FRACTION * without_friction


@compiled
def is_crawling(system: System, work: Workspace, contact: int, settings: RunSettings) -> bool:
    """Return True if a slide that cannot go on may count as rest: very slow, and drive barely above friction limit."""
    if system.law != SET_VALUED or contact == REST:
        return False
    slow2 = (MAX_CRAWL_SPEED * settings.unit * settings.period / (2.0 * pi)) ** 2
    return squared_speed_in_state(system, work) <= slow2 and barely_slips(system, work)


@compiled
def integrate(system: System, work: Workspace, settings: RunSettings, record: StepRecord, until: float) -> int:
    """
    Follow the motion from the state in work.x, work.v; return its outcome (system.py), at work.time.

    A run that may end early does so where no peak can grow any more (look_ahead.py). Any other run ends with the first
    step that goes beyond `until`, s. work.best (N,) holds the squared peaks of absolute acceleration, m^2/s^4.
    """
    # Two kinds of states lie on the border of two phases, and would make the run fail or circle without end.
    # A slide whose drive exceeds the friction limit by rounding alone has no acceleration that a step could resolve: it
    # counts as rest for HOLDING_TIME. And two phases may each end at once in favor of the other: after MAX_IDLE_PHASES
    # the next phase of rest or creep lasts HOLDING_TIME whatever the force. In that time nothing moves measurably.
    reset_workspace(work, min(FIRST_STEP * settings.period, system.duration), system.duration)
    work.look_time = 0.0 if settings.early else until
    contact = initial_contact(system, work)
    before, idle = -1.0, 0
    while remaining_time(system, work, settings) > 0.0:
        code, contact = follow_phase(system, work, contact, settings, record)
        if code == UNSOLVED and is_crawling(system, work, contact, settings):
            work.v[0, 0] = work.v[0, 1] = 0.0
            work.hold_time = max(work.hold_time, HOLDING_TIME * settings.period)
            work.length = max(work.length, work.hold_time)  # the failed slide has shortened the length to almost zero
            code, contact = SOLVED, REST
        if code != SOLVED:
            return classify_failure(system, work, contact, settings, code)
        idle = idle + 1 if work.time == before else 0
        before = work.time
        if idle > MAX_IDLE_PHASES:
            work.hold_time = max(work.hold_time, HOLDING_TIME * settings.period)
    return SOLVED


@compiled
def set_start(work: Workspace, phases: Array, x: Array, v: Array, m: int) -> None:
    """Set the initial phases of the loading in run m, and positions x and velocities v at the start of its motion."""
    work.phase[0], work.phase[1] = phases[m, 0], phases[m, 1]
    for i in range(x.shape[0]):
        for axis in range(2):
            work.x[i, axis] = x[i, axis]
            work.v[i, axis] = v[i, axis]


@compiled
def set_results(work: Workspace, code: int, peaks: Array, reading_errors: Array, ends: Array, m: int) -> None:
    """Write outcome `code`, peaks and their errors of run number m into the result arrays of `integrate_runs`."""
    ends[0, m], ends[1, m], ends[2, m], ends[3, m] = code, work.time, work.steps, sqrt(work.squared_reach)
    ends[4, m] = work.last_peak
    for i in range(peaks.shape[1]):
        peaks[m, i] = sqrt(work.best[i])
        reading_errors[m, i] = work.reading_error[i]


@cached_entry_point
def integrate_runs(
    system: System, phases: Array, x: Array, v: Array, settings: RunSettings, record: StepRecord,
    until: Array, peaks: Array, reading_errors: Array, ends: Array,
) -> None:  # fmt: skip
    """
    Follow M motions from positions x and velocities v, (N, 2), one for every pair of loading phases (M, 2), rad.

    Each ends at `until` (M,), s, or early (`integrate`). Filled in are peaks (M, N), the largest absolute
    accelerations, m/s^2, and reading_errors (M, N), m/s^2: the error of interpolation where the peak was read off, with
    what the steps before have missed of fast vibrations. The rows of `ends` (5, M) are outcome (system.py), instant (s)
    and number of steps of each run, the platform's largest displacement (m), and the end of the last step with an
    acceleration near the largest (s).
    """
    work = allocate_workspace(peaks.shape[1])
    system_reference, record_reference = system_by_reference(system), record_by_reference(record)
    for m in range(phases.shape[0]):
        set_start(work, phases, x, v, m)
        code = integrate(system_reference, work, settings, record_reference, until[m])
        set_results(work, code, peaks, reading_errors, ends, m)
