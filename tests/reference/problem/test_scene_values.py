"""What a valid scene says in SI units; files of random bytes, random tables and random valid scenes."""

import math
import tomllib
from dataclasses import fields
from unittest import mock

import numpy as np
import pytest
from chains import refusal
from hypothesis import example, given, settings
from hypothesis import strategies as st

from reference.measures import Demands
from reference.measures.peak_demands import PER_BODY
from reference.measures.peak_demands import QUANTITIES as DEMANDS
from reference.problem import GRAVITY, Scene, SceneError, load_scene, parse_scene
from reference.problem.acceptance import Acceptance
from reference.problem.measured import BODY_QUANTITIES, QUANTITIES
from reference.problem.scene_file import scene_text
from reference.problem.supports import are_on_one_line

FIG3 = load_scene("fig3-I")
TEXT = scene_text("fig3-I").decode().replace("mass = 1.0\nperiod", "mass = 3.0\nperiod")


def test_a_scene_of_a_file_is_that_of_its_table_in_si_units():
    data = tomllib.loads(TEXT)
    scene = parse_scene(TEXT.replace(FIG3.title, "é%$").encode(), "folder/mine.toml")
    direct = Scene.model_validate({**data, "title": "é%$", "name": "mine"})
    assert (scene, scene.digest()) == (direct, direct.digest())
    assert (scene.masses.tolist(), scene.total_mass) == ([1.0, 3.0], 4.0)
    assert scene.radius == pytest.approx(GRAVITY / (4.0 * math.pi**2), rel=1e-14)
    stiffness = [[3.0 * (2.0 * math.pi / 1.5) ** 2, 3.0 * (2.0 * math.pi / 1.2) ** 2]]
    np.testing.assert_allclose(scene.stiffness, stiffness, rtol=1e-14)
    wide = {"isolator.period": None, "isolator.radius": 0.3}
    stiff = scene.with_values({"bodies.1.period": None, "bodies.1.stiffness": [17.0, 19.0], **wide})
    assert (stiff.stiffness.tolist(), stiff.radius) == ([[17.0, 19.0]], 0.3)
    uneven = scene.with_values({"excitation.amplitudes": [[0.5, -2.0], [0.0, 1.0]]}).with_amplitude(1.0)
    np.testing.assert_allclose(uneven.amplitudes, [[0.25, -1.0], [0.0, 0.5], [0.0, 0.0]], rtol=1e-15)
    assert load_scene("fig3-II", amplitude=2.5).amplitudes.max() == pytest.approx(2.5, rel=1e-15)


anything = st.recursive(
    st.one_of(st.booleans(), st.integers(), st.floats(), st.text(max_size=5), st.dates(), st.times()),
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=5), inner, max_size=4)),
    max_leaves=8,
)


PLACES = (
    "title duration isolator isolator.period isolator.friction isolator.supports bodies bodies.0 bodies.0.mass"
    " bodies.0.offset bodies.1 bodies.1.yaw bodies.1.period bodies.1.period.0 excitation excitation.amplitudes"
    " excitation.amplitudes.1 excitation.periods.1 excitation.decay acceptance name surprise"
)


@example(place="bodies.0", value={"\n": False})
@given(place=st.sampled_from(PLACES.split()), value=anything)
@settings(max_examples=120, deadline=None)
@example(place="isolator.period", value=1e200)
@example(place="bodies.1.period.0", value=1e-300)
@example(place="duration", value=10**400)
@example(place="bodies.0.mass", value=5e-324)
def test_any_value_in_any_place_is_a_scene_or_a_scene_error(place, value):
    data = table = tomllib.loads(TEXT)
    *way, last = (int(key) if key.isdigit() else key for key in place.split("."))
    for key in way:
        table = table[key]
    table[last] = value
    with mock.patch("reference.problem.scene_file.tomllib.loads", return_value=data):
        try:
            scene, told = parse_scene(b"", "random"), None
        except SceneError as error:
            scene, told = FIG3, error
    assert np.isfinite([*scene.stiffness.ravel(), scene.radius]).all()
    assert told is None or (told.rule and "\n" not in str(told))


