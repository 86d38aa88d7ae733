"""Contact phase of stopping, in stretched time (near_stop.py): it ends in rest or creep, or sliding goes on."""

from __future__ import annotations

from math import exp, log, pi, sqrt

from reference.solver.chain import set_chain_acceleration
from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled
from reference.solver.contact.friction import SMALLEST_SPEED, kinetic_coefficient, slip_direction_cosines
from reference.solver.contact.platform import acceleration_along, load_in_state, rest_excess
from reference.solver.contact.stop_arc import MAX_ROUNDING_TURN, arc_peak, direction_at_stop
from reference.solver.events import locate_level_crossing
from reference.solver.ground import ground_at
from reference.solver.peaks import SETTLED_FRACTION, update_peak_by_limit
from reference.solver.phases.sliding import STOP_WITHIN_STEPS, STOP_WITHIN_TIME
from reference.solver.rows import row, row_minimum
from reference.solver.step_control import MIN_STEP, begin_with_acceleration, next_kink
from reference.solver.system import CREEPING, PLATFORM, REGULARIZED, REST, SLIDING, STOPPING, Load, RunSettings, System
from reference.solver.work import ACROSS, ALONG, CLOCK, DIRECTION, RATIO, SIGMA, Workspace

# "Period" below is RunSettings.period, the time in which forces change; "the loading's velocity" is the size of the
# loading's acceleration times the period over 2 pi.
FIRST_STEP = 1.0  # change of slip direction, rad, or of ln v, for which the length of the first step is estimated
# Smallest acceleration, as share of the loading's, by which the length of the first step is estimated
MIN_FIRST_ACCELERATION = 1e-3
MAX_GROWTH = 2.0  # largest ratio of a step to the length with which the last one would just have met the tolerance
MAX_CHAIN_ANGLE = 0.7  # rad, largest phase angle of the upper bodies' fastest vibration in one step
# A slide that speeds up again leaves stretched time (dt = v dtau) once v / v', a time, exceeds both bounds below.
LEAVING_TIME_FRACTION = 0.3  # a slide leaves stretched time only if v / v' is above this share of a plain step
MIN_LEAVING_TIME = 0.05  # a slide leaves stretched time only if v / v' is above this share of RunSettings.period
# Speed below which a platform that friction can hold may count as stopped: this number * square root of the relative
# tolerance of accelerations * (loading's acceleration * RunSettings.period / 2 pi)
MAX_STOPPED_SPEED = 0.03
# Largest jump of an acceleration, as share of the tolerance, that dampers may cause when a stop sets the speed to zero
MAX_DAMPED_JUMP = 0.01
# While a slide's direction turns before its stop (the arc of contact/stop_arc.py), an acceleration may become a peak.
# Then the slide is followed down to MIN_FOLLOWED_SPEED. No peak is possible below DECISIVE_ARC_FRACTION of the
# platform's peak so far, or below DECISIVE_RISE_FRACTION of the squared peak of a body above, on which the turn acts by
# its vertical acceleration alone.
MIN_FOLLOWED_SPEED = 1e-10  # slides below this share of (loading's acceleration * period / 2 pi) are not followed
DECISIVE_ARC_FRACTION = 0.97  # a slide is followed if the turn before its stop has more of the platform's peak
DECISIVE_RISE_FRACTION = 0.999  # a slide is followed if the turn has more of an upper body's squared peak
# No slide is followed for an upper body whose squared acceleration rises by less than this share of its squared peak
NEGLIGIBLE_RISE = 1e-9
LEVEL_TOLERANCE = 1e-9  # distance of ln v from ln v_reg, the limit of creep, at which a slide becomes creep
EARLY_CROSSING = 1e-9  # a slide that slows to v_reg within this share of a step creeps from the start of the step
# Forces count as constant until the stop if it is nearer than this number * RunSettings.period * square root of the
# relative tolerance of accelerations
MAX_FROZEN_TIME = 0.01
# A change of friction until rest counts as none if it is at most this share of friction's rise from rest to high speed
NEGLIGIBLE_FRICTION_RISE = 1e-12
# A slide leaves the phase of stopping, as its speed hardly changes, if the time to its stop is this many times the one
# (STOP_WITHIN_STEPS, STOP_WITHIN_TIME) below which a slide enters this phase
MIN_STEADY_TIMES = 2.0
MAX_STRAIGHT_TURN = 1e-6  # ratio of sideways acceleration to friction below which a slide counts as straight
# A straight slide that friction cannot hold reverses below this share of (loading's acceleration * period / 2 pi)
MAX_TURNING_POINT_SPEED = 1e-12
NEAR_STOP_NEWTON_FRACTION = 1e-3  # Newton's method ends if slip directions change by less, as share of the tolerance
# Bounds on the change of ln v in a step: time, position are integrals of v and v^2 over stretched time (dt = v dtau),
# whose error the accelerations do not show where forces stay constant. With both bounds below, this error is less than
# 1e-8 of the time and the distance to the stop at the start of the step.
MAX_FIRST_LOG_SPEED_CHANGE = 2.0  # bound on the change of ln v in the first step
LOG_SPEED_CHANGE_GROWTH = 0.7  # increase of this bound in later steps, per decrease of ln v since the first step


