"""Values that no scene may hold, or that are hardly meant: one line for each, with scene, key, value and rule."""

from typing import Any

import numpy as np
import pytest
from chains import refusal

from reference import plausibility
from reference.building import describe_building, word_force
from reference.plausibility import implausible_drift, implausible_suite
from reference.problem import Scene, SceneError, load_scene
from reference.records.description import RecordDescription, describe_samples
from reference.support.arguments import quote

PEAK = {"quantity": "mu", "body": 2, "value": 2.3, "uncertainty": 0.1, "phases": [0.3, 1.1]}
BARS = {"count": 4, "bending_stiffness": 0.8, "length": 1.0}
WARM = {"contact_radius": 0.02, "conductivity": 0.02, "diffusivity": 1e-3}
HOT = {**WARM, "initial_temperature": 500.0}


def implausible_values(scene: Scene) -> list[str]:
    return plausibility.implausible_values(scene, describe_building(scene))


def law(**table: object) -> dict[str, Any]:
    return {"isolator.friction": {"slow": 0.1, **table}}


def places(*supports: list[float]) -> dict[str, Any]:
    return {"isolator.ring": None, "isolator.supports": list(supports)}


def measured(**changes: object) -> dict[str, Any]:
    return {"measured": [{key: value for key, value in {**PEAK, **changes}.items() if value is not None}]}


def bars(**changes: object) -> dict[str, Any]:
    return {"duration": 3.0, "bodies.1.period": None, "bodies.1.bars": {**BARS, **changes}}


