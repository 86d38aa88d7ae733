"""The loop over the steps of a contact phase: a step is proposed, solved, checked, cut at an event and committed."""

from __future__ import annotations

from math import inf, log, sqrt

from reference.solver.compiled import compiled
from reference.solver.contact.friction import decay_rate, kinetic_coefficient, rising_rate
from reference.solver.events import LEVEL_EVENT, SPEED_EVENT, expand_level, expand_speed, mark_parts
from reference.solver.look_ahead import end_run_early
from reference.solver.near_stop import solve_near_stop_step
from reference.solver.peaks import link_error_rate
from reference.solver.phases.rest import begin_rest, set_reaction, shorten_step_to_onset
from reference.solver.phases.sliding import (
    adapt_sliding_length,
    begin_sliding,
    guess_slide,
    guess_turning_slide,
    is_slow,
    limit_step_to_creep,
    propose_sliding_length,
    recover_failed_slide,
    squared_speed_in_state,
    turns_too_far,
)
from reference.solver.phases.smooth import begin_smooth, limit_step_to_slide
from reference.solver.phases.stopping import (
    NEAR_STOP_NEWTON_FRACTION,
    begin_stopping,
    commit_stopping_step,
    limit_step_to_kink_or_creep,
    propose_stretched_length,
)
from reference.solver.record import record_stick
from reference.solver.rows import row, row_maximum, row_minimum
from reference.solver.step_control import (
    FAILURE_SHORTENING,
    MAX_SHORTENING,
    NEWTON_FRACTION,
    adapt_length,
    commit_step,
    count_step,
    guess_from_last_step,
    is_too_short,
    length_factor,
    propose_plain_length,
    remaining_time,
    set_length,
)
from reference.solver.steps import set_step_loads, solve_moving_step, solve_rest_step, step_error
from reference.solver.system import (
    CREEPING,
    OPEN,
    REST,
    SLIDING,
    SOLVED,
    STEP_LIMIT,
    STOPPING,
    TRAVEL,
    UNSOLVED,
    RunSettings,
    StepRecord,
    System,
)
from reference.solver.travel import instant_of_travel
from reference.solver.work import REACTION, SQUARED_SPEED, Workspace

# Rounding error of the platform's acceleration, a difference of forces over m1, as a share of the friction limit
FRICTION_ROUNDING = 1e-14
MAX_VIBRATION_ANGLE = 5.0  # rad, phase angle of the upper bodies' fastest vibration per step; larger steps damp it
# Drift is the error that steps leave in a free vibration. A step in which its phase moves by `angle`, rad, adds
# DRIFT_SHARE * angle^7 * d, with d the interpolation error at the start of the step. The sum counts up to the size of
# the vibration, d / (2 DRIFT_SHARE angle^7): docs/decisions/0002-two-run-error.md.
DRIFT_SHARE = 6e-8
# Steps in which the fastest vibration moves by less, rad, add no drift: 100 would add < 1e-3 of a tolerance
MIN_DRIFT_ANGLE = 2.0
# Factor on the tolerance of Newton's method for a slide whose friction depends on the speed
VARYING_NEWTON_FRACTION = 1e-3


@compiled
def follow_phase(
    system: System, work: Workspace, contact: int, settings: RunSettings, record: StepRecord
) -> tuple[int, int]:
    """Follow the motion until the contact changes or the run ends; return the outcome and the next contact state."""
    # A step goes through five checks. (1) The phase proposes its length; a slide about to stop proposes none and hands
    # over to stretched time. (2) Its equations are solved; if they are not, it is tried again and shorter, down to the
    # length at which the outcome counts as located. (3) Its error must meet the tolerance. (4) The first event inside
    # it ends it: the shorter step is solved again, in rest by `shorten_step_to_onset`, otherwise by the next pass,
    # so that a step always ends at the event. (5) Peaks, displacement and drift are read off it before its end becomes
    # the new state.
    since = begin_contact_phase(system, work, contact, settings)
    following = contact
    while following == contact and remaining_time(system, work, settings) > 0.0:
        if not count_step(work, settings):
            return STEP_LIMIT, contact
        h = propose_length(system, work, contact, settings)
        if h == 0.0:
            return SOLVED, STOPPING
        if is_too_short(work, contact, settings, h, UNSOLVED):
            return UNSOLVED, contact
        code = solve_step(system, work, contact, settings, h)
        if code != SOLVED:
            code, following = shorten_failed_step(system, work, contact, settings, h, code)
            if code != SOLVED:
                return code, contact
            continue
        angle = vibration_angle(system, contact, h)
        damps = angle > MAX_VIBRATION_ANGLE
        error = step_error(system, work, settings.tolerance, settings.damped_weight if damps else 1.0)
        factor = length_factor(error, settings.tolerance)
        if not error <= settings.tolerance:
            set_length(work, contact, min(MAX_SHORTENING, factor) * h)
            continue
        end, following = limit_step_to_event(system, work, contact, settings, h)
        if end == 0.0:
            break
        if end < h and contact != REST:
            set_length(work, contact, end)
            following = contact
            continue
        parts = mark_counted_parts(system, work, contact, settings, end, since)
        if commit_within_travel(system, work, record, end, contact, parts, angle) == TRAVEL:
            return TRAVEL, contact
        following = prepare_next_step(system, work, contact, following, settings, end, factor)
        if contact != STOPPING and work.time > work.look_time:
            end_run_early(system, work, settings)
    if contact in (REST, CREEPING):
        record_stick(record, since, work.time)
    return SOLVED, following