def test_the_digest_sees_what_changes_results_and_nothing_else():
    for same in (
        {"title": "renamed", "name": "other"},
        {"acceptance.median": 1e-3},
        {"analyses": {"skip": ["a"]}},
        {"bodies.1.floor": "roof"},
    ):
        assert FIG3.with_values(same).digest() == FIG3.digest()
    changes = {"duration": 20.1, "isolator.friction": 0.2, "bodies.0.mass": 1.1, "bodies.1.period.1": 1.3}
    changes |= {"isolator.period": 1.1, "isolator.ring": 1.1, "excitation.amplitudes.0.1": 0.1}
    changes |= {"excitation.periods.1": 1.2, "excitation.decay.0": 0.3}
    changes |= {"bodies.1.damping": 0.1, "bodies.0.height": 0.9, "bodies.1.size": [1.0, 1.0, 0.7]}
    changes |= {"bodies.0.offset": [0.1, 0.0], "bodies.1.yaw": 0.2, "excitation.scale": 1.1, "isolator.travel": 0.1}
    changes |= {"isolator.supports": 5, "isolator.sphere_radius": 0.03, "isolator.support_stiffness": 1e4}
    changes |= {"isolator.restitution": 0.4, "superstructure": {"damping": 0.02}}
    digests = {FIG3.with_values({key: value}).digest() for key, value in changes.items()}
    oil = FIG3.with_values({"isolator.friction": None, "isolator.lubrication": 0.1})
    assert len(digests | {FIG3.digest(), oil.digest()}) == len(changes) + 2


def test_supports_and_centers_of_mass_at_stated_places() -> None:
    """Their mean square distance from the axis; the place of the center is weighed by mass, and named in the line."""
    places = [[1.0, 0.5], [-1.0, 0.5], [0.0, -1.0]]
    uneven = {"isolator.ring": None, "isolator.supports": places, "bodies.0.mass": 3.0}
    scene = FIG3.with_values({**uneven, "bodies.0.offset": [0.1, -0.2], "bodies.1.offset": [0.3, 0.0]})
    assert scene.support_radius == pytest.approx(math.sqrt((1.25 + 1.25 + 1.0) / 3.0))
    np.testing.assert_allclose(scene.center_of_mass, [0.15, -0.15])
    assert FIG3.support_radius == FIG3.isolator.ring
    said = refusal(scene.with_values, {"bodies.1.offset": [4.0, 0.0]}, kind=SceneError)
    assert said.rule.startswith("the support at [-1, 0.5] would carry nothing at rest")
    np.testing.assert_allclose(said.value, [1.075, -0.15])


PEAKS = """
[[measured]]
quantity = "base_shear"
value = 3.0
uncertainty = 0.2
phases = [0.0, 1.5]
source = "run 7"
[[measured]]
quantity = "mu"
body = 1
value = 2.0
uncertainty = 0.1
phases = [0.0, 1.5]
"""


def test_a_file_states_measured_peaks_which_change_no_digest() -> None:
    assert set(QUANTITIES) - {"mu"} <= set(DEMANDS) & {field.name for field in fields(Demands)}
    assert {name: first - 1 for name, first in BODY_QUANTITIES.items() if name != "mu"} == PER_BODY
    scene = parse_scene((TEXT + PEAKS).encode(), "rig.toml")
    peak, other = scene.measured or ()
    assert (peak.quantity, peak.body, peak.value, peak.source) == ("base_shear", None, 3.0, "run 7")
    assert (other.body, other.uncertainty, other.phases) == (1, 0.1, [0.0, 1.5])
    assert Scene.model_validate(scene.model_dump(exclude_none=True)) == scene
    plain = scene.with_values({"measured": None})
    assert (plain.measured, plain.digest()) == (None, scene.digest())
    peak = {"quantity": "mu", "body": 1, "value": 2.3, "uncertainty": 0.1}
    pair = load_scene("synthetic-pair")
    assert pair.with_values({"measured": [peak]}).measured[0].phases is None
    said = refusal(pair.with_values, {"measured": [{**peak, "phases": [0.3, 1.1]}]})
    assert (said.key, said.rule) == ("measured.0.phases", "a record has no phases: remove it")


def test_supports_beside_the_axis_may_be_on_one_line() -> None:
    line = np.array([[2.0, 1.0], [3.0, 1.5], [7.0, 3.5]])
    assert are_on_one_line(line)
    assert are_on_one_line(line + np.array([0.7, -4.0]))
    assert not are_on_one_line(line + np.array([[0.0, 0.0], [0.0, 0.1], [0.0, 0.0]]))


def test_a_limit_on_closure_alone_allows_no_point_without_an_answer() -> None:
    assert Acceptance(closure=1e-9).allowed_failures == 0
    assert Acceptance(closure=1e-9, failed=3).allowed_failures == 3
    assert Acceptance().allowed_failures is None


def test_the_largest_acceleration_of_a_record_may_be_the_vertical_one() -> None:
    samples = [[0.0, 1.0, -2.0, 0.0], [1.0, 0.0, 1.0, -4.0]]
    shaken = load_scene("synthetic-pair").with_values({"excitation": {"record": "own", "samples": samples}})
    assert shaken.largest_acceleration == 4.0
