"""Stiffness, damping, friction and mass of contacts, supports, spheres and links, by the engine's own forces."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scenes_at_hand import forces_of_engine, forces_of_links

import multibody
from multibody.models.assembly import assemble
from reference.problem import GRAVITY, Scene, load_scene

README = (Path(multibody.__file__).parent / "README.md").read_text(encoding="utf-8")
V_REG, PENETRATION, COMPLIANCE, HEIGHT, RADIUS = 1e-3, 1e-4, 3e-3, 0.7, 0.13
ONE = {"bodies": [{"mass": 3.0, "height": HEIGHT, "size": [2.0, 1.5, 0.3]}], "excitation.scale": 1e-12}
ON_THREE = {**ONE, "isolator.supports": 3, "isolator.ring": 0.8, "isolator.sphere_radius": RADIUS}
PLANE = {"isolator.period": None, "isolator.radius": math.inf}
BEARINGS = {"isolator.support_stiffness": 2e5, "isolator.support_damping": 0.3}
CONTACTS: dict[str, tuple[str, dict[str, Any]]] = {
    "dry": ("fig3-I", {}),
    "plane": ("fig3-I", PLANE),
    "lubricated": ("fig4-viscous", {}),
    "bearings": ("fig3-I", BEARINGS),
    "bearings on a plane": ("fig3-I", {**PLANE, **BEARINGS}),
}


@pytest.mark.parametrize("model", ["translational", "spatial"])
@pytest.mark.parametrize("name", CONTACTS)
def test_contacts_press_damp_and_rub_as_their_law_says(name: str, model: str) -> None:
    """They carry the weight at rest, and twice of it twice as deep; friction acts at the radius above the spheres."""
    base, values = CONTACTS[name]
    scene, turns = load_scene(base).with_values({**ON_THREE, **values}), model == "spatial"
    built = assemble(scene, model, None if scene.lubricated else V_REG)
    built.set_contact(PENETRATION)
    start, unit = built.start(None, np.zeros(3), PENETRATION), built.units
    rest = start.coordinates
    penetration, ratio = PENETRATION, 1.0
    if turns and "bearings" in name:
        penetration, ratio = 3.0 * GRAVITY / (3.0 * 2e5) / unit.length, 0.3
        assert "`isolator.support_stiffness` states the vertical stiffness of one bearing in N/m." in README

    def force(speed: list[float], deeper: float = 0.0) -> Any:
        """Force and moment about the center of mass, of a platform displaced down and with a speed in SI units."""
        velocities, closed = np.zeros(len(rest)), [-1.0, math.hypot(*speed[:2]) / unit.velocity, 0.0, 0.0]
        velocities[:3] = np.array(speed) / unit.velocity
        contact = np.tile(closed, len(built.recorders.contact))
        return forces_of_engine(built, rest - deeper * np.eye(len(rest))[2], velocities, contact)[0]

    np.testing.assert_allclose(force([0.0, 0.0, 0.0]), 0.0, atol=1e-10)
    begun = built.start(None, np.array([0.0, 0.0, 0.3 * GRAVITY]), PENETRATION)
    np.testing.assert_allclose(begun.load, 1.3)
    assert begun.coordinates[2] - rest[2] == pytest.approx(-0.3 * penetration)
    assert force([0.0, 0.0, 0.0], penetration)[2] == pytest.approx(1.0, rel=1e-8)
    critical = 2.0 / math.sqrt(penetration)  # of a mass of one on a spring that gives way by the penetration
    assert force([0.0, 0.0, -1e-3])[2] == pytest.approx(ratio * critical * 1e-3 / unit.velocity, rel=1e-8)
    for size in (0.25 * V_REG, 0.9, 1.1):
        friction = size * scene.friction_coefficient if scene.lubricated else 0.1 * min(size / V_REG, 1.0)
        rubbed = force([0.6 * size, -0.8 * size, 0.0])
        np.testing.assert_allclose(rubbed[:3], [-0.6 * friction, 0.8 * friction, 0.0], atol=1e-6 * friction)
        if turns:
            arm = (HEIGHT if scene.flat else HEIGHT - scene.radius - RADIUS) / unit.length
            moment = [0.8 * arm * friction, 0.6 * arm * friction, 0.0]
            np.testing.assert_allclose(rubbed[3:6], moment, atol=2e-3 * friction * abs(arm))
    if turns:
        built.take_out_open_contacts(np.array([False, True, False]), PENETRATION)
        x, y = scene.support_places[1] / unit.length
        np.testing.assert_allclose(force([0.0, 0.0, 0.0])[2:5], [-1.0 / 3.0, -y / 3.0, x / 3.0], atol=1e-9)


PENTAGON = [[1.0, 0.8], [-0.9, 1.1], [-1.2, -0.7], [0.8, -1.0], [0.1, 0.9]]
YIELDING = {"isolator.friction": {"slow": 0.1, "yield_displacement": 2e-3}}


@pytest.mark.parametrize("friction", [{}, YIELDING], ids=["rigid", "yielding"])
def test_spheres_carry_weight_and_give_way_to_heave_tilt_and_warping(friction: dict[str, Any]) -> None:
    """Each of five as a fifth of the weight says, of which a tenth of the contact's way in heave and tilt."""
    scene = load_scene("fig3-I").with_values({**ONE, "isolator.supports": PENTAGON, "isolator.ring": None, **friction})
    built = assemble(scene, "spatial", V_REG)
    built.set_contact(PENETRATION, COMPLIANCE)
    size, vertical = built.coordinates, built.depressions.vertical
    heave_and_tilt, _ = np.linalg.qr(np.insert(np.array(PENTAGON), 0, 1.0, axis=1))
    warping = np.linalg.svd(heave_and_tilt.T)[2][3:].T
    is_open, zero = np.tile([1.0, 0.0, 0.0, 0.0], 5), np.zeros(size)
    start = built.start(None, np.array([0.0, 0.0, 0.3 * GRAVITY]), PENETRATION)  # pressed by 1.3 of the weight
    begun, _ = forces_of_engine(built, start.coordinates, zero, np.tile([-1.0, 0.0, 0.0, 0.0], 5))
    np.testing.assert_allclose(begun[[2, *vertical]], [0.3, *[0.0] * 5], atol=1e-9)
    weight, mass = forces_of_engine(built, zero, zero, is_open)
    np.testing.assert_allclose(weight[vertical], 0.2)
    np.testing.assert_allclose(mass[vertical][:, vertical], 0.01 / 5 * np.eye(5))
    for patterns, way in ((heave_and_tilt, 0.1 * PENETRATION), (warping, COMPLIANCE)):
        for pattern in patterns.T:
            moved = zero.copy()
            moved[vertical] = pattern
            pushed, damped = (
                forces_of_engine(built, *state, is_open)[0][vertical] - 0.2
                for state in ((1e-3 * moved, zero), (zero, 1e-3 * moved))
            )
            np.testing.assert_allclose(pushed, -0.2e-3 / way * pattern, atol=1e-9 / way)
            # critical for a fifth of the mass
            np.testing.assert_allclose(damped, -0.4e-3 / math.sqrt(way) * pattern, atol=1e-9 / way)
            displacement = built.warping_displacement(np.array([zero, moved]))
            expected = np.abs(pattern).max() if way == COMPLIANCE else 0.0
            np.testing.assert_allclose(displacement, [0.0, expected], atol=1e-12)


