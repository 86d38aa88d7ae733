"""
One run from 0 to the end of the motion: the three-structure model around (4.6), every change located.

    rest      -> sliding                     when friction can no longer hold the platform
    sliding   -> stopping                    when the slide would stop within a step
    stopping  -> rest, creep or sliding      into the stop, below v_reg, or past the stop
    creep     -> sliding                     at v_reg (regularized law)
A lubricated contact stays lubricated. Each phase carries the state in `Workspace` on until the contact changes.
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

FIRST_STEP = 0.02  # of the period (Demand.period)
NEGLIGIBLE_REMAINDER = 1e-8  # of the period: a run that fails so shortly before its end counts as finished
RIM_SQUARED_FRACTION = 0.998  # of the squared radius: a run that fails beyond it has reached the rim
HOLDING_TIME = 1e-6  # of the period: time in rest or creep of a state on the border of two phases
MAX_IDLE_PHASES = 4  # phases without time: beyond them the state is on the border of two that each gives to the other
# of the inertia determinant without friction: a run that fails below it has come to Painleve's paradox
MIN_DETERMINANT_FRACTION = 0.02
MAX_CRAWL_SPEED = 1e-8  # of the loading's velocity: a slide that cannot go on at this speed has not moved


@compiled
def initial_contact(system: System, work: Workspace) -> int:
    """What the contact does in the initial state."""
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
    """What a run that cannot go on has come to: nearly its end, the rim (4.1), a paradox, or the trouble it reports."""
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
    """Whether no slide can begin in the state, or the reaction has outgrown every bound in it (Painleve)."""
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
    """Whether a slide that cannot go on hardly moves, under a drive that hardly exceeds the friction limit."""
    if system.law != SET_VALUED or contact == REST:
        return False
    slow2 = (MAX_CRAWL_SPEED * settings.unit * settings.period / (2.0 * pi)) ** 2
    return squared_speed_in_state(system, work) <= slow2 and barely_slips(system, work)


@compiled
def integrate(system: System, work: Workspace, settings: RunSettings, record: StepRecord, until: float) -> int:
    """
    Follow the motion from the state in work.x, work.v; how it ended (system.py), at work.time.

    A run that may end early does so where nothing large can come any more (look_ahead.py), any other with the first
    whole step beyond `until`, s.

    work.best (N,) holds the squared peaks of absolute acceleration, m^2/s^4.
    """
    reset_workspace(work, min(FIRST_STEP * settings.period, system.duration), system.duration)
    work.look_time = 0.0 if settings.early else until
    contact = initial_contact(system, work)
    before, idle = -1.0, 0
    while remaining_time(system, work, settings) > 0.0:
        code, contact = follow_phase(system, work, contact, settings, record)
        if code == UNSOLVED and is_crawling(system, work, contact, settings):
            work.v[0, 0] = work.v[0, 1] = 0.0
            work.hold_time = max(work.hold_time, HOLDING_TIME * settings.period)
            work.length = max(work.length, work.hold_time)  # the slide has shortened it to nothing
            code, contact = SOLVED, REST
        if code != SOLVED:
            return classify_failure(system, work, contact, settings, code)
        idle = idle + 1 if work.time == before else 0
        before = work.time
        if idle > MAX_IDLE_PHASES:
            work.hold_time = max(work.hold_time, HOLDING_TIME * settings.period)
    return SOLVED


@cached_entry_point
def integrate_runs(
    system: System, phases: Array, x: Array, v: Array, settings: RunSettings, record: StepRecord,
    until: Array, peaks: Array, reading_errors: Array, ends: Array,
) -> None:  # fmt: skip
    """
    Follow the motion from x, v (N, 2) for every phase pair (M, 2), rad, until (M,), s, or an early end.

    Fills peaks (M, N), the largest absolute accelerations, m/s^2, and reading_errors (M, N), their errors inside their
    steps with what the steps before missed of vibrations, and ends (5, M): how (system.py), when (s) and after how many
    steps each run ended, the platform's largest displacement (m), and from when on no acceleration comes near the
    largest (s).
    """
    work = allocate_workspace(peaks.shape[1])
    system_reference, record_reference = system_by_reference(system), record_by_reference(record)
    for m in range(phases.shape[0]):
        work.phase[0], work.phase[1] = phases[m, 0], phases[m, 1]
        for i in range(x.shape[0]):
            for axis in range(2):
                work.x[i, axis] = x[i, axis]
                work.v[i, axis] = v[i, axis]
        code = integrate(system_reference, work, settings, record_reference, until[m])
        ends[0, m], ends[1, m], ends[2, m], ends[3, m] = code, work.time, work.steps, sqrt(work.squared_reach)
        ends[4, m] = work.last_peak
        for i in range(peaks.shape[1]):
            peaks[m, i] = sqrt(work.best[i])
            reading_errors[m, i] = work.reading_error[i]
