"""
One run under friction that yields: elastic until its force reaches its limit, plastic until slip would reverse.

Every change is located; the steps are those of run.py, with their error, peaks and record.
"""

from __future__ import annotations

from math import inf

from reference.solver.compiled import cached_entry_point, compiled
from reference.solver.events import NOT_IN_STEP
from reference.solver.phases.follow import MAX_VIBRATION_ANGLE, commit_within_travel, vibration_angle
from reference.solver.phases.yielding import (
    begin_yielding,
    commit_force,
    locate_event,
    shift_to_event,
    solve_yielding_step,
    step_share_to_slowest_point,
)
from reference.solver.record import record_stick
from reference.solver.run import (
    FIRST_STEP,
    HOLDING_TIME,
    MAX_IDLE_PHASES,
    classify_failure,
    set_results,
    set_start,
)
from reference.solver.step_control import (
    FAILURE_SHORTENING,
    MAX_SHORTENING,
    NEWTON_FRACTION,
    adapt_length,
    count_step,
    guess_from_last_step,
    is_too_short,
    length_factor,
    propose_plain_length,
    remaining_time,
)
from reference.solver.steps import set_step_loads, step_error
from reference.solver.system import (
    ELASTIC,
    PLASTIC,
    SOLVED,
    STEP_LIMIT,
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

# Ratio of a phase's first step to an ordinary one: it is short so that no event before its first stage is missed.
FIRST_STEP_SHARE = 0.1
# Largest errors of the times of yielding and of unloading, as shares of the step that ends there; largest number of
# steps that are solved again to end at one of them.
# The error of unloading may be larger, since its effect is of second order.
YIELD_SHARE, UNLOADING_SHARE, MAX_AIMED_STEPS = 1e-11, 1e-6, 8
MIN_EVENT_TIME = 1e-12  # share of RunSettings.period: an event this soon after a step's start counts as at the start


@compiled
def try_step(system: System, work: Workspace, contact: int, settings: RunSettings, h: float, held: bool) -> int:
    """Solve one step of length h, s, elastic or plastic; return its outcome, UNSOLVED also if it is too short.

    With `held`, the contact keeps its state whatever the force, and the step may be shorter.
    """
    if is_too_short(work, contact, settings, h, SOLVED if held else UNSOLVED):
        return UNSOLVED
    set_step_loads(system, work, h)
    guess_from_last_step(work, h)
    code: int = solve_yielding_step(system, work, contact, h, NEWTON_FRACTION * settings.tolerance * work.scale[0])
    return code


@compiled
def aim_at_event(
    system: System, work: Workspace, contact: int, settings: RunSettings, h: float, aims: int, begun: bool
) -> tuple[float, bool]:
    """Return where the phase ends as a share of the step, 1 if the step stands, and True if the phase ends with it.

    A share other than 0 and 1 asks for a new step of that share of h, s, so that it ends at the event; aims counts
    such steps, and `begun` marks a first step behind a change of contact or a kink of friction.
    """
    # `locate_event` finds the event on the polynomials of a long step. Steps that end there are solved anew, and each
    # is lengthened or shortened by `shift_to_event`, until the end is accurate enough: Newton's method on whole steps.
    if aims > 0:
        shift = shift_to_event(system, work, contact, h)
        near = abs(shift) <= (YIELD_SHARE if contact == ELASTIC else UNLOADING_SHARE) or aims == MAX_AIMED_STEPS
        return 1.0 if shift == NOT_IN_STEP or near else 1.0 + shift, shift != NOT_IN_STEP
    portion = locate_event(system, work, contact, h, begun)
    reached = portion * h <= MIN_EVENT_TIME * settings.period
    return 0.0 if reached else min(portion, 1.0), reached


@compiled
def accept_step(
    system: System, work: Workspace, record: StepRecord, contact: int, h: float, angle: float, factor: float
) -> bool:
    """Make the end of a step h, s, the new state; return True if the platform reaches the isolator's travel in it.

    angle: of `vibration_angle`; factor: of `length_factor`.
    """
    work.edges[0], work.edges[1] = 0.0, 1.0
    outcome = commit_within_travel(system, work, record, h, contact, 1, angle)
    commit_force(work)
    if outcome == TRAVEL:
        return True
    adapt_length(work, h, factor)
    return False


@compiled
def change_contact(system: System, work: Workspace, record: StepRecord, contact: int, since: float) -> int:
    """Prepare the phase that follows an elastic or plastic one, and return it; since: when the old one began, s."""
    if contact == ELASTIC:
        record_stick(record, since, work.time)
    following = PLASTIC if contact == ELASTIC else ELASTIC
    begin_yielding(system, work, following, contact == PLASTIC)
    return following


@compiled
def integrate_yielding(system: System, work: Workspace, settings: RunSettings, record: StepRecord, until: float) -> int:
    """Follow a motion under friction that yields until a step passes `until`, s; otherwise as `integrate` in run.py."""
    # The loop's state: `idle` counts successive phases of zero length, `shorter` is the length of a step that was cut
    # to end at an event (infinite if none was), `aims` counts such cuts, `begun` marks a first step behind a change of
    # contact or a kink of friction, and `since` is the time of the last change of contact.
    # The checks of a step are those of `follow_phase`. The friction force is zero at the start. Where two phases end at
    # once in favor of the other, the next one makes a short step whatever its events.
    reset_workspace(work, min(FIRST_STEP * settings.period, system.duration), system.duration)
    work.force[0] = work.force[1] = 0.0
    contact, idle, shorter, aims, begun, since = ELASTIC, 0, inf, 0, False, work.time
    begin_yielding(system, work, contact, False)
    while remaining_time(system, work, settings) > 0.0 and work.time <= until:
        if not count_step(work, settings):
            return classify_failure(system, work, contact, settings, STEP_LIMIT)
        held, h = idle > MAX_IDLE_PHASES, propose_plain_length(system, work, settings)
        aims = 0 if h < shorter else aims  # the step ends at a kink of the loading, before the event
        h = min(
            h,
            shorter,
            FIRST_STEP_SHARE * work.length if begun else inf,
            HOLDING_TIME * settings.period if held else inf,
        )
        code = try_step(system, work, contact, settings, h, held)
        if code != SOLVED:
            if is_too_short(work, contact, settings, h, code):
                return classify_failure(system, work, contact, settings, code)
            work.length, shorter, aims = FAILURE_SHORTENING * h, inf, 0
            continue
        smooth = 1.0 if held or aims > 0 else step_share_to_slowest_point(system, work)
        if smooth < 1.0:
            shorter = h * smooth
            continue
        angle = vibration_angle(system, contact, h)
        weight = settings.damped_weight if angle > MAX_VIBRATION_ANGLE else 1.0
        error = step_error(system, work, settings.tolerance, weight)
        factor = length_factor(error, settings.tolerance)
        if not error <= settings.tolerance:
            work.length, shorter, aims = min(MAX_SHORTENING, factor) * h, inf, 0
            continue
        share, ends = (1.0, False) if held else aim_at_event(system, work, contact, settings, h, aims, begun)
        if share != 0.0 and share != 1.0:
            shorter, aims = h * share, aims + 1
            continue
        if share > 0.0:
            if accept_step(system, work, record, contact, h, angle, factor):
                return TRAVEL
            idle, begun, shorter, aims = 0, aims == 0 and h == shorter, inf, 0
        if ends:
            contact = change_contact(system, work, record, contact, since)
            idle, begun, shorter, aims, since = idle + 1, True, inf, 0, work.time
    if contact == ELASTIC:
        record_stick(record, since, work.time)
    return SOLVED


@cached_entry_point
def integrate_yielding_runs(
    system: System, phases: Array, x: Array, v: Array, settings: RunSettings, record: StepRecord,
    until: Array, peaks: Array, reading_errors: Array, ends: Array,
) -> None:  # fmt: skip
    """Follow the motions under friction that yields, and fill in the same results as `integrate_runs` (run.py)."""
    work = allocate_workspace(peaks.shape[1])
    system_reference, record_reference = system_by_reference(system), record_by_reference(record)
    for m in range(phases.shape[0]):
        set_start(work, phases, x, v, m)
        code = integrate_yielding(system_reference, work, settings, record_reference, until[m])
        set_results(work, code, peaks, reading_errors, ends, m)