# values of fig3-I by key, the key that the line names, and words of its rule
WRONG: list[tuple[dict[str, Any], str, str]] = [
    ({"isolator.frictoin": 0.1}, "isolator.frictoin", "unknown key; did you mean friction?"),
    ({"isolator.bearings": 12}, "isolator.bearings", "unknown key; did you mean supports?"),
    ({"bodies.1.colour": 0.1}, "bodies.1.colour", "unknown key; the keys here are mass, period, stiffness"),
    ({"acceptance.maximun": 0.1}, "acceptance.maximun", "unknown key; did you mean maximum?"),
    ({"acceptance.mine.closure": 0.1}, "acceptance.mine.closure", "unknown key; the keys here are median, maximum"),
    ({"acceptance.my engine.ratio": 0.1}, "acceptance.my engine", "the name of an engine: letters, digits and -"),
    ({"bodies.2.mass": 0.1}, "bodies.2.mass", "bodies has the indices 0 to 1"),
    ({"isolator.friction.slow": 0.1}, "isolator.friction.slow", "isolator.friction is 0.1 and no table: give isolator"),
    ({"": 0.1}, "", "unknown key; the keys here are title, duration"),
    ({".".join(["a"] * 5000): 0.1}, "a", "unknown key"),
    ({"isolator.friction": "0.1"}, "isolator.friction", "must be a valid number"),
    ({"excitation.periods.0": None}, "excitation.periods.0", "must be a number"),
    ({"excitation.record": "a.csv"}, "excitation.amplitudes", "a record takes the place of amplitudes, periods and"),
    ({"excitation.record": "a.csv", "excitation.amplitudes": None}, "excitation.periods", "a record takes the place"),
    (
        {"excitation": {"record": "a.csv", "decay": [0.3, 0.3]}},
        "excitation.decay",
        "a record takes the place of amplitudes",
    ),
    ({"excitation.amplitudes.0.0": 1e308, "excitation.scale": 1e10}, "excitation.scale", "leave every acceleration fi"),
    ({"title": "a\0b"}, "title", "must have no control characters"),
    ({"title": "a\ud800b"}, "title", "must have no control characters"),
    ({"duration": 10**400}, "duration", "must be a valid number"),
    ({"duration": 1e9, "excitation.periods": [3.0, 2.0]}, "duration", "must be at most 1e+06 periods of 1 s"),
    *(
        (
            {"duration": 1e9, "excitation.periods": periods},
            "duration",
            "1e+06 periods of 0.2 s, the shortest of loading a",
        )
        for periods in ([0.3, 0.2], [0.2, 0.3])
    ),
    ({"duration": None}, "duration", "this key is required"),
    ({"acceptance.median": -1.0}, "acceptance.median", "must be greater than 0"),
    ({"superstructure": 0.05}, "superstructure", "must be a table of keys"),
    ({"superstructure.damping": 3.0}, "superstructure.damping", "from 0 to 1: percent? Write 0.05 for 5 %"),
    # isolator
    ({"isolator": 3.0}, "isolator", "must be a table of keys"),
    ({"isolator.friction": None}, "isolator", "exactly one of friction and lubrication"),
    ({"isolator.lubrication": 0.1}, "isolator", "exactly one of friction and lubrication"),
    ({"isolator.period": None}, "isolator", "exactly one of period and radius"),
    ({"isolator.radius": 0.3}, "isolator", "exactly one of period and radius"),
    ({"isolator.period": 1e200}, "isolator.period", "finite and positive"),
    (law(slow=0.0, fast=0.2, rate=50.0), "isolator.friction.slow", "greater than 0"),
    (law(fast=0.2, rat=50.0), "isolator.friction.rat", "did you mean rate"),
    ({"isolator.supports": 2}, "isolator.supports", "equal to 3"),
    (places([0, 1], [1, 0]), "isolator.supports", "at least 3"),
    ({"isolator.supports": [[0, 1], [1, -1], [-1, -1]]}, "isolator.ring", "remove this key"),
    (places([0, 1], [1, 0], [1, 1e7]), "isolator.supports.2.1", "to 1e+06 m"),
    (places([0.1, 0.1], [0.2, 0.2], [0.3, 0.3]), "isolator.supports", "on one line"),
    (places([0.1, 0.1], [0.2, 0.2], [0.3, 0.3 + 1e-8]), "isolator.supports", "on one line"),
    (places([0, 1], [1, -1], [0, 1]), "isolator.supports", "at the same place"),
    (places([1, 1], [2, 1], [1, 2]), "bodies: center of mass of all [x, y] in m", "would carry nothing at rest"),
    (law(), "isolator.friction", "give fast and rate, load_exponent, heating or initial_stiffness"),
    (law(initial_stiffness=1e4, yield_displacement=1e-3), "isolator.friction", "the other follows: remove one of them"),
    (
        law(initial_stiffness=1e4, heating=WARM),
        "isolator.friction",
        "heating is that of rigid friction: remove it",
    ),
    (law(yield_displacement=0.0), "isolator.friction.yield_displacement", "must be greater than 0"),
    (law(initial_stiffness=1e-3), "isolator.friction: yield_displacement = 1962.", "from 1e-12 to 1000 m"),
    (law(fast=0.2), "isolator.friction", "give fast and rate together, or neither"),
    (law(fast=0.2, rate=1.0, reference_load=9.0), "isolator.friction", "reference_load belongs to a load_exponent"),
    (law(load_exponent=2.0), "isolator.friction.load_exponent", "must be finite, from -0.5 to 1"),
    (
        law(load_exponent=1.0, reference_load=1e16),
        "isolator.friction: under the weight",
        "positive, from 1e-09 to 1000",
    ),
    (law(heating=HOT), "isolator.friction.heating.initial_temperature", "from -50 to 300 degrees C"),
    ({"isolator.travel": 0.3}, "isolator.travel", "must be below the radius, rho = 0.24849 m"),
    ({"isolator.support_damping": 0.5}, "isolator.support_damping", "damps supports with a support_stiffness"),
    ({"isolator.support_stiffness": 1e4, "isolator.restitution": 0.5}, "isolator.restitution", "rebound by it: remove"),
    # 19.62 N on four supports: each sinks by 0.0249 m, just above a tenth of the radius
    ({"isolator.support_stiffness": 197.0}, "isolator.support_stiffness", "gives way by 0.1 of the radius under the"),
    # one support in place of an unknown number
    (
        {"isolator.supports": None, "isolator.support_stiffness": 400.0},
        "isolator.support_stiffness",
        "gives way by 0.197 of the radius under the weight: must be at most 0.1",
    ),
    # bodies and links
    ({"bodies.0.mass": 6e14, "bodies.1.mass": 7e14}, "bodies: total mass in kg = 1300000000000000.0", "to 1e+15 kg"),
    (
        {"bodies.1.mass": 4.0, "bodies.1.period": None, "bodies.1.stiffness": [1e3, 1e-20]},
        "bodies.1: period along y in s = 125663706143",
        "from 1e-07 to 1e+09 s",
    ),
    ({"bodies.0.mass": 1e308, "bodies.1.mass": 1e308}, "bodies.0.mass", "finite and positive"),
    ({"bodies.1.yaw": 45.0}, "bodies.1.yaw", "rad"),
    ({"bodies.0.stiffness": [1.0, 1.0]}, "bodies.0.stiffness", "platform"),
    ({"bodies.0.bars": BARS}, "bodies.0.bars", "platform"),
    ({"bodies.0.period": [1.0, 1.0]}, "bodies.0.period", "platform"),
    ({"bodies.1.period": None}, "bodies.1", "exactly one of period, stiffness and bars"),
    ({"bodies.1.stiffness": [1.0, 1.0]}, "bodies.1", "exactly one of period, stiffness and bars"),
    ({"bodies.1.period.0": 1e-200}, "bodies.1.period.0", "finite and positive"),
    (bars(count=4.5), "bodies.1.bars.count", "int"),
    ({"bodies.1.stiffness": 6e8}, "bodies.1.stiffness", "must be [kx, ky], N/m"),
    ({"bodies.1.period": 3.0}, "bodies.1.period", "must be [Tx, Ty], s"),
    ({"bodies.0.damping": 0.05}, "bodies.0.damping", "the platform has no link below: remove this key"),
    ({"bodies.1.damping": -0.1}, "bodies.1.damping", "must be finite, from 0 to 100"),
    ({"bodies.1.damping": [1.0]}, "bodies.1.damping", "must be a ratio of critical, or [cx, cy] in N s/m"),
    ({"bodies.1.damping": [1.0, -2.0]}, "bodies.1.damping.1", "must be finite, from 0 to 1e+30 N s/m"),
    # c / (2 m w), w = 2 pi / 1.2 s and 4 kg above the link: 110 along y
    ({"bodies.1.mass": 4.0, "bodies.1.damping": [1.0, 4608.0]}, "bodies.1: damping ratio along y = 110.00", "0 to 100"),
    (bars(load_effect="shortening"), "bodies.1.bars", "load_effect 'shortening' needs axial_stiffness"),
    (bars(axial_stiffness=1e9, spread=0.5, count=2), "bodies.1.bars", "axial_stiffness needs 3 bars or more around"),
    (bars(axial_stiffness=1e9, count=1), "bodies.1.bars", "state more, or spread = 0"),
    (bars(load_effect="buckling"), "bodies.1.bars.load_effect", "must be 'softening' or 'shortening'"),
    (bars(axial_stiffness=10.0, count=2), "bodies.1.bars", "axial_stiffness needs 3 bars or more around the axis"),
    # measured peaks
    (measured(quantity="base_sheer", body=None), "measured.0.quantity", "did you mean base_shear?"),
    (measured(quantity="base_shear"), "measured.0", "base_shear is of the isolator: remove body"),
    (measured(body=None), "measured.0", "mu needs the number of a body, 1 or more"),
    (measured(quantity="drift", body=1), "measured.0", "drift needs the number of a body, 2 or more"),
    (measured(body=3), "measured.0.body", "the scene has 2 bodies, the platform is 1"),
    (measured(value=float("nan")), "measured.0.value", "must be a finite number"),
    (measured(phases=None), "measured.0.phases", "give the phases of the test, [alpha1, alpha2]"),
]


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"bodies.1.period": None, "bodies.1.stiffness": [9.5e8]},
         "bodies.1.stiffness = [950000000.0]: must be [kx, ky], N/m; this list has 1 (bodies.1 is body 2)"),
        ({"bodies.1.size": [1.0, 2.0]},
         "bodies.1.size = [1.0, 2.0]: must be [x, y, z], m; this list has 2 (bodies.1 is body 2)"),
        ({"isolator.supports": [[1.0, 2.0]]},
         "isolator.supports = [[1.0, 2.0]]: must be a list of at least 3; this list has 1"),
        ({"excitation.periods": [1.0, 2.0, 3.0]},
         "excitation.periods = [1.0, 2.0, 3.0]: must be a list of at most 2; this list has 3"),
    ],
)  # fmt: skip
def test_a_list_of_another_length_is_one_line_with_its_form(values: dict[str, Any], said: str) -> None:
    assert str(refusal(load_scene("fig3-I").with_values, values, kind=SceneError)) == f"fig3-I: {said}"