@compiled
def shorten_failed_step(
    system: System, work: Workspace, contact: int, settings: RunSettings, h: float, code: int
) -> tuple[int, int]:
    """Shorten the next step after one of length h that failed with `code`.

    Return SOLVED or the reason to give up, and the next contact state.
    """
    following = contact
    if code != UNSOLVED and is_too_short(work, contact, settings, h, code):
        return code, contact
    if contact == SLIDING:
        code, following = recover_failed_slide(system, work, settings, h)
        if code != SOLVED:
            return code, contact
    if following == contact:
        set_length(work, contact, FAILURE_SHORTENING * h)
    return SOLVED, following


@compiled
def commit_within_travel(
    system: System, work: Workspace, record: StepRecord, h: float, contact: int, parts: int, angle: float
) -> int:
    """Make the end of a step the new state, and return SOLVED, or TRAVEL if the isolator's travel is passed in it.

    work.time is then the time of passing. parts: of `mark_counted_parts`; angle: of `vibration_angle`.
    """
    reached = instant_of_travel(system, work, contact, h)
    if angle > MIN_DRIFT_ANGLE:
        add_drift(system, work, h, angle)
    commit_step(system, work, record, h, contact, parts)
    if reached < inf:
        work.time = reached
        return TRAVEL
    return SOLVED


@compiled
def vibration_angle(system: System, contact: int, h: float) -> float:
    """Return how far, rad, the fastest vibration's phase moves in a step h; 0 near a stop, where steps are short."""
    return 0.0 if contact == STOPPING else system.fastest * h


@compiled
def add_drift(system: System, work: Workspace, h: float, angle: float) -> None:
    """Add a step's error in the fastest vibration to work.drift, m/s^2, up to the size of the vibration itself."""
    share = min(DRIFT_SHARE * angle**7, 1.0)
    for i in range(work.x.shape[0]):
        defect = sqrt(work.defect[i] ** 2 + (link_error_rate(system, work, h, i) / system.fastest) ** 2)
        largest = defect / min(2.0 * share, 1.0)
        work.drift[i] = max(work.drift[i], min(work.drift[i] + share * defect, largest))


@compiled
def begin_contact_phase(system: System, work: Workspace, contact: int, settings: RunSettings) -> float:
    """Prepare the first step of a contact phase; return the time, s, from which the contact is in this state."""
    since: float = work.time
    if contact == REST:
        since = begin_rest(system, work)
    elif contact == SLIDING:
        begin_sliding(system, work, settings)
    elif contact == STOPPING:
        begin_stopping(system, work, settings)
    else:
        begin_smooth(system, work, contact)
    return since


@compiled
def propose_length(system: System, work: Workspace, contact: int, settings: RunSettings) -> float:
    """Return the length of the next step, s, or near a stop in stretched time (near_stop.py).

    It is 0 if a slide is to go on in stretched time.
    """
    if contact == SLIDING:
        return propose_sliding_length(system, work, settings)
    if contact == STOPPING:
        return propose_stretched_length(system, work)
    h: float = propose_plain_length(system, work, settings)
    return min(h, work.hold_time) if work.hold_time > 0.0 else h


