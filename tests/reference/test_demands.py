"""Demands of a motion: closed forms, the same numbers from both sides, and errors that hold."""

import copy
import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from chains import chain, made_up

import multibody
import reference
from reference.measures import Demands, Estimate, demands
from reference.measures.demand_reader import largest_displacement
from reference.measures.peak_demands import list_demands
from reference.problem import GRAVITY, Accuracy, Scene, State, Trajectory, ground_peak

PHASE = (2.0, 0.7)
RHO = 0.25


def one_body(friction: float = 0.0) -> Scene:
    return chain(RHO, friction, [3.0], (), [[0.4, 0.0], [0.0, 0.3]], decay=(0.0, 0.0), duration=2.0)


def estimates(answer: Demands) -> dict[str, Estimate]:
    """Every number of the demands by its name."""
    named = {name: value for name, value in vars(answer).items() if isinstance(value, Estimate)}
    listed = {name: value for name, value in vars(answer).items() if isinstance(value, tuple)}
    return named | {f"{name} {number}": part for name, parts in listed.items() for number, part in enumerate(parts)}


def test_a_body_released_in_a_smooth_cap_swings_back() -> None:
    """Frictionless plane pendulum on a plate at rest: amplitude A, N = m g (3 cos t - 2 cos A) from the energy."""
    scene = one_body().with_values({"excitation.amplitudes": [[0.0, 0.0], [0.0, 0.0]]})
    released = State(position=np.array([[0.6 * RHO, 0.0]]), velocity=np.zeros((1, 2)))
    answer = demands(reference.trajectory(scene, PHASE, initial=released))
    cosine, angles = 0.8, np.linspace(0.0, np.arcsin(0.6), 100_001)
    force = 3.0 * GRAVITY * (3.0 * np.cos(angles) - 2.0 * cosine)
    expected = {"displacement": 0.6 * RHO, "cap_share": 0.6, "base_shear": (force * np.sin(angles)).max()}
    for name, value in {**expected, "contact_force_max": force[0], "contact_force_min": force[-1]}.items():
        found = estimates(answer)[name]
        assert abs(found.value - value) <= found.error + 1e-9 * value, name
        assert found.error < 1e-3 * value, name
    assert np.isnan(answer.residual.value), "a frictionless platform never rests"
    assert answer.stops.value == 0.0
    assert answer.drift == ()


def test_a_platform_that_friction_holds_moves_with_the_ground() -> None:
    """Base shear m a_g, contact force m g, no displacement, no stop."""
    scene = one_body(friction=0.3)
    answer = demands(reference.trajectory(scene, PHASE))
    shaking = ground_peak(scene, [PHASE])[0]
    assert answer.base_shear.value == pytest.approx(3.0 * shaking, abs=answer.base_shear.error)
    assert answer.base_shear.error < 2e-2 * answer.base_shear.value
    assert answer.acceleration[0].value == pytest.approx(shaking, abs=answer.acceleration[0].error)
    assert answer.acceleration[0].error < 1e-6
    assert (answer.displacement.value, answer.residual.value, answer.stops.value) == (0.0, 0.0, 0.0)
    assert answer.contact_force_min.value == pytest.approx(3.0 * GRAVITY, rel=1e-12)


@pytest.mark.parametrize("side", ["equations", "engine"])
@pytest.mark.parametrize("law", ["friction", "lubrication"])
def test_the_isolator_force_is_friction_and_restoring_force(law: str, side: str) -> None:
    """-sum of m a = -N (n - mu w) wherever the platform slides, with the normal force N that the motion has."""
    masses = np.array([50.0, 40.0, 40.0, 40.0, 40.0, 30.0])
    links = np.outer(masses[1:], (2.0 * np.pi / np.array([0.5, 0.6])) ** 2).tolist()
    loading = {"amplitudes": [[1.5, 0.5], [0.5, 1.5]], "periods": (0.9, 1.3), "decay": (0.2, 0.2)}
    scene = chain(1.0, masses=masses.tolist(), stiffness=links, **loading, duration=2.0, **{law: 0.05})
    trajectory = reference.trajectory if side == "equations" else multibody.trajectory
    motion = trajectory(scene, PHASE, regularization=1e-3 if law == "friction" else None)
    place, velocity = motion.position[:, 0], motion.velocity[:, 0]
    speed = np.linalg.norm(velocity, axis=1)
    slides = speed > 1e-2
    assert slides.sum() > 100
    friction = 0.05 * velocity / (np.maximum(speed, 1e-300)[:, None] if law == "friction" else 1.0)
    expected = motion.contact_force[:, None] * (place / scene.radius + friction)[:, :2]
    atol = (1e-5 if side == "equations" else 1e-4) * GRAVITY * scene.total_mass
    np.testing.assert_allclose(motion.isolator_force[slides], expected[slides], atol=atol)