@pytest.mark.parametrize(("model", "count"), [("translational", 1), ("spatial", 3), ("spatial", 5)])
def test_spheres_that_turn_hold_their_share_of_the_initial_stiffness(model: str, count: int) -> None:
    """Of mu m g / u_y at the surface of each; along the plate their centers stay."""
    on = {"isolator.supports": 3} if count < 5 else {"isolator.supports": PENTAGON, "isolator.ring": None}
    scene = load_scene("fig3-I").with_values({**ONE, **on, **YIELDING, "isolator.sphere_radius": RADIUS})
    built = assemble(scene, model, V_REG)
    built.set_contact(PENETRATION)
    radius, zero = RADIUS / built.units.length if model == "spatial" else 1.0, np.zeros(built.coordinates)
    spring, inertia = 0.1 / (2e-3 / built.units.length) * radius**2 / count, 1e-9 * radius**2 / count
    is_open = np.tile([1.0, 0.0, 0.0, 0.0], count)
    for place in (6 * sphere + axis for sphere in range(1, count + 1) for axis in (0, 1, 3, 4, 5)):
        moved = 1e-6 * np.eye(len(zero))[place]
        (pushed, mass), (damped, _) = (
            forces_of_engine(built, *state, is_open) for state in ((moved, zero), (zero, moved))
        )
        found = [-1e6 * pushed[place], -1e6 * damped[place], mass[place, place]]
        np.testing.assert_allclose(found, [spring, 0.0, inertia] if place % 6 > 2 else [1e10, 2e9, 1e8])


SIZE = [2.0, 1.5, 0.3]
BARS = {"count": 4, "bending_stiffness": 8.0, "length": 0.9, "axial_stiffness": 3e3, "spread": 0.8}
BARS["torsional_stiffness"] = 2.0
ABOVE = {"mass": 2.0, "height": 1.2, "size": SIZE, "damping": 0.4}
PLATFORM = {"mass": 3.0, "height": 0.4, "size": [1.0, 1.2, 0.3]}


