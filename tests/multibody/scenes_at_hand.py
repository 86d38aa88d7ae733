"""Small scenes for the engine's closed-form cases."""

from typing import Any

import numpy as np
from rigid_chain import spatial_motion

import multibody
import reference
from multibody.integration.constant_step import set_initial_state, silence_engine
from multibody.models.assembly import assemble
from multibody.models.depressions import angular_velocity_matrix
from multibody.models.engine import exudyn
from multibody.models.state import EngineState
from reference.measures import demands
from reference.problem import Amplification, Outcome, Scene

CONSTANT = 1e9  # s, period of a harmonic that stays at its first value


def one_body(radius: float = 0.25, friction: float = 0.1, duration: float = 1.0, **load: Any) -> Scene:
    """One mass of 1 kg on the isolator; without amplitudes the plate is at rest."""
    loading = {"amplitudes": [[0.0, 0.0], [0.0, 0.0]], "periods": [1.0, 1.0], "decay": [0.0, 0.0], **load}
    table = {"title": "one body", "duration": duration, "bodies": [{"mass": 1.0}], "excitation": loading}
    return Scene.model_validate({**table, "isolator": {"radius": radius, "friction": friction}})


def frame(duration: float, count: int = 6, period: float = 0.17) -> Scene:
    """Stiffly linked floors on wide supports; period of each link, s."""
    bodies = [{"mass": 1e3, "height": 0.2 + 3.0 * floor, "size": [12.0, 12.0, 0.4]} for floor in range(count)]
    isolator = {"radius": 2.24, "friction": 0.05, "supports": 4, "ring": 6.0, "sphere_radius": 0.05}
    load = {"amplitudes": [[2.943, 0.0], [0.0, 2.943]], "periods": [0.8, 1.3], "decay": [0.1, 0.1]}
    above = [{**body, "period": [period, period]} for body in bodies[1:]]
    values = {"isolator": isolator, "bodies": [bodies[0], *above], "excitation": load}
    return Scene.model_validate({"title": "frame", "duration": duration, **values})


def forces_of_engine(model: Any, coordinates: Any, velocities: Any, contact: Any) -> tuple[Any, Any]:
    """The engine's forces (n,) and mass matrix (n, n), in its units; contacts whose data begin with -1 are closed."""
    set_initial_state(model, EngineState(coordinates, velocities, np.array(contact)))
    model.ground.begin(0.0)
    solver, settings = exudyn.MainSolverImplicitSecondOrder(), exudyn.SimulationSettings()
    settings.solution.file.write, settings.timeIntegration.verboseMode = False, 0
    with silence_engine():
        solver.InitializeSolver(model.mbs, settings)
        solver.ComputeMassMatrix(model.mbs, 1.0)
        mass = np.array(solver.GetSystemMassMatrix())
        solver.ComputeODE2RHS(model.mbs)
    return np.array(solver.GetSystemResidual()), mass


def forces_of_links(scene: Scene, coordinates: Any, velocities: Any) -> tuple[Any, Any, Any]:
    """The engine's forces and moments (N, 3) on bodies off their supports, and the model, in its units."""
    model = assemble(scene, "spatial", 1e-3)
    model.set_contact(1e-6)
    count = 6 * len(scene.bodies)
    rest = np.zeros(model.coordinates - count)
    contact = np.tile([1.0, 0.0, 0.0, 0.0], scene.isolator.support_count or 0)  # open
    pushed, _ = forces_of_engine(model, np.append(coordinates, rest), np.append(velocities, rest), contact)
    pushed = pushed[:count].reshape(-1, 2, 3).copy()
    for body, angles in enumerate(np.reshape(coordinates, (-1, 6))[:, 3:]):
        pushed[body, 1] = np.linalg.solve(angular_velocity_matrix(angles).T, pushed[body, 1])
    return pushed[:, 0], pushed[:, 1], model


def assert_within(answer: Amplification, expected: Any, errors: Any = 0.0) -> None:
    """Every point has an answer, within its error and those of what is expected."""
    assert set(answer.status) == {Outcome.OK}
    assert (np.abs(answer.mu - expected) <= answer.error + errors).all(), (answer.mu, expected, answer.error)


def assert_agree(one: Amplification, other: Amplification) -> None:
    """Two answers are the same within their errors."""
    assert set(other.status) == {Outcome.OK}
    assert_within(one, other.mu, other.error)


def both_sides(scene: Scene, phases: Any, v_reg: float = 1e-3, **asked: Any) -> tuple[Amplification, Amplification]:
    """Answers of the engine and of the equations with its law: equal within their errors."""
    regularization = None if scene.lubricated else v_reg
    engine = multibody.amplification(scene, phases, regularization=regularization, **asked)
    equations = reference.amplification(scene, phases, regularization=regularization)
    assert_agree(engine, equations)
    return engine, equations


def assert_agrees_with_newton_and_euler(scene: Scene, phase: tuple[float, float]) -> None:
    """Factors, torsion of the platform and forces of supports are those of rigid_chain.py, compiled in a minute."""
    engine = multibody.amplification(scene, [phase], "spatial")
    independent = spatial_motion(scene, phase, 1e-3)
    assert_within(engine, independent.mu)
    force = independent.support_force
    assert_demands(scene, phase, np.abs(independent.yaw).max(), force.min(), force.max())


def assert_demands(scene: Scene, phase: tuple[float, float], *expected: float) -> None:
    """Torsion of the platform, rad, and the extreme forces of single supports, N, are these within their errors."""
    found: Any = demands(multibody.trajectory(scene, phase, "spatial"))
    numbers = (found.torsion[0], found.support_force_min, found.support_force_max)
    for number, value in zip(numbers, expected, strict=True):
        assert abs(number.value - value) <= number.error, (number, value)
