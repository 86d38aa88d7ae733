"""Links of bars in the spatial model: the clamped beam in every direction, under the weight that it carries."""

from typing import Any

import numpy as np
import pytest
from beam_columns import Tower
from scenes_at_hand import assert_agrees_with_newton_and_euler, assert_within, forces_of_links

import multibody
from multibody.integration.engine_run import Budget
from multibody.integration.one_run import PhasePair
from multibody.models.assembly import assemble
from multibody.models.engine import exudyn, items
from multibody.models.links import LINK_COMPLIANCE_RATIO, RigidBodies, add_links
from multibody.models.units import units_of
from reference.problem import Outcome, Scene, load_scene

SIZE = [2.0, 1.6, 0.2]
GAP = 0.3  # m, from the upper ends of the bars to the center of mass
TOWERS = {  # bars, mass above: from nearly no load to nearly buckling
    "a hundredth of the buckling load": ({"count": 4, "bending_stiffness": 60.0, "length": 1.0}, 2.5),
    "half": ({"count": 6, "bending_stiffness": 3.0, "length": 1.3}, 5.4),
    "nine tenths": ({"count": 3, "bending_stiffness": 1.0, "length": 0.8}, 4.25),
    "heavy": ({"count": 4, "bending_stiffness": 2e6, "length": 3.0}, 4e5),
}


def scene_of(name: str, load_effect: str = "softening", **bars: Any) -> Scene:
    stated, mass = TOWERS[name]
    axial = stated["bending_stiffness"] * (60.0 / stated["length"]) ** 2
    own = {"axial_stiffness": axial, "spread": 0.8, "load_effect": load_effect, **stated, **bars}
    above = {"mass": mass, "height": 0.2 + stated["length"] + 2.0 * GAP, "size": SIZE, "bars": own}
    return load_scene("fig3-I").with_values({"duration": 1.0, "bodies.0.mass": mass, "bodies.1": above})


def tower_of(scene: Scene) -> Tower:
    mass, bars = scene.masses[1], scene.bodies[1].bars
    ends = bars.count, bars.bending_stiffness, bars.length, bars.axial_stiffness, bars.spread
    return Tower(*ends, mass, mass / 12.0 * (SIZE[0] ** 2 + SIZE[2] ** 2), GAP)


def on_the_ground(scene: Scene, force: float = 0.0) -> tuple[Any, Any, int]:
    """The body above on its link, whose lower end is fixed, in units of the model; a force along x in weights."""
    units = units_of(scene)
    container = exudyn.SystemContainer()
    mbs = container.AddSystem()
    heights = np.array([body.height for body in scene.bodies]) / units.length
    centers, masses = np.column_stack([np.zeros((2, 2)), heights]), scene.masses / units.mass
    sides = np.square(SIZE) / units.length**2
    inertia = masses[1] / 12.0 * (sides.sum() - sides)
    ground = mbs.AddObject(items.ObjectGround(referencePosition=centers[0]))
    node = mbs.AddNode(items.NodeRigidBodyRxyz(referenceCoordinates=[*centers[1], 0.0, 0.0, 0.0]))
    body = mbs.AddObject(items.ObjectRigidBody(nodeNumber=node, mass=masses[1], inertia=[*inertia, 0.0, 0.0, 0.0]))
    marker = mbs.AddMarker(items.MarkerBodyRigid(bodyNumber=body))
    mbs.AddLoad(items.LoadForceVector(markerNumber=marker, loadVector=[force * masses[1], 0.0, -masses[1]]))
    shear = scene.stiffness[:, :, None] * np.eye(2) * (units.time**2 / units.mass)
    add_links(mbs, scene, units, RigidBodies([ground, body], masses, centers), shear, 0.0 * shear, 1.0)
    mbs.Assemble()
    return container, mbs, node


STATIC = exudyn.SimulationSettings()
STATIC.solution.file.write, STATIC.staticSolver.verboseMode = False, 0
STATIC.staticSolver.newton.relativeTolerance, STATIC.staticSolver.numberOfLoadSteps = 1e-9, 4


@pytest.mark.parametrize("load_effect", ["softening", "shortening"])
@pytest.mark.parametrize("name", TOWERS)
def test_a_body_on_bars_has_the_frequencies_of_beams_under_load(name: str, load_effect: str) -> None:
    scene = scene_of(name, load_effect, torsional_stiffness=0.7)
    _, mbs, _ = on_the_ground(scene)
    values, _ = mbs.ComputeODE2Eigenvalues(STATIC)
    frequencies = np.sqrt(values) / units_of(scene).time
    for expected in tower_of(scene).frequencies():
        assert np.abs(frequencies / expected - 1.0).min() < 1e-5


TENSION = pytest.mark.parametrize("axial", [{}, {"axial_stiffness": 2e4}], ids=["rigid in tension", "clamped beams"])


