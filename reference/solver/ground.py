"""Ground acceleration (5.3) inside compiled code; the closed form is that of reference.problem.excitation."""

from __future__ import annotations

from math import cos, exp

from reference.solver.collocation import NODES, STAGES
from reference.solver.compiled import compiled
from reference.solver.system import Array, System, Work


@compiled
def ground_at(system: System, phase: Array, t: float) -> tuple[float, float, float]:
    """(xi'', eta'', zeta'') at time t, m/s^2."""
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
