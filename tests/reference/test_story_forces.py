"""Story shears, overturning moments and support forces against hand calculation."""

import numpy as np
import pytest

import multibody
import reference
from reference.measures import StoryForces, story_forces
from reference.measures.story_forces import support_loads_at_rest
from reference.problem.result import Trajectory

KICK = {"record": {"time": [0.0, 0.3, 0.6, 0.9, 1.2], "acceleration": [[0.0, 0.0], [3, 1], [-3, 2], [2, -2], [0, 0]]}}
TABLES = {
    "title": "two floors on a platform on four pendulums",
    "duration": 2.0,
    "isolator": {
        "radius": 2.0, "friction": {"slow": 0.03, "fast": 0.06, "rate": 50.0},
        "supports": [[3.0, 2.0], [-3.0, 2.0], [-3.0, -2.0], [3.0, -2.0]], "sphere_radius": 0.1,
    },
    "bodies": [
        {"mass": 40e3, "height": 2.6, "size": [7.0, 5.0, 0.6]},
        {"mass": 30e3, "height": 5.6, "size": [7.0, 5.0, 0.3], "stiffness": [30e6, 20e6]},
        {"mass": 20e3, "height": 8.6, "size": [7.0, 5.0, 0.3], "stiffness": [20e6, 25e6]},
    ],
    "excitation": KICK,
}  # fmt: skip
R = 2.1  # m, of the depressions: their centers, from which heights count, are so far below the contact
HEIGHTS, MASSES = np.array([0.5, 3.5, 6.5]), np.array([40e3, 30e3, 20e3])  # above the contact
PLACES = np.array(TABLES["isolator"]["supports"])  # type: ignore[index]


@pytest.fixture(scope="module")
def moved() -> tuple[Trajectory, StoryForces]:
    motion = reference.trajectory(reference.Scene.model_validate(TABLES), (0.0, 0.0))
    return motion, story_forces(motion)


@pytest.fixture(scope="module")
def turned() -> tuple[Trajectory, StoryForces]:
    motion = multibody.trajectory(reference.Scene.model_validate(TABLES), (0.0, 0.0), model="spatial", tolerance=1e-2)
    return motion, story_forces(motion)


def test_story_shears_are_the_forces_of_the_springs_from_the_drifts(moved: tuple[Trajectory, StoryForces]) -> None:
    """By hand: without dampers the shear below a floor is stiffness times drift, and the top one mass times a."""
    motion, forces = moved
    drift = np.diff(motion.position[:, :, :2], axis=1)
    springs = np.array([[30e6, 20e6], [20e6, 25e6]]) * drift
    by_hand = np.linalg.norm(springs, axis=2).max(axis=0)
    # the exact equations give the links their elongation on the sphere: a part in a thousand here
    assert [each.value for each in forces.shear[1:]] == pytest.approx(by_hand, rel=2e-3)
    assert forces.shear[0] == reference.demands(motion).base_shear
    top = MASSES[2] * np.linalg.norm(motion.absolute_acceleration[:, 2, :2], axis=1).max()
    assert forces.shear[2].value == pytest.approx(top, rel=1e-12)


def test_overturning_moments_are_those_of_the_floor_forces(moved: tuple[Trajectory, StoryForces]) -> None:
    motion, forces = moved
    force = MASSES[:, None] * motion.absolute_acceleration[:, :, :2]
    about = [0.0, *HEIGHTS[:-1]]
    by_hand = [
        np.linalg.norm(((HEIGHTS - low)[number:, None] * force[:, number:]).sum(axis=1), axis=1).max()
        for number, low in enumerate(about)
    ]
    assert forces.moment is not None
    assert [each.value for each in forces.moment] == pytest.approx(by_hand, rel=1e-12)
    assert all(0.0 <= each.error < 0.02 * each.value for each in forces.moment)


def test_forces_and_drifts_along_x_and_y_are_those_of_one_axis_each(moved: tuple[Trajectory, StoryForces]) -> None:
    motion, forces = moved
    force = MASSES[:, None] * motion.absolute_acceleration[:, :, :2]
    drift = np.abs(np.diff(motion.position[:, :, :2], axis=1)).max(axis=0)
    assert forces.moment_along is not None
    for axis in (0, 1):
        for body in range(3):
            shear = np.abs(force[:, body:, axis].sum(axis=1)).max()
            about = HEIGHTS[body - 1] if body else 0.0
            moment = np.abs(((HEIGHTS - about)[body:] * force[:, body:, axis]).sum(axis=1)).max()
            assert forces.shear_along[axis][body].value == pytest.approx(shear, rel=1e-12)
            assert forces.moment_along[axis][body].value == pytest.approx(moment, rel=1e-12)
        assert [each.value for each in forces.drift_along[axis]] == pytest.approx(drift[:, axis], rel=1e-12)