@compiled
def solve_step(system: System, work: Workspace, contact: int, settings: RunSettings, h: float) -> int:
    """Solve the equations of one step in the contact state `contact`; return the outcome (system.py)."""
    if contact == STOPPING:
        code: int = solve_near_stop_step(system, work, h, NEAR_STOP_NEWTON_FRACTION * settings.tolerance)
        return code
    if contact == REST:
        solve_rest_step(system, work, h)
        set_reaction(system, work)
        return OPEN if row_minimum(row(work.stage, REACTION)) <= 0.0 else SOLVED
    set_step_loads(system, work, h)
    enough = NEWTON_FRACTION * settings.tolerance * work.scale[0]
    if contact == SLIDING:
        guess_slide(system, work, h)
        if system.rate > 0.0:
            # Where friction depends on the speed, small errors of the speed grow or decay slowly: they reach the next
            # step and turn its direction.
            rounding = FRICTION_ROUNDING * kinetic_coefficient(system) * system.mass_ratio * system.gravity
            enough = max(VARYING_NEWTON_FRACTION * enough, rounding)
            enough /= 1.0 + h * rising_rate(system, sqrt(work.squared_start_speed))
    else:
        guess_from_last_step(work, h)
        # Stiff friction turns a small error of the acceleration into a large one of velocity and force.
        enough /= 1.0 + h * decay_rate(system, contact)
    code = solve_moving_step(system, work, contact, h, enough)
    if code == UNSOLVED and contact == SLIDING and system.axes == 2 and is_slow(system, work, h):
        guess_turning_slide(system, work, h)
        code = solve_moving_step(system, work, contact, h, enough)
    return UNSOLVED if code == SOLVED and contact == SLIDING and turns_too_far(work) else code


@compiled
def limit_step_to_event(
    system: System, work: Workspace, contact: int, settings: RunSettings, h: float
) -> tuple[float, int]:
    """Return the length of a step h up to its first event, 0 if that is at its start, and the contact from there on.

    Events are changes of contact, and near a stop also kinks of the loading.
    """
    if contact == REST:
        return shorten_step_to_onset(system, work, h)
    if contact == SLIDING:
        return limit_step_to_creep(system, work, h)
    if contact == STOPPING:
        return limit_step_to_kink_or_creep(system, work, settings, h)
    return limit_step_to_slide(system, work, contact, h)


@compiled
def mark_counted_parts(
    system: System, work: Workspace, contact: int, settings: RunSettings, h: float, since: float
) -> int:
    """
    Set work.edges to start and end, in theta, of each part of a step that counts for the peaks; return their number.

    Rest counts from `since` on, creep below v_reg, sliding above the cutoff, and all other motion in full.
    """
    # A phase of rest begins a little before the platform has stopped (`contact_after_stop`); this time is not rest.
    # Creep (friction linear in speed, to v_reg) may begin or end above v_reg by the accuracy of an event, where it has
    # more friction than any slide. Both would add an acceleration to the peaks that the motion does not have.
    if contact == CREEPING:
        level, start2 = system.v_reg * system.v_reg, squared_speed_in_state(system, work)
        if max(start2, row_maximum(row(work.stage, SQUARED_SPEED))) > level:
            expand_speed(work, h, level)
            return mark_parts(system, work, SPEED_EVENT, -1.0, start2 - level)
    if settings.cutoff > 0.0 and contact == SLIDING:
        level = settings.cutoff * settings.cutoff
        expand_speed(work, h, level)
        return mark_parts(system, work, SPEED_EVENT, 1.0, work.squared_start_speed - level)
    if settings.cutoff > 0.0 and contact == STOPPING:
        level = log(settings.cutoff)
        expand_level(work, row(work.levels, ()), level)
        return mark_parts(system, work, LEVEL_EVENT, 1.0, work.log_speed + work.log_ratio - level)
    early = max(since - work.time, 0.0) if contact == REST else 0.0
    work.edges[0], work.edges[1] = early / h, 1.0
    return 1 if early < h else 0


@compiled
def prepare_next_step(
    system: System, work: Workspace, contact: int, following: int, settings: RunSettings, h: float, factor: float
) -> int:
    """Set the length of the next step after one of length h that was accepted; return the next contact state.

    `following` is the state that the events of the step lead to; factor: of `length_factor`.
    """
    if contact == STOPPING:
        after = commit_stopping_step(system, work, settings, h, factor)
        return following if following == CREEPING else after
    if contact != SLIDING:
        work.hold_time = 0.0
    if following != contact:
        return following
    if contact == SLIDING:
        adapt_sliding_length(work, h, factor)
    else:
        adapt_length(work, h, factor)
    return contact