def test_a_displacement_between_two_samples_is_found() -> None:
    time = np.array([-0.3, 0.5])
    place = np.stack([np.sqrt(1.0 - time**2), np.zeros(2)], axis=1)  # its square is the parabola 1 - t^2
    velocity = np.stack([-time / place[:, 0], np.zeros(2)], axis=1)
    assert largest_displacement(time, place, velocity) == pytest.approx(1.0, rel=1e-12)


def assert_covered(found: Trajectory, truth: Trajectory) -> None:
    """Every number of a motion is within its error of that of a truer one."""
    numbers = estimates(demands(truth))
    for name, number in estimates(demands(found)).items():
        assert abs(number.value - numbers[name].value) <= number.error + numbers[name].error, name


@pytest.mark.parametrize("count", [150, 400])
def test_the_error_covers_what_coarse_samples_miss(count: int) -> None:
    scene = reference.load_scene("fig3-I")
    coarse = reference.trajectory(scene, PHASE, times=np.linspace(0.0, scene.duration, count))
    assert_covered(coarse, reference.trajectory(scene, PHASE))


@pytest.mark.parametrize("phase", [(5.277, 3.201), (3.453, 0.173), (1.202, 0.512), (3.726, 1.634)])
def test_the_error_covers_what_the_tolerance_leaves(phase: tuple[float, float]) -> None:
    """Phases at which two runs agree by chance far better than either agrees with a much tighter one."""
    for scene in map(reference.load_scene, ("fig3-I", "fig3-II")):
        loose, close, truth = (reference.trajectory(scene, phase, "small", tolerance=t) for t in (1e-3, 1e-6, 1e-9))
        assert_covered(loose, truth)
        assert_covered(close, truth)


def test_the_stops_are_the_rests_after_the_first_slip() -> None:
    motion = reference.trajectory(reference.load_scene("fig3-I"), PHASE)
    assert motion.stick[0][0] == 0.0, "the motion begins at rest"
    assert demands(motion).stops == Estimate(len(motion.stick) - 1.0, 0.0)
    assert motion.stick[-1][1] == motion.time[-1]
    assert demands(motion).residual.value == pytest.approx(np.hypot(*motion.position[-1, 0, :2]), rel=1e-12)


def shaken_then_still(**isolator: Any) -> Scene:
    """One body, 2 s of a decaying sweep along both axes, then 60 s of a ground at rest."""
    time = np.append(np.arange(0.0, 2.0, 0.02), [2.0, 62.0])
    decay = np.where(time < 2.0, np.exp(-time), 0.0)
    shaking = np.column_stack([5.0 * np.sin(6.0 * time + time**2), 4.0 * np.cos(7.0 * time), 0.0 * time])
    record = {"time": time, "acceleration": shaking * decay[:, None]}
    isolator = {"radius": 2.0, **(isolator or {"friction": 0.05})}
    return one_body().with_values({"duration": 62.0, "isolator": isolator, "excitation": {"record": record}})


def test_a_residual_after_creep_is_that_of_coulomb_friction() -> None:
    """At rest a regularized platform creeps to the center like exp(-t v_reg / (mu rho)); its residual does not."""
    scene, v_reg = shaken_then_still(), 1e-3
    truth = demands(reference.trajectory(scene, PHASE)).residual
    assert truth.value > 0.02
    assert truth.error < 1e-5 * truth.value, "Coulomb friction does not creep"
    engine = multibody.single_run(scene, PHASE, step=5e-3, regularization=v_reg)
    for motion in (reference.trajectory(scene, PHASE, regularization=v_reg), engine):
        end = float(np.hypot(*motion.position[-1, 0, :2]))
        start = motion.stick[-1][0]
        assert end == pytest.approx(truth.value * np.exp(-(scene.duration - start) * v_reg / (0.05 * 2.0)), rel=0.02)
        found = demands(motion).residual
        assert abs(found.value - truth.value) < 0.02 * (truth.value - end)
        if motion is not engine:  # a single run states no errors
            assert truth.value - end < found.error < 2.0 * truth.value
            rests = np.searchsorted(motion.time, motion.stick)
            ways = np.linalg.norm(np.diff(motion.position[rests, 0, :2], axis=1)[:, 0], axis=-1)
            assert (found.error >= 0.999 * ways.sum(), len(ways) > 1) == (True, True), "of all rests together"