@compiled
def begin_stopping(system: System, work: Workspace, settings: RunSettings) -> None:
    """Prepare a phase of stopping in stretched time (dt = v dtau): set accelerations and the first step's length."""
    ground = ground_at(system, work, work.time)
    set_chain_acceleration(system, work, ground)
    load = load_in_state(system, work, ground)
    ex, ey = slip_direction_cosines(work.angle, system.axes)
    ax, ay, _, ratio = acceleration_along(system, load, exp(work.log_speed), ex, ey)
    begin_with_acceleration(system, work, ground, ax, ay, STOPPING)
    work.log_ratio, work.first_log_speed, work.fitting_length = log(ratio), work.log_speed, 0.0
    work.stretched_length = FIRST_STEP / max(sqrt(ax * ax + ay * ay), MIN_FIRST_ACCELERATION * settings.unit)


@compiled
def propose_stretched_length(system: System, work: Workspace) -> float:
    """Return the next step's length in stretched time (dt = v dtau), which resolves time, position and vibration."""
    ex, ey = slip_direction_cosines(work.angle, system.axes)
    along = work.a0[0, 0] * ex + work.a0[0, 1] * ey
    change = MAX_FIRST_LOG_SPEED_CHANGE + LOG_SPEED_CHANGE_GROWTH * max(0.0, work.first_log_speed - work.log_speed)
    if along > 0.0:  # the slide gathers speed, so that the bound must hold for the speed at the step's end
        change /= 1.0 + LOG_SPEED_CHANGE_GROWTH
    h = min(work.stretched_length, change / max(abs(along), 1e-300))
    return min(h, MAX_CHAIN_ANGLE / (system.fastest * exp(work.log_speed))) if system.fastest > 0.0 else h


@compiled
def limit_step_to_kink_or_creep(system: System, work: Workspace, settings: RunSettings, h: float) -> tuple[float, int]:
    """Return the length of a step h up to its first event, and the next contact state; lengths are in stretched time.

    An event is a kink of the loading or the temperature factor, or the speed v_reg, at which creep begins under the
    regularized law. The length is 0 if creep begins at the start of the step.
    """
    limit = next_kink(system, work, settings)
    if work.turning[CLOCK, STAGES - 1] > limit + MIN_STEP * settings.period:
        portion = locate_level_crossing(system, work, row(work.turning, CLOCK), work.time, limit)
        if portion < 1.0 - EARLY_CROSSING:
            return h * portion, STOPPING
    if system.law != REGULARIZED:
        return h, STOPPING
    level = log(system.v_reg)
    if row_minimum(row(work.levels, ())) < level - LEVEL_TOLERANCE:
        start = max(work.log_speed + work.log_ratio, level)
        portion = locate_level_crossing(system, work, row(work.levels, ()), start, level - 0.5 * LEVEL_TOLERANCE)
        if portion < EARLY_CROSSING:
            return 0.0, CREEPING
        if portion < 1.0 - EARLY_CROSSING:
            return h * portion, STOPPING
    return h, CREEPING if work.levels[STAGES - 1] <= level + LEVEL_TOLERANCE else STOPPING


@compiled
def commit_stopping_step(system: System, work: Workspace, settings: RunSettings, h: float, factor: float) -> int:
    """Make time, slip direction and speed at the end of a step near a stop the new ones; return the next contact state.

    The length h, in stretched time, times `factor` would just have met the tolerance.
    """
    # In stretched time a slide never reaches its stop: ln v falls without end. Three things end the phase. The platform
    # counts as stopped (`contact_after_stop`). Or it gathers speed again behind its slowest point: then plain time
    # resolves the slide once v / v' is a good part of a plain step. Or friction that rises with the speed balances the
    # drive, so that the slide goes on at almost constant speed.
    last = STAGES - 1
    work.time, work.angle = work.turning[CLOCK, last], work.turning[DIRECTION, last]
    work.log_speed, work.log_ratio = work.turning[SIGMA, last], log(work.turning[RATIO, last])
    # The motion becomes smoother towards the stop, so the length that would meet the tolerance goes on growing.
    growth = h * factor / work.fitting_length if work.fitting_length > 0.0 else 1.0
    work.fitting_length = h * factor
    work.stretched_length = work.fitting_length * min(max(growth, 1.0), MAX_GROWTH)
    if work.time >= work.end - 10.0 * MIN_STEP * settings.period:
        return STOPPING
    if system.law != REGULARIZED:
        contact = contact_after_stop(system, work, settings)
        if contact != STOPPING:
            work.v[0, 0] = work.v[0, 1] = 0.0
            return contact
    along, speed = work.turning[ALONG, last], exp(work.log_speed)
    if along > 0.0 and speed > max(LEAVING_TIME_FRACTION * work.length, MIN_LEAVING_TIME * settings.period) * along:
        work.length = min(work.length, speed / along)
        return SLIDING
    # Friction that rises with the speed may balance the drive: such a slide goes on and does not stop.
    soon = MIN_STEADY_TIMES * max(STOP_WITHIN_STEPS * work.length, STOP_WITHIN_TIME * settings.period)
    return SLIDING if system.rate > 0.0 and along <= 0.0 and speed > soon * -along else STOPPING