def moments(motion: Trajectory, heights: np.ndarray = HEIGHTS, lean: float = R / 2.0) -> np.ndarray:
    """Overturning moment on the supports over time, (T, 2), N m: of the floor forces, and of the displaced weight."""
    of_floors = np.einsum("i,tia->ta", MASSES * heights, motion.absolute_acceleration[:, :, :2])
    drift = motion.position[:, 1:, :2] - motion.position[:, :1, :2]
    of_floors = of_floors - motion.contact_force[:, None] * (MASSES[1:, None] / MASSES.sum() * drift).sum(axis=1)
    moment: np.ndarray = of_floors - lean * motion.contact_force[:, None] * motion.position[:, 0, :2]
    return moment


@pytest.mark.parametrize("flat", [False, True])
def test_supports_of_uneven_places_balance_weight_and_moment_about_any_point(flat: bool) -> None:
    """By hand: N_k = c0 + c1 x_k + c2 y_k with their sum and both moments about the axis of the links."""
    places = np.array([[3.0, 2.0], [-3.5, 2.2], [-2.0, -2.6], [0.5, -1.5], [4.0, -0.5]])
    radius = np.inf if flat else 2.0
    isolator = {**TABLES["isolator"], "supports": places.tolist(), "radius": radius}  # type: ignore[dict-item]
    bodies = [{**body, "offset": [0.2 * n, -0.3]} for n, body in enumerate(TABLES["bodies"])]  # type: ignore[arg-type]
    motion = reference.trajectory(
        reference.Scene.model_validate({**TABLES, "isolator": isolator, "bodies": bodies}), (0, 0)
    )
    forces = story_forces(motion)
    offsets = MASSES / MASSES.sum() @ [body["offset"] for body in bodies]
    overturning = moments(motion, HEIGHTS + R, 1.0) if flat else moments(motion)
    wanted = np.column_stack([motion.contact_force, motion.contact_force[:, None] * offsets - overturning])
    shape = np.column_stack([np.ones(len(places)), places])
    by_hand = wanted @ np.linalg.inv(shape.T @ shape) @ shape.T
    assert forces.uplift is None
    assert forces.support_min is not None
    assert forces.support_max is not None
    assert [each.value for each in forces.support_min] == pytest.approx(by_hand.min(axis=0))
    assert [each.value for each in forces.support_max] == pytest.approx(by_hand.max(axis=0))


def test_support_forces_of_the_engine_balance_the_overturning_moment(turned: tuple[Trajectory, StoryForces]) -> None:
    """Sum of N_k r_k about the middle is minus the moment, but for the inertia of bodies that turn."""
    motion, forces = turned
    by_supports, by_hand = -motion.support_force @ PLACES, moments(motion)
    assert np.linalg.norm(by_hand - by_supports, axis=1).max() < 0.01 * np.linalg.norm(by_hand, axis=1).max()
    assert forces.support_max is not None
    assert [each.value for each in forces.support_max] == pytest.approx(motion.support_force.max(axis=0))
    assert forces.uplift is not None
    assert max(each.value for each in forces.uplift) < 1e-3, "all supports stay closed in this motion"


def test_the_engine_and_statics_give_the_same_support_forces(
    moved: tuple[Trajectory, StoryForces], turned: tuple[Trajectory, StoryForces]
) -> None:
    for name in ("support_min", "support_max"):
        one, other = (np.array([each.value for each in getattr(forces, name)]) for _, forces in (moved, turned))
        assert one == pytest.approx(other, rel=5e-3), name


def test_no_moment_without_heights_and_no_supports_without_places() -> None:
    for changed in ({"bodies.1.height": None}, {"isolator.supports": None}):
        scene = reference.load_scene("fig3-I").with_values(changed)
        forces = story_forces(reference.trajectory(scene, (0.3, 1.1)))
        assert (forces.support_min, forces.support_max, forces.uplift) == (None, None, None)
        assert (forces.moment is None) == (forces.moment_along is None) == ("bodies.1.height" in changed)


def test_dead_loads_follow_the_centers_of_mass() -> None:
    """By hand: a roof of 20 t, 2 and 1.5 m off the middle of four supports at 3 and 2 m."""
    bodies = [*TABLES["bodies"][:2], {**TABLES["bodies"][2], "offset": [2.0, 1.5]}]  # type: ignore[index]
    even, uneven = (reference.Scene.model_validate({**TABLES, **more}) for more in ({}, {"bodies": bodies}))
    weight = 9.81 * 20e3
    by_hand = 9.81 * 90e3 / 4.0 + weight * (2.0 * PLACES[:, 0] / 36.0 + 1.5 * PLACES[:, 1] / 16.0)
    loads = support_loads_at_rest(uneven)
    assert loads == pytest.approx(by_hand, rel=1e-9)
    assert support_loads_at_rest(even) == pytest.approx(9.81 * 90e3 / 4.0)
    assert "220.7 kN on each of 4 supports (equal dead load)" in reference.describe_building(even).lines[0]
    ends = f"{by_hand.min() / 1e3:.4g} kN to {by_hand.max() / 1e3:.4g} kN at rest, by statics"
    assert f"220.7 kN on each of 4 supports in the mean ({ends})" in reference.describe_building(uneven).lines[0]