@pytest.mark.parametrize(("values", "key", "rule"), WRONG)
def test_a_wrong_value_is_one_line_with_scene_key_value_and_rule(values: dict[str, Any], key: str, rule: str) -> None:
    said = refusal(load_scene("fig3-I").with_values, values, kind=SceneError)
    value = "" if rule == "this key is required" else f" = {quote(said.value)}"
    assert str(said).startswith(f"fig3-I: {key if ' = ' in key else f'{key}{value}: '}")
    assert rule in said.rule
    assert len(str(said)) < 700


BODIES = [{"mass": 1e3}, {"mass": 1e3, "stiffness": [4e5, 4e5]}]
STIFF, ALONG_X = ({"mass": 1e3, "stiffness": stiffness} for stiffness in ([1.6e6, 4e5], [4e5, 1.6e6]))
MODE = (
    "the damping of mode 2 along {} above a fixed base is {} % of critical, above 20 %: it moves {} % of the mass; is "
    "this meant?"
)
FALLING = {
    "bodies": [
        {**BODIES[0], "height": 3.0},
        {**BODIES[1], "height": 6.0},
        {**BODIES[1], "height": 5.0, "floor": "roof"},
        {**BODIES[1], "height": 5.0},
    ]
}
FALLS = '"roof" at 5 m is not above body 2 at 6 m, the body below it: bodies stand in the file from the platform up'
LEVEL = {**FALLING["bodies"][2], "height": 6.0}
LONG = {"isolator.radius": None, "isolator.period": 150.0}
HEAVY = {"bodies.0.mass": 1e9, "bodies.1.mass": 1e9, "bodies.1.stiffness": [4e11, 4e11]}
LIGHT = {"bodies.0.mass": 20.0, "bodies.1.mass": 20.0, "bodies.1.stiffness": [8e3, 8e3]}
STRONG = {"excitation.amplitudes": [[40.0, 0.0], [0.0, 1.0]]}
DAMPED = "the damping of the first mode above a fixed base is {} % of critical, above 20 %: percent?"
PERIOD = "the period above a fixed base is {}: stiffness in N/m, mass in kg?"
MASS = "the mass of {} is {} kg, {} times the mean of the others, {}: kg in one place and t in another?"
ROOF = {"mass": 9.0, "stiffness": [4e4, 4e4], "floor": "roof"}
DIFFERENT = {"isolator.friction": {"slow": 0.03, "fast": 0.06, "rate": 50.0}}
SWAPPED = "friction falls with the speed, from 0.06 at rest to 0.03: slow and fast swapped?"
WIDE = places([-8e3, -14e3], [8e3, -14e3], [8e3, 14e3], [-8e3, 14e3])
SIZED = {"isolator.ring": 2.0, "isolator.sphere_radius": 0.1, "bodies.0.size": [4.0, 5.0, 6.0]}
APART = "the supports stand {} m apart, more than twice the platform of 5 m: are places and size both in m?"
BELOW = (
    "the center of mass of body 1 lies 1.7 m below the sliding contact: height counts from the centers of the "
    "depressions. Where yours count from the contact, add R = 2.3 m to every height: 2.9 for 0.6 m above the contact"
)
LOAD = "the weight on each support is {}: is mass in kg?"


