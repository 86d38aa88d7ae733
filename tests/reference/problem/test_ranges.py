"""Every quantity and argument has a range: inside it is an answer or a named outcome, outside it one line."""

import math
import runpy
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

import numpy as np
import pytest
from chains import refusal

import multibody
import reference
from reference.problem import Outcome, SceneError, load_scene
from reference.problem.keys import Table
from reference.problem.ranges import REGULARIZATION_RANGE
from reference.problem.scene import KEYS, Scene
from reference.support.arguments import Range
from reference.surface import prepare_run

FIG3 = load_scene("fig3-I")
PHASES = [(0.1, 0.2)]
HEATING = {"contact_radius": 0.2, "conductivity": 18.0, "diffusivity": 4.4e-6}
BARS = {"count": 4, "bending_stiffness": 1.0, "length": 1.0}
PEAK = {"quantity": "mu", "body": 1, "value": 2.0, "uncertainty": 0.1, "phases": [0.0, 0.0]}
BASES: dict[str, dict[str, Any]] = {  # by the first of its keys that a quantity begins with: what it excludes or needs
    "isolator.radius": {"isolator.period": None},
    "isolator.lubrication": {"isolator.friction": None},
    "isolator.friction.": {"isolator.friction": {"slow": 0.03, "fast": 0.06, "rate": 100.0, "heating": HEATING}},
    "bodies.bars.": {"bodies.1.period": None, "bodies.1.bars": BARS},
    "bodies.stiffness": {"bodies.1.period": None, "bodies.1.stiffness": [1.0, 1.0]},
    "bodies.offset": {"bodies.1.offset": [0.0, 0.0]},
    "measured.": {"measured": [PEAK]},
}
PLACES = {  # of lists: where the value is put
    "bodies.period": ".1", "bodies.stiffness": ".1", "bodies.offset": ".1", "bodies.size": ".2",
    "excitation.amplitudes": ".1.0", "excitation.periods": ".1", "excitation.decay": ".1", "measured.phases": ".1",
}  # fmt: skip


def test_the_page_of_keys_is_what_the_schema_says() -> None:
    docs = Path(__file__).parents[3] / "docs"
    made = runpy.run_path(str(docs / "scene_keys.py"))["page"]()
    assert (docs / "scene.md").read_text(encoding="utf-8") == made, "run: python docs/scene_keys.py"


def tables_in(kind: Any) -> Iterator[type[Table]]:
    """Iterate over the tables that an annotation names."""
    if isinstance(kind, type) and issubclass(kind, Table):
        yield kind
    for part in get_args(kind):
        yield from tables_in(part)


def ranges_in(table: type[Table], start: str = "") -> Iterator[tuple[str, Range]]:
    """Iterate over the keys of a table and of the tables in it, with the ranges of their numbers."""
    for name, field in table.model_fields.items():
        said = field.json_schema_extra
        if isinstance(said, dict) and "range" in said:
            yield start + name, Range(*said["range"])
        for inner in tables_in(field.annotation):
            yield from ranges_in(inner, f"{start}{name}.")


SCENE = dict(ranges_in(Scene))


def test_a_range_is_said_with_unit_and_hint_and_holds_its_ends() -> None:
    positive, signed, hinted = Range(0.25, 3e6, "m"), Range(-2.0, 40.0), Range(0.0, 1.0, "s", hint="percent?")
    endless = Range(0.5, 7.0, "m", or_infinite=True)
    assert [each.rule for each in (positive, signed, hinted, endless)] == [
        "must be finite and positive, from 0.25 to 3e+06 m",
        "must be finite, from -2 to 40",
        "must be finite, from 0 to 1 s: percent?",
        "must be positive, from 0.5 to 7 m, or inf",
    ]
    assert [each.text for each in (signed, endless)] == ["-2 to 40", "0.5 to 7, or inf"]
    for each in (positive, endless):
        inside = [value in each for value in (each.lowest, each.highest, math.inf, -math.inf, math.nan)]
        assert inside == [True, True, each.or_infinite, False, False]
        assert not any(math.nextafter(*way) in each for way in ((each.lowest, 0.0), (each.highest, 1e9)))