def tower(bars: dict[str, Any] | None = None, **more: Any) -> Scene:
    """Two bodies on a link, and a third on a link that is stiff in tension and bending."""
    link = {"stiffness": [60.0, 90.0]} if bars is None else {"bars": {**BARS, **bars}}
    top = {"mass": 0.7, "height": 2.1, "size": [1.1, 0.9, 0.2], "stiffness": [30.0, 20.0]}
    values = {"bodies": [PLATFORM, {**ABOVE, **link, **more}, top], "isolator.supports": 3}
    return load_scene("fig3-I").with_values(values)


def connectors_of(built: Any) -> list[dict[str, Any]]:
    """The connectors of the links as the engine has them."""
    built.set_contact(PENETRATION)
    found = map(built.mbs.GetObject, range(built.mbs.systemData.NumberOfObjects()))
    return [item for item in found if item["objectType"] == "ConnectorRigidBodySpringDamper"]


def test_stiff_links_are_ten_times_softer_than_contacts_and_damped_critically() -> None:
    """As the mass above them vibrates; bars of their own stiffness have no such damper, and no share in its times."""
    for scene, own in ((tower(), [True, True]), (tower({}), [False, True])):
        built = assemble(scene, "spatial", V_REG)
        times = built.bar_damping_times(PENETRATION)
        for connector, stiff, lag, carried in zip(connectors_of(built), own, times, (2.7 / 5.7, 0.7 / 5.7)):
            if not stiff:
                assert lag == 0.0
                continue
            stiffness, damping = (np.diag(connector[key])[2:] for key in ("stiffness", "damping"))
            np.testing.assert_allclose(stiffness[:3], 0.1 / PENETRATION)
            np.testing.assert_allclose(damping, [*[2.0 * math.sqrt(carried * 0.1 / PENETRATION)] * 3, 0.0])
            assert lag == pytest.approx(damping[0] / stiffness[0])
            assert connector["offset"][2] == pytest.approx(carried / stiffness[0])
    stiffest, _ = connectors_of(assemble(tower({"axial_stiffness": 1e12}), "spatial", V_REG))
    np.testing.assert_array_equal(np.diag(stiffest["stiffness"])[2:5], 1e7)


def test_rods_of_bars_that_shorten_are_damped_as_the_bars_in_shear() -> None:
    """Damping over stiffness is that of shear under the weight, where the scene states it."""
    scene, velocities = tower({"load_effect": "shortening"}), np.zeros((3, 6))
    velocities[1:, 2] = 1e-3
    (begin, *_), (end, _, model) = (
        forces_of_links(scene, np.zeros(18), each) for each in (np.zeros(18), velocities.ravel())
    )
    expected = 1e-3 * scene.damping[0, 0] / scene.stiffness[0, 0] * scene.bar_links[0].tension
    assert (end - begin)[0, 2] * model.units.mass / model.units.time == pytest.approx(expected, rel=1e-8)


FASTEST: dict[str, tuple[dict[str, Any], list[float]]] = {
    "tension": ({"axial_stiffness": 1e6, "spread": 0.0}, SIZE),
    "twist": ({"spread": 0.0, "axial_stiffness": 1.0, "torsional_stiffness": 1e3}, SIZE),
    "turning about x": ({"bending_stiffness": 4e3, "axial_stiffness": 1.0}, [9.0, 0.2, 0.3]),
    "turning about y": ({"bending_stiffness": 4e3, "axial_stiffness": 1.0}, [0.2, 9.0, 0.3]),
}


@pytest.mark.parametrize("name", FASTEST)
def test_the_fastest_motion_on_bars_is_that_of_two_free_bodies(name: str) -> None:
    """Eigenvalues of the link's stiffness times the inverse masses that its ends feel, half a distance away."""
    bars, size = FASTEST[name]
    scene = tower(bars, size=size)
    link, found, gives = scene.bar_links[0], assemble(scene, "spatial", V_REG), (1.0 / scene.masses[:2]).sum()
    squares = np.array([np.square(body.size) for body in scene.bodies[:2]])
    turns = 12.0 / scene.masses[:2, None] / (squares.sum(axis=1)[:, None] - squares)
    fastest = [link.tension * gives, link.torsion * turns[:, 2].sum()]
    for below, above in turns.T[:2]:
        coupled = 0.4 * (below - above)
        response = [[gives + 0.16 * (below + above), coupled], [coupled, below + above]]
        fastest.append(np.linalg.eigvals(np.diag([link.shear, link.bending]) @ response).real.max())
    assert [*FASTEST][int(np.argmax(fastest))] == name
    assert found.fastest_bar_frequency / found.units.time == pytest.approx(math.sqrt(max(fastest)), rel=1e-6)