@pytest.mark.parametrize(
    ("isolator", "duration", "reason"),
    [
        ({"friction": 0.05}, 1.0, "moving at the end: take a longer duration"),
        ({"friction": {"slow": 0.05, "yield_displacement": 1e-4}}, 1.0, "moving at the end: take a longer duration"),
        ({"friction": 0.0}, 62.0, "never at rest: no dry friction"),
        ({"lubrication": 0.5}, 62.0, "never at rest: no dry friction"),
    ],
)
def test_a_residual_that_is_none_says_why(isolator: dict[str, Any], duration: float, reason: str) -> None:
    scene = shaken_then_still(**isolator).with_values({"duration": duration})
    motion = reference.trajectory(scene, PHASE)
    answer = demands(motion)
    assert (motion.status, answer.residual.reason) == ("ok", reason)
    assert np.isnan(answer.residual.value)
    assert not any(found.reason for name, found in estimates(answer).items() if name != "residual")


def test_a_motion_that_ends_early_has_a_status_and_no_numbers() -> None:
    beyond = reference.trajectory(reference.load_scene("fig3-I").with_amplitude(60.0), PHASE)
    refused = multibody.trajectory(reference.load_scene("fig3-I").with_values({"duration": 1e5}), PHASE)
    assert len(beyond.time) > len(refused.time) == 0
    for motion, status in ((beyond, "rim reached"), (refused, "step limit")):
        answer = demands(motion)
        assert (answer.status, len(answer.acceleration), len(answer.drift)) == (status, 2, 1)
        assert np.isnan([(found.value, found.error) for found in estimates(answer).values()]).all()
        of_bodies = {(name, body) for name, body, _ in list_demands(answer) if body}
        assert {("acceleration", 1), ("acceleration", 2)} == of_bodies - {("drift", 2)} < of_bodies


def held(place: float, force: float, rests: int, accuracy: Accuracy | None = None) -> Trajectory:
    """A made-up motion, constant in time but for its first velocity: its friction heats and its rests are counted."""
    scene = shaken_then_still().with_values({"bodies": [{"mass": 3.0}, {"mass": 2.0, "period": [0.5, 0.5]}]})
    time = np.linspace(0.0, scene.duration, 101)
    position, velocity, acceleration = np.zeros((3, 101, 2, 3))
    position[:, :, 0] = place, 3.0 * place
    acceleration[:, 0, 0] = force / 3.0
    velocity[0, 0, 0] = np.sqrt(2.0 * force / 3.0)  # what friction takes is there at the start
    part = time / scene.duration
    power = 6.0 * part * (1.0 - part) * force / scene.duration
    stick = [(scene.duration * (k + 0.5) / rests, scene.duration * (k + 1.0) / rests) for k in range(rests)]
    moving = {"position": position, "velocity": velocity, "absolute_acceleration": acceleration}
    forces = {
        "contact_force": np.full(101, 10.0 * force),
        "peak": np.array([force / 3.0, 0.0]),
        "friction_power": power,
    }
    return made_up(scene, time, stick, **moving, **forces, ground=np.zeros((101, 3)), accuracy=accuracy)


