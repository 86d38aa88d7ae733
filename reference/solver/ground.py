"""Ground acceleration for compiled code: two harmonics (5.3) or a record, as in reference.problem.excitation."""

from __future__ import annotations

from math import cos, exp, sin

from reference.solver.collocation import STAGES
from reference.solver.compiled import compiled
from reference.solver.rows import broadcast_like, put, row
from reference.solver.system import Array, Ground, System
from reference.solver.work import SERIES_TERMS, Workspace

MAX_SERIES_ANGLE = 2.0  # largest phase change, rad, and decay of a harmonic in a step for which a Taylor series is used
SERIES_ROUNDING = 1e-17  # share of a harmonic: its Taylor series ends at the first term that is not larger


@compiled
def next_knot(record: Array, t: float) -> int:
    """Return the index of the first row of a table whose time, in column 0, is later than t, or the number of rows."""
    low, high = 0, record.shape[0]
    while low < high:
        middle = (low + high) // 2
        if record[middle, 0] > t:
            high = middle
        else:
            low = middle + 1
    return low


@compiled
def friction_temperature_factor_at(system: System, t: float) -> float:
    """Return k_T, the temperature factor of friction, at time t, s, from the piecewise polynomial in system.k_t."""
    table = system.k_t
    if table.shape[0] == 0:
        return 1.0
    piece = max(next_knot(table, t) - 1, 0)
    theta, value = min((t - table[piece, 0]) / table[piece, 1], 1.0), 0.0
    for power in range(STAGES, -1, -1):
        value = value * theta + table[piece, 2 + power]
    return value


@compiled
def record_acceleration_at(system: System, t: float) -> Ground:
    """Return the ground acceleration of a recorded motion at time t, with the temperature factor of friction.

    The record is linear between its samples, and zero after the last one.
    """
    record, k_t = system.record, friction_temperature_factor_at(system, t)
    k = next_knot(record, t)
    if k == 0:
        return Ground(x=record[0, 1], y=record[0, 2], z=record[0, 3], k_t=k_t)
    if k == record.shape[0]:
        return Ground(x=0.0, y=0.0, z=0.0, k_t=k_t)
    a, b = record[k - 1], record[k]
    s = (t - a[0]) / (b[0] - a[0])
    return Ground(
        x=a[1] + s * (b[1] - a[1]), y=a[2] + s * (b[2] - a[2]), z=a[3] + s * (b[3] - a[3]), k_t=k_t
    )  # fmt: skip


@compiled
def ground_at(system: System, work: Workspace, t: float) -> Ground:
    """Return the ground acceleration, m/s^2, and k_T, the temperature factor of friction, at time t."""
    if system.record.shape[0] > 0:
        return record_acceleration_at(system, t)
    e0, e1 = system.exponents[0], system.exponents[1]
    z0 = exp(e0.real * t) * cos(e0.imag * t + work.phase[0])
    z1 = exp(e1.real * t) * cos(e1.imag * t + work.phase[1])
    a = system.amplitudes
    return Ground(
        x=a[0, 0] * z0 + a[0, 1] * z1,
        y=a[1, 0] * z0 + a[1, 1] * z1,
        z=a[2, 0] * z0 + a[2, 1] * z1,
        k_t=friction_temperature_factor_at(system, t),
    )


@compiled
def set_harmonics(system: System, work: Workspace, t: float) -> None:
    """Set work.waves to the ground's two harmonics at time t, s, as complex numbers of amplitude 1 at t = 0.

    `set_ground_at_stages` and `next_ground` start from them.
    """
    for m in range(2):
        e = system.exponents[m]
        angle, size = e.imag * t + work.phase[m], exp(e.real * t)
        work.waves[m] = complex(size * cos(angle), size * sin(angle))


@compiled
def set_harmonic_step_factors(system: System, work: Workspace, h: float) -> None:
    """Set work.turns: the complex factors by which both harmonics of the ground change in a time step h, s."""
    for m in range(2):
        e = system.exponents[m]
        angle, growth = e.imag * h, exp(e.real * h)
        work.turns[m] = complex(growth * cos(angle), growth * sin(angle))


@compiled
def next_ground(system: System, work: Workspace, t: float) -> Ground:
    """Return the ground acceleration and the temperature factor k_T at t, and move the harmonics on by one step.

    The first t is that of `set_harmonics`, and each further one is later by the step of `set_harmonic_step_factors`.
    """
    if system.record.shape[0] > 0:
        return record_acceleration_at(system, t)
    z0, z1, a = work.waves[0], work.waves[1], system.amplitudes
    work.waves[0], work.waves[1] = z0 * work.turns[0], z1 * work.turns[1]
    return Ground(
        x=a[0, 0] * z0.real + a[0, 1] * z1.real,
        y=a[1, 0] * z0.real + a[1, 1] * z1.real,
        z=a[2, 0] * z0.real + a[2, 1] * z1.real,
        k_t=friction_temperature_factor_at(system, t),
    )


@compiled
def set_ground_at_stages(system: System, work: Workspace) -> None:
    """Set ground acceleration and temperature factor k_T at a step's stages, after `set_harmonics` at its start."""
    # A Taylor series of the harmonics about the start of the step gives all stages at once, without the sines and
    # exponentials of every stage. Long steps and records take each stage by itself.
    elapsed = work.elapsed
    longest = elapsed[STAGES - 1]
    e0, e1 = system.exponents[0] * longest, system.exponents[1] * longest
    if system.record.shape[0] > 0 or squared_modulus(e0) + squared_modulus(e1) > MAX_SERIES_ANGLE * MAX_SERIES_ANGLE:
        for k in range(STAGES):
            here = ground_at(system, work, work.time + elapsed[k])
            work.ground[0, k], work.ground[1, k], work.ground[2, k] = here.x, here.y, here.z
            work.ground[3, k] = here.k_t
        return
    terms = expand_harmonics(work, e0, e1)
    series, a, ground = work.series, system.amplitudes, work.ground
    share = row(elapsed, ()) / longest if longest > 0.0 else broadcast_like(0.0, row(elapsed, ()))
    z0 = z1 = broadcast_like(0.0, share)
    for n in range(terms - 1, -1, -1):
        z0 = z0 * share + series[n, 0]
        z1 = z1 * share + series[n, 1]
    for axis in range(3):
        put(ground, axis, a[axis, 0] * z0 + a[axis, 1] * z1)
    if system.k_t.shape[0] > 0:
        for k in range(STAGES):
            ground[3, k] = friction_temperature_factor_at(system, work.time + elapsed[k])


@compiled
def expand_harmonics(work: Workspace, e0: complex, e1: complex) -> int:
    """Set work.series to the Taylor series of both harmonics in the elapsed share of a step; return its length.

    Over the whole step, the harmonics change by the factors exp(e0) and exp(e1).
    """
    series, z0, z1 = work.series, work.waves[0], work.waves[1]
    enough = SERIES_ROUNDING * SERIES_ROUNDING * min(squared_modulus(z0), squared_modulus(z1))
    for n in range(SERIES_TERMS):
        series[n, 0], series[n, 1] = z0.real, z1.real
        if max(squared_modulus(z0), squared_modulus(z1)) <= enough:
            return n
        z0, z1 = z0 * e0, z1 * e1
        share = 1.0 / (n + 1.0)
        z0, z1 = complex(z0.real * share, z0.imag * share), complex(z1.real * share, z1.imag * share)
    return SERIES_TERMS


@compiled
def squared_modulus(z: complex) -> float:
    """Return the squared modulus |z|^2 of a complex number."""
    return z.real * z.real + z.imag * z.imag