@TENSION
@pytest.mark.parametrize("own", [{"count": 3, "spread": 0.5}, {"count": 8, "spread": 0.5}, {"count": 8}], ids=str)
def test_every_bar_adds_to_the_stiffness_against_twist(own: dict[str, Any], axial: dict[str, Any]) -> None:
    """n (G J_t / l + s^2 12 E J / l^3), with s of the ring of 1 m if none is stated, against the engine's moment."""
    length, beam, torsion, angle = 0.9, 40.0, 3.0, 1e-4
    bars = {"bending_stiffness": beam, "length": length, "torsional_stiffness": torsion, **own, **axial}
    scene = load_scene("fig3-I").with_values({"bodies.1.period": None, "bodies.1.bars": bars})
    twisted = np.zeros(12)
    twisted[11] = angle
    _, moments, model = forces_of_links(scene, twisted, np.zeros(12))
    unit = model.units.force * model.units.length
    expected = own["count"] * (torsion / length + own.get("spread", 1.0) ** 2 * 12.0 * beam / length**3) * angle
    assert moments[:, 2] * unit == pytest.approx([expected, -expected], rel=1e-5)


@TENSION
def test_a_link_under_an_eccentric_weight_is_straight_at_rest(axial: dict[str, Any]) -> None:
    """It is built to carry the moment of what stands on it: bodies on rigid supports do not lean against each other."""
    offset, bars = [-0.05, 0.08], {"count": 4, "bending_stiffness": 40.0, "length": 0.9, "spread": 0.5, **axial}
    values = {"bodies.1.period": None, "bodies.1.bars": bars, "bodies.1.offset": offset, "isolator.supports": 3}
    scene = load_scene("fig3-I").with_values(values)
    model, level = assemble(scene, "spatial", 1e-3), multibody.levels(scene, "spatial")[0]
    moment = 0.5 * np.hypot(*offset) / scene.radius  # of half of the weight, in weights times rho
    run = PhasePair(scene, model, np.full(2, 0.5 * np.pi)).run_level(level, Budget(1e5), stop=1e-6, keep=True)
    turns = run.chunks[0].coordinates[0][model.bodies + 3]
    # as stiff as a link of rigid bars is in bending, it would lean by ten penetrations
    assert np.abs(turns[1] - turns[0]).max() < 0.01 * LINK_COMPLIANCE_RATIO * level.penetration * moment


BUILDINGS: dict[str, dict[str, Any]] = {
    "without load": {},
    "softened": {"load_effect": "softening"},
    "shortening": {"load_effect": "shortening"},
    "slack bars": {"load_effect": "shortening", "axial_stiffness": 200.0},
    "torsion": {"load_effect": "softening", "spread": 0.3, "torsional_stiffness": 2.0, "axial_stiffness": 2e4},
    # stiff, as the law of a link that leans by 0.1 rad is a convention
    "one bar": {"count": 1, "spread": 0.0, "bending_stiffness": 80.0, "length": 1.2, "axial_stiffness": 1e4},
    "nearly buckling": {"load_effect": "shortening", "bending_stiffness": 0.3},
}
BARS = {"count": 4, "bending_stiffness": 0.8, "length": 1.0, "axial_stiffness": 2900.0, "spread": 0.8}


def building(name: str, **values: Any) -> Scene:
    bars = {"bodies.1.period": None, "bodies.1.bars": {**BARS, **BUILDINGS[name]}}
    return load_scene("fig3-I").with_values({"duration": 2.0, **bars, **values}).with_amplitude(1.5)


def three_stories() -> dict[str, Any]:
    platform, first = building("shortening").bodies
    second = {"mass": 0.5, "height": 2.2, "size": SIZE, "stiffness": [30.0, 20.0]}
    third = {"mass": 0.3, "height": 3.1, "size": SIZE, "bars": {**BARS, "bending_stiffness": 0.3}}
    return {"bodies": [platform, first, second, third]}


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "values"),
    [
        *((name, {}) for name in BUILDINGS),
        ("shortening", {"bodies.1.offset": [0.1, -0.05], "bodies.1.yaw": 0.5}),
        ("softened", three_stories()),
    ],
)
def test_factors_agree_with_newton_euler_equations(name: str, values: dict[str, Any]) -> None:
    assert_agrees_with_newton_and_euler(building(name, **values), (2.0, 0.7))


def test_levels_on_other_springs_show_no_rate_of_convergence() -> None:
    """mu_1 of an independent program, to 4e-5; three levels, of which the first has other springs."""
    engine = multibody.amplification(building("shortening"), [(np.pi / 2.0, np.pi / 2.0)], "spatial")
    assert engine.status[0] == Outcome.OK
    assert abs(engine.mu[0, 0] - 0.92185809) <= engine.error[0, 0]


def test_a_peak_where_supports_stop_has_its_error() -> None:
    """There mu_1 changes by a fifth of the share of the weight that warping takes, four times as much as elsewhere."""
    phase, scene = [(np.pi / 2.0, np.pi / 2.0)], building("shortening", duration=1.4)
    close = multibody.amplification(scene, phase, "spatial", tolerance=1e-4)
    for tolerance in (1e-2, 1e-3):
        assert_within(multibody.amplification(scene, phase, "spatial", tolerance=tolerance), close.mu, close.error)


def test_a_body_on_shortening_bars_sinks_as_they_sway() -> None:
    """At a small load, of bars of 1 m so stiff in tension that nothing else lets it sink."""
    scene = scene_of("a hundredth of the buckling load", "shortening", spread=3.0, axial_stiffness=1e9)
    _, mbs, node = on_the_ground(scene, force=0.5)
    mbs.SolveStatic(STATIC)
    sway, _, sunk, *_ = units_of(scene).length * mbs.GetNodeOutput(node, exudyn.OutputVariableType.Displacement)
    assert sunk == pytest.approx(-0.6 * sway**2, rel=0.01)
