"""Running maxima of |absolute acceleration|^2 (5.1), read from the polynomials of each step."""

from __future__ import annotations

from math import sqrt

from reference.solver.collocation import DENSE, DENSE_VALUES, MONOMIALS, NODES, STAGES
from reference.solver.compiled import compiled
from reference.solver.system import REACH, Array, Work

# A step resolved to the tolerance turns by a small part of a wave between two stages: a peak between them stands less
# than this share above the higher one.
MAX_RISE_BETWEEN_STAGES = 0.2
PARTS_PER_STEP = 8  # parts of a step at whose ends the platform's displacement is read
MAX_WAY_FACTOR = 1.5  # bound on the way within a step, times the larger speed at its ends and its length


@compiled
def polynomial_squares(coefficients: Array, theta: float) -> tuple[float, float, float]:
    """|total|^2 at theta and its first two derivatives, from coefficients (>= 3, S) of the powers of theta."""
    value = slope = curvature = 0.0
    for axis in range(3):
        p = dp = ddp = 0.0
        for k in range(STAGES - 1, -1, -1):
            ddp = ddp * theta + 2.0 * dp
            dp = dp * theta + p
            p = p * theta + coefficients[axis, k]
        value += p * p
        slope += 2.0 * p * dp
        curvature += 2.0 * (dp * dp + p * ddp)
    return value, slope, curvature


@compiled
def interpolation_error(theta: float) -> float:
    """Error at theta of the polynomial through the stages, over that at the start of the step."""
    ratio = 1.0
    for k in range(STAGES):
        ratio *= 1.0 - theta / NODES[k]
    return abs(ratio)


@compiled
def take_peaks(work: Work, low: float, high: float) -> None:
    """Raises work.best (N,) by the largest |total|^2 over the part [low, high] of the step just made."""
    coefficients = work.powers
    for i in range(work.x.shape[0]):
        highest = 0.0
        for k in range(STAGES):
            squared = 0.0
            for axis in range(3):
                squared += work.total[i, axis, k] ** 2
            highest = max(highest, squared)
        if highest < (1.0 - MAX_RISE_BETWEEN_STAGES) * work.best[i]:
            continue
        top, place = -1.0, low
        for n in range(DENSE.shape[0]):
            theta = min(max(DENSE[n], low), high)
            squared = 0.0
            if theta == DENSE[n]:
                for axis in range(3):
                    p = 0.0
                    for k in range(STAGES):
                        p += DENSE_VALUES[n, k] * work.total[i, axis, k]
                    squared += p * p
                if squared > top:
                    top, place = squared, theta
        for axis in range(3):
            for k in range(STAGES):
                p = 0.0
                for m in range(STAGES):
                    p += MONOMIALS[k, m] * work.total[i, axis, m]
                coefficients[axis, k] = p
        for theta in (low, high):
            squared, _, _ = polynomial_squares(coefficients, theta)
            if squared > top:
                top, place = squared, theta
        spacing = DENSE[1]
        theta = place
        for _ in range(6):
            squared, slope, curvature = polynomial_squares(coefficients, theta)
            top = max(top, squared)
            if not curvature < 0.0:
                break
            theta = min(max(theta - slope / curvature, max(low, place - spacing)), min(high, place + spacing))
        squared, _, _ = polynomial_squares(coefficients, theta)
        top = max(top, squared)
        if top > work.best[i]:
            work.best[i] = top
            work.reading_error[i] = interpolation_error(theta) * work.defect[i]


@compiled
def take_reach(work: Work, h: float, stretched: bool) -> None:
    """
    Raises work.run[REACH] by the largest |x|^2 of the platform in the step just made.

    From the polynomial of its acceleration through the stages; in stretched time near a stop, where h is no length of
    time, at the stages: the way left there is short.
    """
    far = work.run[REACH]
    speed2 = 0.0
    for axis in range(2):
        speed2 = max(speed2, work.v[0, axis] ** 2, work.v1[0, axis] ** 2)
    start = work.x[0, 0] ** 2 + work.x[0, 1] ** 2
    end = work.x1[0, 0] ** 2 + work.x1[0, 1] ** 2
    far = max(far, start, end)
    if stretched:
        for k in range(STAGES):
            far = max(far, work.chain[0, 0, k] ** 2 + work.chain[0, 1, k] ** 2)
    elif sqrt(max(start, end)) + MAX_WAY_FACTOR * h * sqrt(speed2) > sqrt(far):
        far = max(far, largest_square(work, h))
    work.run[REACH] = far


@compiled
def largest_square(work: Work, h: float) -> float:
    """Largest |x|^2 of the platform over the step: at equal parts of it, and by Newton's method from the largest."""
    coefficients = work.powers
    for axis in range(2):
        for m in range(STAGES):
            c = 0.0
            for k in range(STAGES):
                c += MONOMIALS[m, k] * work.a[0, axis, k]
            coefficients[axis, m] = h * h * c / ((m + 1.0) * (m + 2.0))
    best, place = -1.0, 0.0
    for n in range(PARTS_PER_STEP + 1):
        value, _, _ = place_squares(work, h, n / PARTS_PER_STEP)
        if value > best:
            best, place = value, n / PARTS_PER_STEP
    for _ in range(4):
        _, slope, curvature = place_squares(work, h, place)
        if not curvature < 0.0:
            break
        place = min(max(place - slope / curvature, 0.0), 1.0)
        value, _, _ = place_squares(work, h, place)
        best = max(best, value)
    return best


@compiled
def place_squares(work: Work, h: float, theta: float) -> tuple[float, float, float]:
    """|x|^2 of the platform at theta and half of its first two derivatives."""
    value = slope = curvature = 0.0
    for axis in range(2):
        p = dp = ddp = 0.0
        for m in range(STAGES - 1, -1, -1):
            c = work.powers[axis, m]
            p = (p + c) * theta
            dp = dp * theta + (m + 2.0) * c
            ddp = ddp * theta + (m + 2.0) * (m + 1.0) * c
        p = work.x[0, axis] + theta * (h * work.v[0, axis] + p)
        dp = h * work.v[0, axis] + theta * dp
        value += p * p
        slope += p * dp
        curvature += dp * dp + p * ddp
    return value, slope, curvature