def test_creep_that_coarser_samples_miss_is_in_the_error_of_a_residual() -> None:
    """Samples of two rests are 0.01 and 0.02 m away: every fifth sample misses both in four of five ways."""
    motion, alike = held(1.0, 12.0, 4), Accuracy(np.zeros(2), (), (), 0.0)
    position = motion.position.copy()
    position[[20, 95], 0, 0] += 0.01, 0.02
    residual = demands(replace(motion, position=position, accuracy=alike)).residual
    assert (residual.value, residual.error) == pytest.approx((1.0, 0.03 + 0.03))
    first = motion.position.copy()
    first[88, 0, 0] += 0.03  # where the last rest begins: the others are so far from it
    residual = demands(replace(motion, position=first, accuracy=alike)).residual
    assert (residual.value, residual.error) == pytest.approx((1.03, 0.03 + 0.03 + 0.03))
    position[:98] += 0.5  # a rest of three samples: two of five ways to take every fifth one do not see it
    late = replace(motion, position=position, stick=[(motion.time[98], motion.time[-1])], accuracy=alike)
    assert (demands(late).residual.value, demands(late).residual.error) == (1.0, 0.0)


def test_the_error_of_every_demand_is_what_the_samples_and_the_other_runs_say() -> None:
    """
    A half of the difference to one run, a quarter of that to another, and a hundredth of the value.

    The trapezoidal rule misses a sum of d^3 over intervals d of the power: 1e-4 in a hundred, 2.5e-3 in twenty.
    """
    spike, step = np.zeros(101), 62.0 / 100.0
    spike[52] = 1.0  # a fifth of the samples count it five times, the others do not
    found = demands(replace(held(1.0, 12.0, 4, Accuracy(np.zeros(2), (), (), 0.0)), friction_power=spike))
    assert (found.friction_energy.value, found.friction_energy.error) == pytest.approx((step, 4.0 * step / 4.0))
    others = held(0.8, 14.0, 3), held(1.4, 10.0, 6)
    motion = held(1.0, 12.0, 4, Accuracy(np.array([0.7, 0.9]), others, (0.5, 0.25), 0.01))
    answer = demands(motion)
    rho, sum_of, sampling = motion.scene.radius, 1.0 - 1e-4, 12.0 * 2.4e-3 / 4.0
    expected = {
        "displacement": (1.0, 0.01 + 0.1 + 0.1),
        "residual": (1.0, 0.01 + 0.1 + 0.1),
        "cap_share": (1.0 / rho, 0.21 / rho),
        "acceleration 0": (4.0, 0.7),
        "acceleration 1": (0.0, 0.9),
        "base_shear": (12.0, 0.12 + 1.0 + 0.5),
        "drift 0": (2.0, 0.42),
        "contact_force_min": (120.0, 16.2),
        "contact_force_max": (120.0, 16.2),
        "stops": (4.0, 2.0),
        "friction_energy": (12.0 * sum_of, sampling + (0.12 + 1.0 + 0.5) * sum_of),
        "energy_balance": (12.0 * 1e-4, sampling + 0.12 * sum_of + (1.0 + 0.5) * 1e-4),
    }
    found = estimates(answer)
    for name, (value, error) in expected.items():
        assert found[name].value == pytest.approx(value), name
        assert found[name].error == pytest.approx(error), name


def test_support_forces_and_torsion_are_those_of_the_spatial_model_alone() -> None:
    scene = reference.load_scene("fig3-I").with_values({"duration": 1.5, "bodies.1.offset": [0.1, 0.0]})
    motion = multibody.trajectory(scene, PHASE, "spatial")
    answer = demands(motion)
    force, weight = motion.extra["support_force"], scene.total_mass * GRAVITY
    assert (answer.support_force_min.value, answer.support_force_max.value) == (force.min(), force.max())
    assert 0.0 < max(answer.support_force_min.error, answer.support_force_max.error) < 0.02 * weight
    assert [turn.value for turn in answer.torsion] == np.abs(motion.extra["turns"][:, :, 2]).max(axis=0).tolist()
    assert answer.torsion[0].value == np.abs(motion.extra["yaw"]).max()
    assert answer.torsion[1].value > 1e-3
    assert all(0.0 < turn.error < 0.05 * turn.value for turn in answer.torsion)
    plain = demands(multibody.trajectory(scene, PHASE))
    assert plain.support_force_min is plain.support_force_max is plain.uplift is plain.torsion is None


def test_a_motion_survives_copies_and_processes_with_its_scene() -> None:
    motion = reference.trajectory(reference.load_scene("fig3-I"), PHASE)
    expected = demands(motion)
    for other in (pickle.loads(pickle.dumps(motion)), copy.deepcopy(motion), replace(motion, status="ok")):
        assert isinstance(other, Trajectory)
        assert other.scene == motion.scene
        assert demands(other) == expected
