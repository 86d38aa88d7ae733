"""Ground acceleration inside compiled code, (5.3) or a record; both as reference.problem.excitation has them."""

from __future__ import annotations

from math import cos, exp

from reference.solver.collocation import NODES, STAGES
from reference.solver.compiled import compiled
from reference.solver.system import Array, System, Work


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
def recorded_at(record: Array, t: float) -> tuple[float, float, float]:
    """The acceleration of a record, linear between its knots and zero behind them."""
    k = knot_after(record, t)
    if k == 0:
        return record[0, 1], record[0, 2], record[0, 3]
    if k == record.shape[0]:
        return 0.0, 0.0, 0.0
    a, b = record[k - 1], record[k]
    s = (t - a[0]) / (b[0] - a[0])
    return a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2]), a[3] + s * (b[3] - a[3])


@compiled
def ground_at(system: System, phase: Array, t: float) -> tuple[float, float, float]:
    """(xi'', eta'', zeta'') at time t, m/s^2."""
    if system.record.shape[0] > 0:
        return recorded_at(system.record, t)
    e0, e1 = system.exponents[0], system.exponents[1]
    z0 = exp(e0.real * t) * cos(e0.imag * t + phase[0])
    z1 = exp(e1.real * t) * cos(e1.imag * t + phase[1])
    a = system.amplitudes
    return a[0, 0] * z0 + a[0, 1] * z1, a[1, 0] * z0 + a[1, 1] * z1, a[2, 0] * z0 + a[2, 1] * z1


@compiled
def ground_at_stages(system: System, phase: Array, t: float, h: float, work: Work) -> None:
    for k in range(STAGES):
        ux, uy, uz = ground_at(system, phase, t + NODES[k] * h)
        work.ground[0, k] = ux
        work.ground[1, k] = uy
        work.ground[2, k] = uz