@pytest.mark.parametrize(
    ("values", "lines"),
    [
        ({}, []),
        ({"superstructure.damping": 0.25}, [DAMPED.format(25)]),
        ({"bodies.1.damping": 1.5}, [DAMPED.format(150)]),
        ({"bodies.1.stiffness": [1.0, 4e8]}, [PERIOD.format("198.7 s, above 5 s")]),
        ({"bodies.1.stiffness": [4e5, 4e8]}, [PERIOD.format("0.009935 s, below 0.05 s")]),
        (LONG, ["the radius of the isolator is 5591 m, above 50 m: is period in s?"]),
        ({"isolator.radius": 2200.0}, ["the radius of the isolator is 2200 m, above 50 m: mm?"]),
        ({"isolator.radius": float("inf")}, []),
        ({"isolator.friction": {"slow": 5.0, "fast": 0.06, "rate": 50.0}}, ["the friction coefficient is 5: percent?"]),
        ({"bodies.0.mass": 9e4}, []),
        ({"bodies.0.mass": 1.1e5}, [MASS.format("body 1", "1.1e+05", "1.1e+02", "above 100")]),
        ({"bodies": [*BODIES, ROOF]}, [MASS.format('"roof"', "9", "0.009", "below 0.01")]),
        (DIFFERENT | {"isolator.friction.rate": 0.05}, ["the rate of friction is 0.05 s/m, below 1 s/m: s/mm?"]),
        (DIFFERENT, []),
        ({"isolator.friction": None, "isolator.lubrication": 5.0}, []),
        ({"isolator.friction": {"slow": 0.06, "fast": 0.03, "rate": 50.0}}, [SWAPPED]),
        (WIDE, ["the supports stand 2.8e+04 m apart, above 300 m: mm?"]),
        (SIZED | {"isolator.ring": 6.0}, []),
        (SIZED | {"isolator.ring": 8.0}, [APART.format("11.31")]),
        (SIZED | {"bodies.0.height": 2.7, "bodies.1.height": 6.0}, []),
        (SIZED | {"bodies.0.height": 0.6, "bodies.1.height": 4.0}, [BELOW]),
        (SIZED | {"bodies.0.height": 0.6, "bodies.1.height": 4.0, "isolator.radius": float("inf")}, []),
        (HEAVY, [LOAD.format("4905 MN, above 100 MN")]),
        (LIGHT, [LOAD.format("98.1 N, below 1 kN")]),
        (LIGHT | {"isolator.supports": None}, []),
        ({"bodies": [*BODIES, STIFF], "superstructure.damping": 0.08}, [MODE.format("y", "20.94", "5.3")]),
        ({"bodies": [*BODIES, ALONG_X], "superstructure.damping": 0.08}, [MODE.format("x", "20.94", "5.3")]),
        ({"bodies": [*BODIES, STIFF], "superstructure.damping": 0.076}, []),
        (FALLING, [FALLS]),
        ({"bodies": [*FALLING["bodies"][:2], LEVEL]}, [FALLS.replace("5 m", "6 m")]),
        (STRONG, ["the peak of the ground is 4.079 g, above 3 g: unit or scale?"]),
    ],
)
def test_what_is_hardly_meant_is_one_line(values: dict[str, Any], lines: list[str]) -> None:
    given = {"bodies": BODIES, "isolator": {"radius": 2.2, "friction": 0.05, "supports": 4}}
    assert implausible_values(load_scene("fig3-I").with_values(given).with_values(values)) == lines