def test_every_number_of_a_scene_has_a_range() -> None:
    tables = {
        name: name
        for name in (
            "isolator",
            "isolator.friction",
            "isolator.friction.heating",
            "bodies",
            "superstructure",
            "measured",
            "acceptance.demands",
        )
    }
    tables |= {"bodies.bars": "bodies.bars", "excitation": "excitation.two frequencies"}
    numbers = {"duration", *(f"{name}.{key}" for name, table in tables.items() for key in KEYS[table])}
    unbounded = {"bodies.bars", "bodies.bars.load_effect", "measured.quantity", "measured.source"}
    unbounded |= {"isolator.friction.heating", "excitation.scale", "bodies.floor", "acceptance.demands.statistic"}
    assert numbers - unbounded == set(SCENE), "a scale is bounded by the accelerations that it makes"


@pytest.mark.parametrize("key", SCENE)
def test_a_quantity_beyond_its_range_is_refused_with_the_range(key: str) -> None:
    whole = key.endswith(("supports", "count", "measured.body"))
    base = next((values for start, values in BASES.items() if key.startswith(start)), {})
    place = key.replace("bodies.", "bodies.1.").replace("measured.", "measured.0.") + PLACES.get(key, "")
    for edge, beyond in ((SCENE[key].lowest, -math.inf), (SCENE[key].highest, math.inf)):
        outside = edge + math.copysign(1, beyond) if whole else math.nextafter(edge, beyond)
        said = refusal(FIG3.with_values, {**base, place: int(outside) if whole else outside}, kind=SceneError)
        assert said.key == place
        assert any(f"{number:g}" in said.rule for number in (SCENE[key].lowest, SCENE[key].highest))


MASKED = np.ma.masked_array([(0.1, 0.2)], mask=[(True, False)])
ASKED: dict[str, list[Any]] = {
    "regularization": [0.0, -1e-3, math.inf, "1e-3"],
    "tolerance": [math.nan, None, "1e-3", True, 0.2, 1e-11],
    "phases": [None, [["0.1", "0.2"]], [(0.1, None)], [(0.1,), (0.1, 0.2)], [(0.1, 0.2j)], [(1e17, 0.2)], MASKED],
}
ASKED["phases"].append([(0.1, np.ma.masked)])


@pytest.mark.parametrize("kind", [list, tuple])
def test_masked_phases_are_refused_in_lists_and_tuples(kind: Any) -> None:
    row = np.ma.masked_array([0.1, 0.2], mask=[True, False])
    for phases in (kind([row]), kind([kind([0.1, 0.2]), row]), [kind([0.1, np.ma.masked])]):
        assert "masked" in str(refusal(reference.amplification, FIG3, phases))


@pytest.mark.parametrize("side", [reference, multibody])
def test_an_argument_outside_its_rules_is_one_line(side: Any) -> None:
    for name, values in ASKED.items():
        for value in values:
            line = str(refusal(side.amplification, FIG3, **{"phases": PHASES, name: value}))
            assert line.startswith(name)
            assert "must" in line
    kind, choices = ("equations", "exact, small") if side is reference else ("model", "spatial, translational")
    for value in (None, {}, ["exact"], 3, "linear"):
        line = str(refusal(side.amplification, FIG3, PHASES, **{kind: value}))
        assert line.startswith(f"{kind} = ")
        assert line.endswith(f"must be one of {choices}")
    for phase in ("0.1", None, {}, (1e17, 0.0), MASKED[0]):
        assert str(refusal(side.trajectory, FIG3, phase)).startswith("phase")


