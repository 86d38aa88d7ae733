"""Running maxima of |absolute acceleration|^2 (5.1), read from the polynomials of each step."""

from __future__ import annotations

from reference.solver.collocation import DENSE, DENSE_VALUES, MONOMIALS, NODES, STAGES
from reference.solver.compiled import compiled
from reference.solver.system import Array, Work

# A step resolved to the tolerance turns by a small part of a wave between two stages: a peak between them stands less
# than this share above the higher one.
MARGIN = 0.2


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
        if highest < (1.0 - MARGIN) * work.best[i]:
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
            work.doubt[i] = interpolation_error(theta) * work.defect[i]