@pytest.mark.parametrize(("peak", "scale", "warns"), [(5.0, 8.0, True), (5.0, 4.0, False), (35.0, 1.0, False)])
def test_a_record_is_hardly_meant_if_its_scale_makes_it_too_large(peak: float, scale: float, warns: bool) -> None:
    """Beyond 3 g; whatever is beyond it as read, its own description tells."""
    samples = [[0.0, 0.0, 0.0, 0.0], [0.1, peak, 0.0, 0.0], [0.3, -peak, 0.0, 0.0], [0.4, 0.0, 0.0, 0.0]]
    shaken = {"excitation": {"record": "own.csv", "samples": samples, "scale": scale}, "duration": 0.4}
    lines = implausible_values(load_scene("fig3-I").with_values(shaken))
    assert [line for line in lines if "unit or scale?" in line] == [
        f"the peak of the ground is {peak * scale / 9.81:.4g} g, above 3 g: unit or scale?"
    ][: int(warns)]


def test_masses_in_two_units_are_one_line_and_unit_masses_none() -> None:
    scene = load_scene("fig3-I")
    assert implausible_values(scene) == [], "the cases of the paper have masses of 1 kg"
    spread = scene.with_values({"bodies.0.mass": 1e6, "isolator.supports": None})
    assert implausible_values(spread) == [MASS.format("body 1", "1e+06", "1e+06", "above 100")]