def test_an_argument_of_the_equations_outside_its_rules_is_one_line() -> None:
    for times in ([1.0, 0.5], [1.0, 1.0], [0.0, 21.0], [-1.0, 0.0], [[0.0, 1.0]], [np.nan]):
        assert str(refusal(reference.trajectory, FIG3, PHASES[0], times=times)).startswith("times: ")
    assert str(refusal(reference.amplification, FIG3, PHASES, rest_condition=3)).startswith("rest_condition = 3: ")
    for cutoff, v_reg in ((0.0, None), (1e-3, 1e-3)):
        line = str(refusal(reference.amplification, FIG3, PHASES, cutoff=cutoff, regularization=v_reg))
        assert line.startswith(f"cutoff = {cutoff}")


STILL, FAST, FAR = np.zeros((2, 2)), np.array([[0.0, 2e9], [0.0, 0.0]]), np.array([[0.0, 0.0], [-2e12, 0.0]])


@pytest.mark.parametrize(
    ("initial", "said"),
    [
        (3, "initial = 3: must be a reference.problem.State"),
        (reference.State(np.ma.masked_array(STILL, mask=True), STILL), "initial: has masked entries"),
        (reference.State("here", STILL), "initial = 'here': must be numbers"),  # type: ignore[arg-type]
        (reference.State(STILL[:1], STILL), "initial: must have finite position and velocity of shape (2, 2)"),
        (reference.State(STILL, STILL[:1]), "initial: must have finite position and velocity of shape (2, 2)"),
        (reference.State(STILL + 0.2, STILL), "initial: the platform must start inside the rim (4.1), rho = 0.24849 m"),
        (reference.State(FAR, STILL), "initial: -2e+12: must be finite, from -1e+12 to 1e+12 m"),
        (reference.State(STILL, FAST), "initial: 2e+09: must be finite, from -1e+09 to 1e+09 m/s"),
    ],
)
def test_a_state_that_is_none_is_refused_by_both_sides(initial: Any, said: str) -> None:
    for side in (reference, multibody):
        assert str(refusal(side.trajectory, FIG3, (0.1, 0.2), initial=initial)).startswith(said)


@pytest.mark.parametrize("function", [reference.amplification, multibody.amplification])
def test_both_sides_answer_a_phase_of_many_turns_like_the_phase(function):
    scene = load_scene("fig3-I").with_values({"duration": 0.5})
    many, one = (function(scene, [(first, 1.1)]) for first in (0.3 + 2.0 * np.pi * 1e5, 0.3))
    np.testing.assert_allclose(many.mu, one.mu, rtol=1e-8)


def test_the_ends_of_the_range_of_v_reg_are_answered_right() -> None:
    """At the lower end like the set-valued law, at the upper end like no friction."""
    scene = load_scene("fig4-dry")
    for v_reg, limit in (
        (REGULARIZATION_RANGE.lowest, scene),
        (REGULARIZATION_RANGE.highest, scene.with_values({"isolator.friction": 0.0})),
    ):
        found = reference.amplification(scene, PHASES, regularization=v_reg)
        assert found.status[0] == Outcome.OK
        np.testing.assert_allclose(found.mu, reference.amplification(limit, PHASES).mu, rtol=2e-6)


def test_a_ground_whose_squares_lose_digits_is_at_rest() -> None:
    for amplitude, outcome in ((1e-145, Outcome.NO_GROUND_MOTION), (1e-138, Outcome.OK)):
        assert reference.amplification(FIG3.with_amplitude(amplitude), PHASES, "small").status[0] == outcome, amplitude


def test_a_loading_without_decay_is_refused_after_so_many_steps_and_not_hours_later() -> None:
    scene = load_scene("fig3-I").with_values({"duration": 8e5, "excitation.decay": [0.0, 0.0]})
    _, demand = prepare_run(scene, "exact", None, 1e-6, None, "consistent")
    assert demand.step_limit < 0.01 * (1000.0 * scene.duration / 0.9)
