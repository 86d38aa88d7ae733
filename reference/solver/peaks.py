"""Largest squared absolute acceleration of every body (5.1), and displacement of the platform, updated in each step."""

from __future__ import annotations

from math import sqrt

import numpy as np

from reference.solver.collocation import (
    DEFECT_INTEGRAL,
    DEFECT_POLYNOMIAL,
    ROW_LENGTH,
    SEARCH_POINTS,
    STAGES,
    VELOCITY_AT_START,
)
from reference.solver.compiled import compiled
from reference.solver.contact.friction import decay_rate, turning_rate
from reference.solver.polynomial import POWERS, set_coefficients
from reference.solver.rows import broadcast_like, put, row, row_maximum, row_minimum
from reference.solver.system import PLATFORM, REST, SLIDING, STOPPING, YIELDING, System
from reference.solver.work import SQUARED_SPEED, Workspace

# A peak of the squared acceleration between two stages exceeds the larger value at them by less than this share, since
# steps that meet their tolerance resolve every vibration well.
MAX_RISE_BETWEEN_STAGES = 0.2
MAX_PATH_FACTOR = 1.5  # a step's path is at most this factor times its duration times the larger end speed
NEWTON_ITERATIONS = 6  # number of Newton iterations from the best of SEARCH_POINTS to a maximum
IN_THE_PLANE, IN_SPACE = np.int64(2), np.int64(3)  # number of components x, y or x, y, z; NumPy integers: see system.py
# SEARCH_POINTS as an array of rows of ROW_LENGTH numbers; the first points fill up the last row
SEARCH_ROWS = np.resize(SEARCH_POINTS, (-(-len(SEARCH_POINTS) // ROW_LENGTH), ROW_LENGTH))
MAX_RATE = 60.0  # cap on friction's rate of response to speed, 1/s, times step, s, in a peak's interpolation error
SETTLED_FRACTION = 0.9  # above this share of the largest so far, an acceleration or displacement puts off an early end


@compiled
def sum_of_squares(work: Workspace, components: int, theta: float) -> tuple[float, float, float]:
    """Return the sum of squares of polynomials at share theta of a step, and its first two derivatives by theta.

    The polynomials are the first `components` rows of work.powers: those of a vector along x, y and perhaps z.
    """
    value = slope = curvature = 0.0
    for n in range(components):
        p = dp = ddp = 0.0
        for k in range(POWERS - 1, -1, -1):
            ddp = ddp * theta + 2.0 * dp
            dp = dp * theta + p
            p = p * theta + work.powers[n, k]
        value += p * p
        slope += 2.0 * p * dp
        curvature += 2.0 * (dp * dp + p * ddp)
    return value, slope, curvature


@compiled
def largest_square(work: Workspace, components: int, low: float, high: float) -> tuple[float, float]:
    """Return the largest value of `sum_of_squares` for theta between low and high, and the theta at which it occurs."""
    # SEARCH_POINTS are twice as many as the stages, so the best point is next to the largest maximum of a step that
    # meets its tolerance. Newton's method for a zero of the derivative goes on from there, and stays between its
    # neighbors. The best value seen counts, also where the iteration does not converge: it is a value of the
    # polynomial, and so never above the true maximum.
    for block in range(SEARCH_ROWS.shape[0]):
        thetas = min(max(row(SEARCH_ROWS, block), low), high)
        values = broadcast_like(0.0, thetas)
        for n in range(components):
            p = broadcast_like(0.0, thetas)
            for k in range(POWERS - 1, -1, -1):
                p = p * thetas + work.powers[n, k]
            values += p * p
        put(work.dense, block, values)
    best, place = -1.0, low
    for n in range(SEARCH_POINTS.shape[0]):
        value = work.dense[n // ROW_LENGTH, n % ROW_LENGTH]
        if value > best:
            best, place = value, min(max(SEARCH_POINTS[n], low), high)
    left, right = max(low, place - SEARCH_POINTS[1]), min(high, place + SEARCH_POINTS[1])
    theta = place
    for _ in range(NEWTON_ITERATIONS):
        value, slope, curvature = sum_of_squares(work, components, theta)
        if value > best:
            best, place = value, theta
        if not curvature < 0.0:
            break
        before, theta = theta, min(max(theta - slope / curvature, left), right)
        if theta == before:
            break
    return best, place


@compiled
def velocity_defect(work: Workspace, body: int, axis: int) -> float:
    """Return a body's velocity error per step length, m/s^2, when extrapolated from the stages to the step's start."""
    missed = 0.0
    for k in range(STAGES):
        missed += VELOCITY_AT_START[k] * work.a[body, axis, k]
    return missed


@compiled
def link_error_rate(system: System, work: Workspace, h: float, body: int) -> float:
    """Return the rate, m/s^3, at which velocity errors in a step change a body's acceleration through its springs."""
    squared, last = 0.0, work.x.shape[0] - 1
    for axis in range(2):
        own = velocity_defect(work, body, axis)
        rate = 0.0
        if body > 0:
            rate += system.below[body, axis] * (velocity_defect(work, body - 1, axis) - own)
        if body == PLATFORM and system.law == YIELDING:
            rate -= system.stiffness * own
        if body < last:
            rate += system.above[body, axis] * (velocity_defect(work, body + 1, axis) - own)
        squared += (h * rate) ** 2
    return sqrt(squared)


@compiled
def friction_error_rate(system: System, work: Workspace, contact: int) -> float:
    """Return the error of the platform's acceleration per error of its velocity, 1/s, that friction causes."""
    if contact == REST:
        return 0.0
    if contact != SLIDING:
        return decay_rate(system, contact)
    return turning_rate(system, sqrt(min(work.squared_start_speed, row_minimum(row(work.stage, SQUARED_SPEED)))))


@compiled
def interpolation_error(system: System, work: Workspace, contact: int, h: float, body: int, theta: float) -> float:
    """Return the estimated error, m/s^2, of a body's interpolated acceleration at share theta of the solved step."""
    # The error has three parts (docs/decisions/0002-two-run-error.md). (1) The polynomial through the stages misses the
    # acceleration between them: DEFECT_POLYNOMIAL, which is 1 at the start of the step and 0 at the stages, times the
    # defect. At the stages this part vanishes, but positions and velocities there are integrals of a polynomial with
    # an error. (2) The links turn the error of the positions into accelerations, (3) friction that of the velocity,
    # most of all where a slow slide turns. For one free vibration that turns by up to 4 rad in a step, the first two
    # parts together are the true error to a hundredth or two in the median.
    missed = integral = 0.0
    for k in range(STAGES + 1):
        missed = missed * theta + DEFECT_POLYNOMIAL[k]
        integral = integral * theta + DEFECT_INTEGRAL[k]
    error = abs(missed) * work.defect[body]
    if contact != STOPPING:  # steps near a stop are short, and their length h is no time in s
        rate = link_error_rate(system, work, h, body)
        if body == PLATFORM:
            rate += min(friction_error_rate(system, work, contact), MAX_RATE / h) * work.defect[body]
        error += abs(integral) * theta * h * rate
    return error


@compiled
def update_peaks(system: System, work: Workspace, contact: int, h: float, low: float, high: float) -> bool:
    """Raise work.best, the largest squared accelerations so far, to those between the shares low and high of a step.

    Return True if an acceleration reaches SETTLED_FRACTION of the largest of its body.
    """
    large = False
    for i in range(work.x.shape[0]):
        x, y, z = row(work.total, (i, 0)), row(work.total, (i, 1)), row(work.total, (i, 2))
        most = row_maximum(x * x + y * y + z * z)
        if most < (1.0 - MAX_RISE_BETWEEN_STAGES) * work.best[i]:
            continue
        for axis in range(3):
            set_coefficients(row(work.total, (i, axis)), work.powers[axis])
        top, place = largest_square(work, IN_SPACE, low, high)
        large = large or top >= SETTLED_FRACTION**2 * work.best[i]
        if top > work.best[i]:
            work.best[i] = top
            work.reading_error[i] = interpolation_error(system, work, contact, h, i, place) + work.drift[i]
    return large


@compiled
def update_peak_by_limit(work: Workspace, body: int, squared: float) -> None:
    """Raise a body's largest squared acceleration to `squared`, m^2/s^4, if that is larger.

    `squared` is a one-sided limit at a stop or an onset of sliding, which has no interpolation error.
    """
    if squared >= SETTLED_FRACTION**2 * work.best[body]:
        work.last_peak = work.last_large = work.time
    if squared > work.best[body]:
        work.best[body] = squared
        work.reading_error[body] = work.drift[body]


@compiled
def update_displacement(work: Workspace, h: float, stretched: bool) -> bool:
    """
    Raise work.squared_reach, m^2, to the largest squared displacement of the platform in the step just solved.

    It is read from the polynomial of the acceleration through the stages. In stretched time near a stop, where h is no
    length of time and the remaining distance is short, the stages are read. Return True if the displacement is near the
    largest so far.
    """
    squared_speed = 0.0
    for axis in range(2):
        squared_speed = max(squared_speed, max(work.v[0, axis] ** 2, work.v1[0, axis] ** 2))
    start = work.x[0, 0] ** 2 + work.x[0, 1] ** 2
    end = work.x1[0, 0] ** 2 + work.x1[0, 1] ** 2
    far = max(start, end)
    if stretched:
        x, y = row(work.positions, (0, 0)), row(work.positions, (0, 1))
        far = max(far, row_maximum(x * x + y * y))
    elif sqrt(max(start, end)) + MAX_PATH_FACTOR * h * sqrt(squared_speed) > sqrt(work.squared_reach):
        for axis in range(2):
            expand_position(work, h, axis)
        top, _ = largest_square(work, IN_THE_PLANE, 0.0, 1.0)
        far = max(far, top)
    work.squared_reach = max(work.squared_reach, far)
    return far >= SETTLED_FRACTION**2 * work.squared_reach


@compiled
def expand_position(work: Workspace, h: float, axis: int) -> None:
    """Set work.powers[axis] to coefficients of the platform's position, a polynomial over the step of length h, s."""
    powers = work.powers[axis]
    set_coefficients(row(work.a, (0, axis)), powers)
    for k in range(STAGES - 1, -1, -1):
        powers[k + 2] = h * h * powers[k] / ((k + 1.0) * (k + 2.0))
    powers[0] = work.x[0, axis]
    powers[1] = h * work.v[0, axis]