def test_a_peak_of_the_ground_is_hardly_meant_by_its_scale_where_the_record_is_not() -> None:
    pair = load_scene("synthetic-pair")
    assert implausible_values(pair.with_values({"excitation.scale": 20.0})) == [
        "the peak of the ground is 5.101 g, above 3 g: unit or scale?"
    ]
    in_another_unit = pair.with_values({"excitation.record": {"time": [0.0, 1.0], "acceleration": [0.0, 40.0]}})
    assert implausible_values(in_another_unit) == [], "said where the record is described"


def test_limits_that_always_hold_are_hardly_meant() -> None:
    scene, key = load_scene("fig3-I"), "acceptance.demands"
    assert implausible_values(scene.with_values({key: {"displacement": 0.24, "drift_ratio": 0.1}})) == []
    assert implausible_values(scene.with_values({key: {"displacement": 0.25, "drift_ratio": 0.11}})) == [
        "the limit on the displacement is 0.25 m, above the radius of the isolator: mm?",
        "the limit on the drift ratio is 0.11, above 0.1: percent?",
    ]


def test_limits_that_are_never_met_are_hardly_meant() -> None:
    scene, key = load_scene("fig3-I").with_values({"bodies": BODIES, "isolator.supports": 4}), "acceptance.demands"
    load = describe_building(scene).load_per_support
    assert load is not None
    assert implausible_values(scene.with_values({key: {"support_force_max": 1.001 * load, "acceleration": 1.0}})) == []
    (line,) = implausible_values(scene.with_values({key: {"support_force_max": 0.9 * load}}))
    assert line.endswith(f"N, below the dead load of {word_force(load)}: kN? Write {900 * load:g}")
    (line,) = implausible_values(scene.with_values({key: {"support_force_max": 9e-4 * load}}))
    assert line.endswith(f"N, below the dead load of {word_force(load)}"), "in kN, too"
    uneven = scene.with_values(places([4.0, 3.0], [-4.0, 3.0], [-4.0, -3.0], [4.0, -3.0], [4.0, 0.0]))
    (line,) = implausible_values(uneven.with_values({key: {"support_force_max": 1e3}}))
    most = describe_building(uneven).support_loads.max()
    assert f"below the dead load of {word_force(most)}: kN? Write" in line
    assert implausible_values(scene.with_values({key: {"acceleration": 0.4}})) == [
        "the limit on the acceleration is 0.4 m/s^2, below 1 m/s^2: g? Write 3.924"
    ]
    assert implausible_values(load_scene("fig3-I").with_values({key: {"acceleration": 0.4}})) == [], "unit masses"


