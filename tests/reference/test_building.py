"""What is said of a building before anything is computed, against hand calculations."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reference import damped_modes, describe_building, load_scene
from reference.building import word_buildings
from reference.problem import Scene, ground_acceleration, phase_grid

FLOORS = 5
MASS, STIFFNESS = 3e5, 4e8  # kg, N/m, of every floor and story


def shear_building(damping: float | list[float] = 0.05) -> Scene:
    """Five equal floors on a platform with twelve supports."""
    floors = [{"mass": MASS, "stiffness": [STIFFNESS, 4.0 * STIFFNESS], "damping": damping} for _ in range(FLOORS)]
    isolator = {"radius": 2.2, "friction": 0.05, "supports": 12, "ring": 10.0, "sphere_radius": 0.15}
    return load_scene("fig3-I").with_values({"bodies": [{"mass": 2e5}, *floors], "isolator": isolator})


def test_modal_damping_is_that_of_complex_modes_where_dampers_are_weak() -> None:
    """A platform so heavy that it does not move is a fixed base."""
    scene = shear_building().with_values({"bodies.0.mass": 1e14, "bodies.2.damping": [3e4, 1e3]})
    scene = scene.with_values({f"bodies.{floor}.damping": [1e3 * floor, 2e3] for floor in (1, 3, 4, 5)})
    scene = scene.with_values({f"bodies.{floor}.mass": MASS / floor for floor in (1, 2, 3, 4, 5)})
    complex_modes = np.sort(damped_modes(scene).damping_ratio[:, 2::2], axis=1)
    building = describe_building(scene)
    np.testing.assert_allclose(np.sort(building.modal_damping, axis=1), complex_modes, rtol=1e-4)
    np.testing.assert_allclose(building.modal_mass.sum(axis=1), 1.0, rtol=1e-9)


def test_peak_of_the_ground_is_the_resultant_of_x_and_y_over_all_phases() -> None:
    for second in (-1.0, 1.0):
        amplitudes = [[1.0, 0.4 * second], [-0.3, -0.8 * second], [9.0, 9.0]]
        scene = load_scene("fig3-I").with_values({"excitation.amplitudes": amplitudes})
        start = [ground_acceleration(scene, phases, [0.0])[0, :2] for phases in phase_grid(16).reshape(-1, 2)]
        assert describe_building(scene).ground_peak == pytest.approx(np.linalg.norm(start, axis=1).max(), rel=1e-12)
    pair = load_scene("synthetic-pair")
    motion = ground_acceleration(pair, (0.0, 0.0), pair.record[:, 0])[:, :2]
    assert describe_building(pair).ground_peak == np.linalg.norm(motion, axis=1).max()


def test_a_body_alone_has_no_fixed_base_modes() -> None:
    alone = load_scene("fig3-I").with_values({"bodies": [{"mass": 2.0}]})
    building = describe_building(alone)
    assert building.fixed_base_period.shape == building.modal_damping.shape == (2, 0)
    assert not any("fixed base" in line or "damping" in line for line in building.lines)


def test_a_tall_chain_is_described_by_its_lowest_modes() -> None:
    floors = [{"mass": MASS, "stiffness": [STIFFNESS] * 2} for _ in range(2000)]
    building = describe_building(shear_building().with_values({"bodies": [{"mass": MASS}, *floors]}))
    assert building.fixed_base_period.shape == (2, 10)
    assert all(line.endswith(" s and 4 more along x and y") for line in building.lines[2:4])
    first = np.sin(np.pi / (4.0 * 2000 + 2.0)) * 2.0 * np.sqrt(STIFFNESS / MASS)
    assert building.fixed_base_period[0, 0] == pytest.approx(2.0 * np.pi / first, rel=1e-10)


def test_the_lines_of_a_building_have_its_numbers_with_their_units() -> None:
    assert describe_building(shear_building()).lines == [
        "Building fig3-I[bodies changed, isolator changed]: 6 bodies, weight 16.68 MN, "
        "1.39 MN on each of 12 supports (equal dead load)",
        "  isolator: radius 2.2 m, no travel stated, supports over 19.32 m along x and 19.32 m along y",
        "  periods on the isolator, without friction: 3.02, 0.311, 0.163, 0.117, 0.0969, 0.0883 s along x; "
        "2.99, 0.157, 0.0819, 0.0585, 0.0485, 0.0442 s along y",
        "  periods above a fixed base: 0.605, 0.207, 0.131, 0.102, 0.0897 s along x; "
        "0.302, 0.104, 0.0657, 0.0511, 0.0448 s along y",
        "  damping of these modes: 1.42, 4.15, 6.55, 8.41, 9.59 % along x and y",
        "  friction: 0.05 at every speed",
        "  peak of the ground: 1.41 m/s^2 = 0.144 g",
    ]


@pytest.mark.parametrize(("difference", "words"), [(0.9e-6, "(equal dead load)"), (1.1e-6, "in the mean (1.39 MN to")])
def test_dead_loads_within_a_millionth_of_their_mean_are_equal(difference: float, words: str) -> None:
    building = describe_building(shear_building())
    assert building.load_per_support is not None
    loads = building.load_per_support * np.array([1.0, 1.0 + difference])
    assert words in replace(building, support_loads=loads).lines[0]


def test_buildings_that_are_alike_are_described_once_with_all_peaks() -> None:
    scene = shear_building()
    scenes = [scene.with_values({"excitation.scale": scale, "name": f"job {scale:g}"}) for scale in (2.0, 4.0, 1.0)]
    stiffer = scene.with_values({"bodies.1.stiffness": [1e9, 1e9], "excitation.scale": 3.0, "name": "other"})
    lines = word_buildings([describe_building(each) for each in (*scenes, stiffer)])
    assert lines[0].startswith("Building job 2, job 4, job 1: 6 bodies")
    assert lines[6] == "  peak of the ground: 1.41 to 5.66 m/s^2 = 0.144 to 0.577 g"
    still = replace(describe_building(scene), ground_peak=0.0)
    assert word_buildings([still, describe_building(scene)])[-1].endswith(": 0 to 1.41 m/s^2 = 0 to 0.144 g")
    assert lines[7].startswith("Building other: 6 bodies")
    assert lines[-1] == "  peak of the ground: 4.24 m/s^2 = 0.432 g"
    assert len(lines) == 14
    kinds = [scene.with_values({"bodies.0.mass": mass, "name": f"{mass:g} kg"}) for mass in (100, 300, 400, 500, 600)]
    ends = {3: "  peak of the ground: 1.41 m/s^2 = 0.144 g", 4: "and 1 more kind of buildings"}
    for count, last in (*ends.items(), (5, "and 2 more kinds of buildings")):
        lines = word_buildings([describe_building(each) for each in kinds[:count]])
        names = [line.split(":")[0] for line in lines if line.startswith("B")]
        assert names == ["Building 100 kg", "Building 300 kg", "Building 400 kg"]
        assert (lines[-1], len(lines)) == (last, 21 + (count > 3))


def test_buildings_that_differ_in_friction_alone_have_a_line_of_it_for_each() -> None:
    scene = shear_building()
    laws = {
        "lower bound": {"slow": 0.03, "fast": 0.06, "rate": 50.0},
        "upper bound": {"slow": 0.045, "fast": 0.09, "rate": 50.0},
        "design": 0.07,
    }
    scenes = [scene.with_values({"isolator.friction": law, "name": name}) for name, law in laws.items()]
    lines = word_buildings([describe_building(each) for each in (*scenes, scenes[0])])
    assert lines[0].startswith("Building lower bound, upper bound, design: 6 bodies")
    assert lines[5:8] == [
        "  friction: 0.03 at rest, 0.06 at high speed, rate 50 s/m (lower bound)",
        "  friction: 0.045 at rest, 0.09 at high speed, rate 50 s/m (upper bound)",
        "  friction: 0.07 at every speed (design)",
    ]
    falling = scene.with_values({"isolator.friction": {"slow": 0.08, "fast": 0.05, "rate": 30.0}})
    said = "  friction: 0.08 at rest, 0.05 at high speed, rate 30 s/m"
    assert said in word_buildings([describe_building(falling)])
    oil = scene.with_values({"isolator.friction": None, "isolator.lubrication": 0.5})
    many = [oil, *(scene.with_values({"isolator.friction": value}) for value in (0.05, 0.02, 0.07))]
    for others, said in (
        ((), "0.02 to 0.07 at every speed; lubrication: 0.5 s/m"),
        (scenes[:1], "0.02 to 0.07 at rest, 0.02 to 0.07 at high speed, rate 0 to 50 s/m; lubrication: 0.5 s/m"),
    ):
        lines = word_buildings([replace(describe_building(each), name="one") for each in (*many, *others)])
        assert lines[5:6] == [f"  friction: {said}"]


def test_a_building_is_said_with_what_may_be_mistyped() -> None:
    heights = {f"bodies.{number}.height": 3.0 * number + 2.85 for number in range(FLOORS + 1)}
    places = [[-14.0, -8.0], [14.0, -8.0], [0.0, 8.0]]
    isolator = {"isolator.travel": 0.4, "isolator.supports": places, "isolator.ring": None}
    building = describe_building(shear_building().with_values({**heights, **isolator}))
    assert building.lines[1:3] == [
        "  isolator: radius 2.2 m, travel 0.4 m, supports over 28 m along x and 16 m along y",
        "  heights above the sliding contact: 0.5, 3.5, 6.5, 9.5, 12.5, 15.5 m",
    ]
    lubricated = {"isolator.friction": None, "isolator.lubrication": 0.5, "isolator.radius": np.inf}
    lines = describe_building(shear_building().with_values(lubricated)).lines
    assert "  lubrication: 0.5 s/m" in lines
    assert lines[1].startswith("  isolator: plane, no travel stated")
