"""What the engine's answers cost: one point against one plain run."""

import time
from typing import Any

import numpy as np
import pytest

import multibody
from multibody.integration.constant_step import MAX_CONTRACTIVITY, SPECTRAL_RADIUS, silence_engine
from multibody.models.assembly import assemble
from multibody.models.engine import exudyn
from reference.problem import Scene, ground_acceleration, load_scene

PENETRATION = 1e-6


def plain_run(scene: Scene, model: Any, phase: np.ndarray, kind: str) -> float:
    """Processor time, s, with Exudyn's defaults, or tuned: with the Newton tolerances and damping of this package."""
    settings, initial = exudyn.SimulationSettings(), exudyn.ConfigurationType.Initial
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 0.0
    integration = settings.timeIntegration
    integration.verboseMode = 0
    integration.endTime, integration.numberOfSteps = scene.duration / model.units.time, round(1e3 * scene.duration)
    if kind == "tuned":
        integration.newton.useModifiedNewton = True
        integration.newton.modifiedNewtonContractivity = MAX_CONTRACTIVITY
        integration.newton.relativeTolerance, integration.newton.absoluteTolerance = 1e-5, 1e-8
        integration.generalizedAlpha.spectralRadius = SPECTRAL_RADIUS
    model.ground.set_phase(phase)
    state, data = model.start(None, ground_acceleration(scene, phase, [0.0])[0], PENETRATION), model.mbs.systemData
    data.SetODE2Coordinates(state.coordinates, configuration=initial)
    data.SetODE2Coordinates_t(state.velocities, configuration=initial)
    data.SetDataCoordinates(state.contact, configuration=initial)
    clock = time.process_time()
    with silence_engine():
        model.mbs.SolveDynamic(settings)
    return time.process_time() - clock


@pytest.mark.long
@pytest.mark.parametrize("name", ["fig3-I", "fig3-II", "fig4-dry"])
@pytest.mark.parametrize(
    # with the default tolerances, which lie below the rounding of its contacts, a spatial run takes over ten seconds
    ("model", "kinds"),
    [("translational", ("defaults", "tuned")), ("spatial", ("tuned",))],
)
def test_a_point_costs_at_most_one_plain_run_in_the_median(name: str, model: str, kinds: tuple[str, ...]) -> None:
    """A plain run: the same model, 20 s in 20 000 equal steps, generalized alpha, one call of SolveDynamic."""
    scene = load_scene(name)
    plain = assemble(scene, model, 1e-3)
    plain.set_contact(PENETRATION)
    phases = np.random.default_rng(5).uniform(0.0, 2.0 * np.pi, (9, 2))
    multibody.amplification(scene, phases[:1], model=model)  # compiles the loading's peak
    costs: dict[str, list[float]] = {kind: [] for kind in (*kinds, "point")}
    for phase in phases:
        for kind in kinds:
            costs[kind].append(plain_run(scene, plain, phase, kind))
        costs["point"].append(multibody.amplification(scene, [phase], model=model).cost)
    ratios = {kind: float(np.median(np.divide(costs["point"], costs[kind]))) for kind in kinds}
    print(f"\n{name} {model}: {np.median(costs['point']):.3f} s a point,", end=" ")
    print(", ".join(f"{ratio:.2f} plain runs ({kind})" for kind, ratio in ratios.items()))
    assert ratios[kinds[0]] <= 1.0
