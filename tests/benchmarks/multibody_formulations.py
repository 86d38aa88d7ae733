"""
Formulations of the translational model and solvers of the engine, side by side.

`python tests/benchmarks/multibody_formulations.py`; with EXUDYN_MODULE=fast, the engine's fast module.

Every candidate runs one phase pair at constant step. The table gives its processor time in units of one plain run
(the engine's defaults at 1 ms on the rigid body, as its tutorials do it) and its relative error against the equations.
"""

import numpy as np
from formulations import FORMULATIONS, PENETRATION, V_REG, run

import reference
from multibody.integration.constant_step import INTEGRATORS
from reference.problem import load_scene


def main() -> None:
    scene, phase = load_scene("fig3-I"), np.array([0.3, 1.1])
    exact = reference.amplification(scene, [phase], equations="exact", regularization=V_REG).mu[0]
    candidates = {name: build(scene, PENETRATION) for name, build in FORMULATIONS.items()}
    plain = min(
        run(scene, candidates["rigid body"], phase, "generalized alpha", 1e-3, modified=False)[1] for _ in range(3)
    )
    print(f"plain run: {plain:.3f} s of processor time")
    print(f"{'formulation':16s} {'solver':18s} {'step [s]':>9s} {'cost/plain':>10s}   relative error of mu_i")
    for name, candidate in candidates.items():
        for solver in INTEGRATORS:
            for step in (2e-3, 1e-3) if solver in INTEGRATORS[:2] else (4e-4, 2e-4):
                peaks, cost = run(scene, candidate, phase, solver, step)
                errors = "  ".join(f"{value:+.1e}" for value in peaks / exact - 1.0)
                print(f"{name:16s} {solver:18s} {step:9.1e} {cost / plain:10.2f}   {errors}", flush=True)


if __name__ == "__main__":
    main()
