"""What the engine's answers cost: one point against one plain run, memory of many runs."""

import multiprocessing
import time
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np
import pytest

import multibody
from multibody.integration.constant_step import MAX_CONTRACTIVITY, SPECTRAL_RADIUS, Engine, silence
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
    with silence():
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


@pytest.mark.long
def test_building_and_reading_back_take_at_most_a_tenth_of_the_solve(monkeypatch: pytest.MonkeyPatch) -> None:
    spent = {"build": 0.0, "read": 0.0, "run": 0.0}

    def clocked(name: str, function: Any) -> Any:
        def call(*arguments: Any, **options: Any) -> Any:
            begin = time.process_time()
            try:
                return function(*arguments, **options)
            finally:
                spent[name] += time.process_time() - begin

        return call

    from multibody import surface

    monkeypatch.setattr(surface, "assemble", clocked("build", surface.assemble))
    monkeypatch.setattr(Engine, "_read", clocked("read", Engine._read))
    monkeypatch.setattr(Engine, "run", clocked("run", Engine.run))
    multibody.amplification(load_scene("fig3-I"), np.random.default_rng(5).uniform(0.0, 6.0, (8, 2)))
    assert spent["build"] + spent["read"] <= 0.1 * (spent["run"] - spent["read"])


def processor_time_of(phase: np.ndarray) -> float:
    """What one point of fig3-I costs the process that answers it, s of processor time."""
    begin = time.process_time()
    assert multibody.amplification(load_scene("fig3-I"), [phase]).status[0] == "ok"
    return time.process_time() - begin


@pytest.mark.long
def test_points_cost_no_more_processor_time_in_two_workers_than_in_one() -> None:
    phases = list(np.random.default_rng(5).uniform(0.0, 2.0 * np.pi, (12, 2)))
    context = multiprocessing.get_context("spawn")
    cost: dict[int, list[float]] = {1: [], 2: []}  # per point, summed over the workers, of every round
    wall: dict[int, list[float]] = {1: [], 2: []}
    with ProcessPoolExecutor(1, context) as alone, ProcessPoolExecutor(2, context) as pair:
        for pool in (alone, pair):  # starts the workers, which compile the loading's peak
            list(pool.map(processor_time_of, phases[:4]))
        for _ in range(5):  # in turn, so that what else the machine does falls on both
            for workers, pool in ((1, alone), (2, pair)):
                begin = time.perf_counter()
                cost[workers].append(sum(pool.map(processor_time_of, phases)) / len(phases))
                wall[workers].append(time.perf_counter() - begin)
    efficiency, speedup = np.divide(cost[1], cost[2]), np.divide(wall[1], wall[2])
    print(f"\n{np.median(cost[1]):.3f} s a point alone, {np.median(cost[2]):.3f} s with two workers, processor time")
    print(f"efficiency by round {np.round(efficiency, 2)}, wall time less by {np.round(speedup, 2)}")
    # workers share nothing but the machine's memory and clock, which a tenth leaves room for; waiting does not count
    # here, so that the load of others does not, and the wall ratio is for a reader who knows the machine to be idle
    assert np.median(efficiency) >= 0.9