@compiled
def update_peaks_by_arc(system: System, work: Workspace, load: Load, can_integrate_closer: bool) -> bool:
    """
    Raise the peaks to the largest accelerations that occur while the slip direction still turns before the stop.

    Return False if these may be new peaks and the slide can still be integrated closer to its stop.
    """
    # The direction still turns while the speed goes to zero, so every direction between the present one and the one in
    # which it settles belongs to the motion (contact/stop_arc.py; docs/theory.md, supremum). The arc is computed with
    # the forces of this instant. Where a peak on the arc governs, the slide is first integrated down to
    # MIN_FOLLOWED_SPEED, so that the forces hardly change in the time left. The bodies above have the vertical
    # acceleration of the platform; their horizontal accelerations stay those before the stop.
    bodies, total, best = work.x.shape[0], work.total0, work.best
    end = direction_at_stop(system, load, work.angle, MAX_ROUNDING_TURN)
    arc = arc_peak(system, load, work.angle, end, SETTLED_FRACTION**2 * best[0], 1.0)
    if can_integrate_closer and arc > DECISIVE_ARC_FRACTION * DECISIVE_ARC_FRACTION * best[0]:
        return False
    update_peak_by_limit(work, PLATFORM, arc)
    if bodies == 1 or system.small:
        return True
    vertical = arc_peak(system, load, work.angle, end, 0.0, 0.0)
    for i in range(1, bodies):
        squared = total[i, 0] ** 2 + total[i, 1] ** 2
        rises = vertical - total[i, 2] ** 2 > NEGLIGIBLE_RISE * best[i]
        if can_integrate_closer and rises and squared + vertical > DECISIVE_RISE_FRACTION * best[i]:
            return False
        update_peak_by_limit(work, i, squared + vertical)
    return True


@compiled
def contact_after_stop(system: System, work: Workspace, settings: RunSettings) -> int:
    """Return REST or SLIDING if the platform has stopped, else STOPPING.

    If it rests, work.early_rest becomes the time, s, that it would still have slid.
    """
    # A platform that friction can hold (excess <= 0) has stopped when the remaining slide changes nothing: its speed
    # and the time left are small (both bounds go with the root of the tolerance, since the distance to the stop is
    # quadratic in speed and time), the dampers feel no jump, friction is that of rest, and the peaks in the turn before
    # the stop are known. If only speeds above a cutoff v_c count, this turn does not; the slide is integrated to below
    # v_c. A platform that friction cannot hold turns back if it goes straight against the driving force. Otherwise its
    # direction turns past the stop, and the slide goes on.
    unit = settings.unit * settings.period / (2.0 * pi)
    speed = exp(work.log_speed)
    if speed > MAX_STOPPED_SPEED * sqrt(settings.tolerance) * unit:
        return STOPPING
    if speed * system.damping_rate > MAX_DAMPED_JUMP * settings.tolerance * settings.unit:
        return STOPPING
    along, across = work.turning[ALONG, STAGES - 1], work.turning[ACROSS, STAGES - 1]
    load = load_in_state(system, work, ground_at(system, work, work.time))
    excess, reaction = rest_excess(system, load)
    if excess > 0.0:
        straight = abs(across) <= MAX_STRAIGHT_TURN * kinetic_coefficient(system) * reaction
        if system.rate > 0.0:
            # Where friction grows with the speed, a negative acceleration along the slide at speed 0 means a reversal.
            # A slide along the drive slows down by friction and does not reverse.
            ex, ey = slip_direction_cosines(work.angle, system.axes)
            ax, ay, _, _ = acceleration_along(system, load, 0.0, ex, ey)
            along = ax * ex + ay * ey
        return SLIDING if straight and along < 0.0 and speed < MAX_TURNING_POINT_SPEED * unit else STOPPING
    changing = system.rate * speed > NEGLIGIBLE_FRICTION_RISE
    if along >= 0.0 or speed > MAX_FROZEN_TIME * sqrt(settings.tolerance) * settings.period * -along or changing:
        return STOPPING if speed > SMALLEST_SPEED else REST
    if settings.cutoff == 0.0:
        if not update_peaks_by_arc(system, work, load, speed > MIN_FOLLOWED_SPEED * unit):
            return STOPPING
    elif speed > settings.cutoff:
        return STOPPING
    work.early_rest = -speed / along
    return REST
