"""
The temperature factor k_T of friction as a function of time, from the heat that the steps of a run produce.

The temperature is T0 + rise * integral of P(t - s) / sqrt(s), the conduction into a half-space (Carslaw and Jaeger,
Conduction of Heat in Solids), with P the power of friction while the slider covers the surface's center. Time is cut
into pieces at the run's steps and at the instants at which covering begins or ends. On a piece P is a polynomial and
the kernel is integrated exactly. P itself has the factor k_T: both are found together, piece by piece.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numba import njit

from reference.problem.friction import Heat
from reference.solver.collocation import DEFECT_POLYNOMIAL, MONOMIALS, NODES, STAGES, A
from reference.solver.compiled import NUMBA_OPTIONS
from reference.solver.samples import SampledMotion, sample_motion
from reference.solver.system import REST, Array, StepRecord, System, dry_friction_of
from reference.support.build_cache import cache_on_disk

# Number of Newton iterations that find when the slider begins or stops covering the center of the concave surface
NEWTON_STEPS = 8
# After a kink of the friction power k_T changes like a root of time, so the step behind it is cut at these shares of it
GRADED_FRACTIONS = np.append(0.25 ** np.arange(8), 0.0)
MIN_PIECE = 1e-10  # share of the motion's duration: a cut of time (heat integral) closer to the last is left out
# Time is cut into pieces; a block is several neighboring pieces (`past_temperature`). The moments of a block's heat are
# its total, its mean time and the variance of its time.
FAR_DISTANCE = 4.0  # time since a piece of heating began, over its length: beyond it, quadrature gives its effect
BLOCK_DISTANCE = 30.0  # time since a block of heating began, over its length: beyond it the moments of its heat suffice
MAX_LAST_CHANGE = 1e-14  # change of the temperature factor k_T below which its iteration in a piece of time ends
MAX_ITERATIONS = 50  # most iterations for friction's temperature factor k_T in a piece of time; then the last is kept
NODE_WEIGHTS = A[-1].copy()  # quadrature weights of the collocation nodes in a piece of time of length 1


def set_initial_friction_factor(system: System) -> System:
    """Return the system with k_T, the temperature factor of friction, constant: that of the initial temperature."""
    k_t = np.zeros((1, 3 + STAGES))
    k_t[0, 1:3] = system.duration, Heat.factor(system.heat[0])
    return system._replace(k_t=k_t)


def set_factor_by_heat(system: System, record: StepRecord, end: float) -> System:
    """Return the system with k_T(t), the temperature factor of friction, computed from a run's heat up to `end`, s."""
    # The power of friction has a kink where a slide begins or ends, and a jump where the slider leaves or covers the
    # center of the concave surface: there k_T changes like a root of time. So pieces are graded behind these instants,
    # and those of the jump are located by Newton's method. Integration errors make k_T jump between pieces, and a jump
    # inside a step of the next run would reduce its order of accuracy. So each piece gets a multiple of
    # DEFECT_POLYNOMIAL, which is 0 at the nodes and 1 at the start: the table is continuous.
    start = record.start[: record.counts[0]]
    bounds = np.append(start, end)
    times = _nodes_of_pieces(bounds)
    changes = np.flatnonzero(np.diff(_squared_excess_of_cover(system, sample_motion(record, times)) > 0.0))
    instants = 0.5 * (times[changes] + times[changes + 1])
    for _ in range(NEWTON_STEPS if len(changes) else 0):
        motion = sample_motion(record, instants)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = _squared_excess_of_cover(system, motion) / (2.0 * (motion.x[:, 0] * motion.v[:, 0]).sum(axis=1))
        step[np.isnan(step)] = 0.0
        instants = np.clip(instants - step, times[changes], times[changes + 1])
    starts = np.flatnonzero(np.diff(record.contact[: len(start)] == REST, prepend=True))
    behind = np.append(np.diff(times)[changes], np.diff(bounds)[starts])
    graded = np.append(instants, start[starts])[:, None] + behind[:, None] * GRADED_FRACTIONS
    bounds = np.unique(np.concatenate([bounds, graded.ravel()]))
    bounds = bounds[bounds <= end]
    bounds = bounds[np.append(True, np.diff(bounds) > MIN_PIECE * system.duration)]
    motion = sample_motion(record, _nodes_of_pieces(bounds))
    covered = _squared_excess_of_cover(system, motion).reshape(-1, STAGES)[:, STAGES // 2] < 0.0
    power = _cold_friction_power(system, motion).reshape(-1, STAGES) * covered[:, None]
    length, k_t = np.diff(bounds), np.zeros((len(bounds) - 1, STAGES))
    fill_temperature_factors(bounds[:-1], length, power * system.heat[1], system.heat[0], k_t)
    powers = k_t @ MONOMIALS.T
    jump = np.append(Heat.factor(system.heat[0]), k_t[:-1, -1]) - powers[:, 0]
    powers = np.column_stack([powers, np.zeros(len(powers))]) + jump[:, None] * DEFECT_POLYNOMIAL[::-1]
    table = np.column_stack([bounds[:-1], length, powers])
    return system._replace(k_t=table, kinks=np.sort(instants)[:, None])


def mean_factor(system: System) -> float:
    """Return the mean of the temperature factor of friction, k_T, over time."""
    lengths, coefficients = system.k_t[:, 1], system.k_t[:, 2:]
    return float(lengths @ coefficients @ (1.0 / np.arange(1, STAGES + 2)) / lengths.sum())


def _nodes_of_pieces(bounds: Array) -> Array:
    """Return the times, s, of the S collocation nodes in each of the K pieces between `bounds` (K + 1,): (K S,)."""
    return (bounds[:-1, None] + np.diff(bounds)[:, None] * NODES).ravel()


def _squared_excess_of_cover(system: System, motion: SampledMotion) -> Array:
    """Return the platform's squared displacement minus the squared one that uncovers the center, (T,), m^2.

    It is negative while the slider covers the center of the concave surface, which then heats up.
    """
    outside: Array = (motion.x[:, 0] ** 2).sum(axis=1) - system.heat[2] ** 2
    return outside


def _cold_friction_power(system: System, motion: SampledMotion) -> Array:
    """Return the power of friction over m1, (T,), m^2/s^3, at k_T = 1 (without the effect of temperature)."""
    x, v = motion.x[:, 0], motion.v[:, 0]
    squared_speed = (v**2).sum(axis=1)
    if not system.small:
        squared_speed += (x * v).sum(axis=1) ** 2 / (system.radius**2 - (x**2).sum(axis=1))
    speed, weight = np.sqrt(squared_speed), system.mass_ratio * system.gravity
    power = dry_friction_of(system).at(speed, motion.reaction / weight) * motion.reaction * speed
    return power * np.minimum(speed / system.v_reg, 1.0) if system.v_reg > 0.0 else power


@njit(**NUMBA_OPTIONS)
def conduction_integral(theta: float, coefficients: Array) -> float:
    """Return the integral of q(u) / sqrt(theta - u), u from 0 to 1 or theta: the effect at theta of a piece's heat q.

    `coefficients` are those of the polynomial q, lowest power first; theta counts from the start of the piece.
    """
    # Moment k is the integral of u^k / sqrt(theta - u); each follows from the one before by partial integration.
    beyond = np.sqrt(max(theta - 1.0, 0.0))
    moment = 2.0 * (np.sqrt(theta) - beyond)
    total = moment * coefficients[0]
    for k in range(1, STAGES):
        moment = 2.0 * (k * theta * moment - beyond) / (2.0 * k + 1.0)
        total += moment * coefficients[k]
    return total


@njit(**NUMBA_OPTIONS)
def far_conduction_integral(theta: float, power: Array) -> float:
    """Return `conduction_integral` by quadrature, for a time theta long after the piece; power: q at its nodes."""
    total = 0.0
    for k in range(STAGES):
        total += NODE_WEIGHTS[k] * power[k] / np.sqrt(theta - NODES[k])
    return total


@njit(**NUMBA_OPTIONS)
def past_temperature(
    time: float,
    piece: int,
    initial: float,
    start: Array,
    length: Array,
    heat: Array,
    coefficients: Array,
    moments: Array,
) -> float:
    """Return the temperature, degrees C, at `time`, s, in piece number `piece`, without the heat of this piece itself.

    Of the K pieces, start and length (K,) are in s, `heat` (K, S) is at their nodes, `coefficients` (K, S) are those of
    its polynomials, and `moments` (levels, K, 3) those of `describe_block`, row l for blocks of 2^l pieces.
    """
    # The temperature is a sum over all pieces before. For pieces long past, only sum, mean time and variance of the
    # heat of a block of pieces count: with d the distance in time, 1 / sqrt(d - x) = (1 + x / 2 d + 3 x^2 / 8 d^2 ...)
    # / sqrt(d), whose linear term vanishes about the mean. Row l of the moments holds blocks of 2^l pieces; walking
    # back in time the blocks grow with the distance, which leaves of the order of log K terms. Near pieces are
    # integrated exactly, those at a middle distance by quadrature.
    past, j = initial, piece
    while j > 0:
        level, size, first = 0, 1, j - 1
        while j % (2 * size) == 0 and time - start[j - 2 * size] > BLOCK_DISTANCE * (start[j] - start[j - 2 * size]):
            level, size, first = level + 1, 2 * size, j - 2 * size
        theta = (time - start[first]) / length[first]
        moment = moments[level, first // size]
        if moment[0] == 0.0:
            pass
        elif level > 0 or theta > BLOCK_DISTANCE:
            distance = time - moment[1]
            past += moment[0] * (1.0 + 0.375 * moment[2] / (distance * distance)) / np.sqrt(distance)
        elif theta > FAR_DISTANCE:
            past += np.sqrt(length[first]) * far_conduction_integral(theta, heat[first])
        else:
            past += np.sqrt(length[first]) * conduction_integral(theta, coefficients[first])
        j = first
    return past


@njit(**NUMBA_OPTIONS)
def solve_piece(past: Array, length: float, power: Array, heat: Array, coefficients: Array, k_t: Array) -> None:
    """Find by iteration, for one piece of time, its heat and its temperature factor k_t, each of which needs the other.

    past (S,): temperature at the nodes by earlier heat; power (S,): heat at k_T = 1.
    """
    for _ in range(MAX_ITERATIONS):
        change = 0.0
        for k in range(STAGES):
            heat[k] = power[k] * k_t[k]
        for k in range(STAGES):
            coefficients[k] = 0.0
            for m in range(STAGES):
                coefficients[k] += MONOMIALS[k, m] * heat[m]
        for m in range(STAGES):
            now = temperature_factor(past[m] + np.sqrt(length) * conduction_integral(NODES[m], coefficients))
            change, k_t[m] = max(change, abs(now - k_t[m])), now
        if change < MAX_LAST_CHANGE:
            break


@cache_on_disk(Path(__file__).parent, error_model="numpy", nogil=True)
def fill_temperature_factors(start: Array, length: Array, power: Array, initial: float, k_t: Array) -> None:
    """Set the temperature factor k_t (K, S) at the S nodes of K pieces of time, which have `start` and `length`, s.

    power (K, S) is Heat.rise times the power of friction at k_T = 1; initial is the temperature at first, degrees C.
    """
    # Piece by piece; each completed pair of blocks is joined to one of twice the length, as in a binary counter.
    count = start.shape[0]
    past, heat, coefficients = np.zeros(STAGES), power.copy(), np.zeros_like(power)
    moments = np.zeros((int(np.log2(count)) + 1, count, 3))
    for i in range(count):
        for m in range(STAGES):
            time = start[i] + NODES[m] * length[i]
            past[m] = past_temperature(time, i, initial, start, length, heat, coefficients, moments)
            k_t[i, m] = temperature_factor(past[m])
        solve_piece(past, length[i], power[i], heat[i], coefficients[i], k_t[i])
        if power[i, 0] > 0.0:
            describe_block(start[i], length[i], heat[i], moments[0, i])
        level, done = 0, i + 1
        while done % 2 == 0:
            done //= 2
            join_blocks(moments[level, 2 * done - 2], moments[level, 2 * done - 1], moments[level + 1, done - 1])
            level += 1


@njit(**NUMBA_OPTIONS)
def describe_block(start: float, length: float, heat: Array, moments: Array) -> None:
    """Set `moments` (3,) of a piece of time to its total heat, and the mean and variance of the time of this heat."""
    total, center, variance = 0.0, 0.0, 0.0  # loops: whole arrays would take three times as long to compile
    for k in range(STAGES):
        total += NODE_WEIGHTS[k] * heat[k]
    for k in range(STAGES):
        center += NODE_WEIGHTS[k] * heat[k] / total * NODES[k]
    for k in range(STAGES):
        variance += NODE_WEIGHTS[k] * heat[k] / total * (NODES[k] - center) ** 2
    moments[0], moments[1], moments[2] = total * length, start + center * length, variance * length**2


@njit(**NUMBA_OPTIONS)
def join_blocks(a: Array, b: Array, both: Array) -> None:
    """Set `both` to the moments (total heat, its mean time, variance of its time) of the blocks a and b together."""
    heat = a[0] + b[0]
    if heat > 0.0:
        center = (a[0] * a[1] + b[0] * b[1]) / heat
        both[0], both[1] = heat, center
        both[2] = (a[0] * (a[2] + (a[1] - center) ** 2) + b[0] * (b[2] + (b[1] - center) ** 2)) / heat


@njit(**NUMBA_OPTIONS)
def temperature_factor(temperature: float) -> float:
    """Return k_T, the temperature factor of friction, at a temperature in degrees C, as `Heat.factor` does."""
    return 0.79 * (0.7 ** (0.02 * temperature) + 0.4)
