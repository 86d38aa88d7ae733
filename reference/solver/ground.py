"""Ground acceleration inside compiled code, (5.3) or a record; both as reference.problem.excitation has them."""

from __future__ import annotations

from math import cos, exp, sin

from reference.solver.collocation import NODES, STAGES
from reference.solver.compiled import compiled
from reference.solver.system import Array, Ground, System
from reference.solver.work import Work


@compiled
def knot_after(record: Array, t: float) -> int:
    """The first knot later than t; their number behind the last."""
    low, high = 0, record.shape[0]
    while low < high:
        middle = (low + high) // 2
        if record[middle, 0] > t:
            high = middle
        else:
            low = middle + 1
    return low


@compiled
def recorded_at(record: Array, t: float) -> Ground:
    """The acceleration of a record, linear between its knots and zero behind them."""
    k = knot_after(record, t)
    if k == 0:
        return Ground(record[0, 1], record[0, 2], record[0, 3])
    if k == record.shape[0]:
        return Ground(0.0, 0.0, 0.0)
    a, b = record[k - 1], record[k]
    s = (t - a[0]) / (b[0] - a[0])
    return Ground(a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2]), a[3] + s * (b[3] - a[3]))


@compiled
def ground_at(system: System, work: Work, t: float) -> Ground:
    """(xi'', eta'', zeta'') at time t, m/s^2."""
    if system.record.shape[0] > 0:
        return recorded_at(system.record, t)
    e0, e1 = system.exponents[0], system.exponents[1]
    z0 = exp(e0.real * t) * cos(e0.imag * t + work.phase[0])
    z1 = exp(e1.real * t) * cos(e1.imag * t + work.phase[1])
    a = system.amplitudes
    return Ground(a[0, 0] * z0 + a[0, 1] * z1, a[1, 0] * z0 + a[1, 1] * z1, a[2, 0] * z0 + a[2, 1] * z1)


@compiled
def start_waves(system: System, work: Work, t: float, h: float) -> None:
    """Prepare `next_ground`: the harmonics at t, and by what they turn and decay within h."""
    for m in range(2):
        e = system.exponents[m]
        angle, size = e.imag * t + work.phase[m], exp(e.real * t)
        turn, growth = e.imag * h, exp(e.real * h)
        work.waves[m] = complex(size * cos(angle), size * sin(angle))
        work.turns[m] = complex(growth * cos(turn), growth * sin(turn))


@compiled
def next_ground(system: System, work: Work, t: float) -> Ground:
    """The ground at t, a step of `start_waves` after the last call."""
    if system.record.shape[0] > 0:
        return recorded_at(system.record, t)
    z0, z1, a = work.waves[0], work.waves[1], system.amplitudes
    work.waves[0], work.waves[1] = z0 * work.turns[0], z1 * work.turns[1]
    return Ground(
        a[0, 0] * z0.real + a[0, 1] * z1.real,
        a[1, 0] * z0.real + a[1, 1] * z1.real,
        a[2, 0] * z0.real + a[2, 1] * z1.real,
    )


@compiled
def ground_at_stages(system: System, work: Work, h: float) -> None:
    """Fill work.ground for a step of length h."""
    for k in range(STAGES):
        ground = ground_at(system, work, work.time + NODES[k] * h)
        work.ground[0, k], work.ground[1, k], work.ground[2, k] = ground.x, ground.y, ground.z