def test_dead_loads_far_from_equal_are_hardly_meant() -> None:
    corners = [[4.0, 3.0], [-4.0, 3.0], [-4.0, -3.0], [4.0, -3.0], [4.0, 0.0], [-4.0, 0.0]]
    scene = load_scene("fig3-I").with_values({"bodies": BODIES, **places(*corners)})
    assert implausible_values(scene) == []
    assert implausible_values(scene.with_values(places(*corners[:5]))) == []  # 1.27 times
    # 19.62 kN, a half of it 3 and 0.6 m off: 3.27 kN (1 -+ 1.5 x 4 / 16 times 1.5 -+ 0.3 x 3 / 6 times 1)
    assert implausible_values(scene.with_values({"bodies.1.offset": [3.0, -0.6]})) == [
        "the dead loads of the supports go from 1.553 kN on support 2 at [-4, 3] m to 4.987 kN on support 4 at [4, -3] "
        "m, as the center of mass is [1.5, -0.3] m off their middle: is a support missing, or an offset of a body too "
        "large?"
    ]
    (line,) = implausible_values(scene.with_values(places(*corners[1:4], [1.0, 1.0])))
    assert line.endswith("as the center of mass is [0.75, 0.5] m off their middle: is a support missing?")


def test_motions_unlike_the_others_of_their_suite_are_hardly_meant() -> None:
    wave = np.sin(np.arange(200.0))

    def motion(title: str, x: float, y: float = 0.0, scale: float = 1.0) -> RecordDescription:
        columns = [0.01 * np.arange(200.0), x * wave, y * wave[::-1], 0.0 * wave]
        return describe_samples(title, (), np.column_stack(columns), scale)

    suite = [motion(name, 4.0, 3.0) for name in "abc"]
    assert implausible_suite([*suite, motion("d", 1.0, 0.9, scale=0.85), motion("e", 0.1, 0.1, scale=20.0)]) == []
    assert implausible_suite([motion("d", 4.0), *suite]) == [
        "d has x alone, the 3 others have x and y: is a file left out?"
    ]
    assert implausible_suite([motion("d", 0.0), *suite, motion("e", 0.0, 4.0), motion("f", 4.0)]) == [
        "d has no acceleration, the 3 others have x and y: is a file left out?",
        "e has y alone, the 3 others have x and y: is a file left out?",
        "f has x alone, the 3 others have x and y: is a file left out?",
    ]
    assert implausible_suite([*suite, motion("d", 4.0), motion("e", 4.0)]) == [
        "d, e have x alone each, the 3 others have x and y: is a file left out?"
    ]
    assert implausible_suite([motion("a", 4.0), motion("b", 4.0, 3.0)]) == [
        "a has x alone, the other has x and y: is a file left out?"
    ]
    assert implausible_suite([motion("a", 4.0), motion("b", 4.0), motion("c", 4.0, 3.0)]) == [], "most have one"
    (line,) = implausible_suite([*suite, motion("d", 1.0, 0.9, scale=0.75)])
    assert line.startswith("the peak of d is 0.0765 g, below a fifth of the median of the suite, 0.408 g: unit?")
    same = describe_samples("a", (), np.column_stack([0.01 * np.arange(200.0), wave, wave, wave]))
    assert "x and y have the same samples: one file for both?" in same.warnings


def test_a_drift_above_a_tenth_of_the_height_is_hardly_meant() -> None:
    assert implausible_drift(0.1, "below body 2") == ""
    assert implausible_drift(0.236, "below body 2").startswith("the drift below body 2 is 23.6 % of the height")
