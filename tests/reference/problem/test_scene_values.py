"""What a valid scene says in SI units; files of random bytes, random tables and random valid scenes."""

import json
import math
import tomllib
from dataclasses import fields
from unittest import mock

import numpy as np
import pytest
from chains import refusal
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scene_text import GOOD, edited

from reference.measures import Demands
from reference.measures.peak_demands import PER_BODY
from reference.measures.peak_demands import QUANTITIES as DEMANDS
from reference.problem import GRAVITY, Scene, SceneError, load_scene, parse_scene
from reference.problem.measured import OF_BODIES, QUANTITIES

FIG3 = load_scene("fig3-I")


def random_table(rng: np.random.Generator) -> dict:
    """A scene of up to five bodies as a file has it."""

    def number() -> float:
        return float(10.0 ** rng.uniform(-2.0, 2.0))

    bodies = [{"mass": number()}]
    for _ in range(rng.integers(5)):
        bodies.append({"mass": number(), str(rng.choice(["period", "stiffness"])): [number(), number()]})
    loading = {"amplitudes": rng.uniform(-9.0, 9.0, (rng.integers(2, 4), 2)).tolist()}
    loading |= {"periods": [number(), number()], "decay": [number(), number()]}
    geometry, law = str(rng.choice(["period", "radius"])), str(rng.choice(["friction", "lubrication"]))
    isolator = {geometry: number(), law: number()}
    return {"title": "é%$", "duration": number(), "isolator": isolator, "bodies": bodies, "excitation": loading}


def toml(data: dict) -> str:
    """A scene as TOML; strings and lists of numbers are written alike in JSON."""
    lines = [f"{key} = {json.dumps(data[key], ensure_ascii=False)}" for key in ("title", "duration")]
    tables = [("[isolator]", data["isolator"]), *(("[[bodies]]", body) for body in data["bodies"])]
    for head, table in [*tables, ("[excitation]", data["excitation"])]:
        lines += [head, *(f"{key} = {json.dumps(value)}" for key, value in table.items())]
    return "\n".join(lines)


@pytest.mark.parametrize("seed", range(30))
def test_a_valid_scene_goes_through_a_file_and_back_unchanged(seed):
    data = random_table(np.random.default_rng(seed))
    scene = parse_scene(toml(data).encode(), "folder/random.toml")
    direct = Scene.model_validate({**data, "name": "random"})
    assert scene == direct
    assert scene.digest() == direct.digest()
    np.testing.assert_array_equal(scene.masses, [body["mass"] for body in data["bodies"]])
    assert scene.total_mass == pytest.approx(sum(body["mass"] for body in data["bodies"]), rel=1e-14)
    for row, body in zip(scene.stiffness, data["bodies"][1:]):
        given = body.get("stiffness") or [body["mass"] * (2.0 * math.pi / t) ** 2 for t in body["period"]]
        np.testing.assert_allclose(row, given, rtol=1e-14)
    period = data["isolator"].get("period", 0.0)
    radius = data["isolator"].get("radius") or GRAVITY * period**2 / (4.0 * math.pi**2)
    assert scene.radius == pytest.approx(radius, rel=1e-14)


anything = st.recursive(
    st.one_of(st.booleans(), st.integers(), st.floats(), st.text(max_size=5), st.dates(), st.times()),
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=5), inner, max_size=4)),
    max_leaves=8,
)


def put(data: object, path: str, value: object) -> None:
    *way, last = (int(key) if key.isdigit() else key for key in path.split("."))
    for key in way:
        data = data[key]
    data[last] = value


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
    data = tomllib.loads(GOOD)
    put(data, place, value)
    told = scene = None
    with mock.patch("reference.problem.scene_file.tomllib.loads", return_value=data):
        try:
            scene = parse_scene(b"", "random")
        except SceneError as error:
            told = error
    if scene is None:
        assert told.rule
        assert "\n" not in str(told)
    else:
        assert np.isfinite([*scene.stiffness.ravel(), scene.radius]).all()


def test_the_amplitude_override_scales_the_whole_matrix():
    scene = load_scene("fig3-II", amplitude=2.5)
    np.testing.assert_allclose(scene.amplitudes[:2], 2.5, rtol=1e-15)
    assert not scene.amplitudes[2].any()
    assert scene.name == "fig3-II"
    uneven = parse_scene(GOOD.replace("[[1.0, 0.0], [0.0, 1.0]]", "[[0.5, -2.0], [0.0, 1.0]]").encode(), "mine")
    np.testing.assert_allclose(uneven.with_amplitude(1.0).amplitudes[:2], [[0.25, -1.0], [0.0, 0.5]], rtol=1e-15)


def test_the_digest_sees_what_changes_results_and_nothing_else():
    base = parse_scene(GOOD.encode(), "one.toml")
    limits = "[isolator] -> [acceptance]\nmedian = 1e-3\n[analyses]\nskip = ['a']\n[isolator]"
    for same in ("mass = 3.0", 'title = "renamed"', limits):
        assert parse_scene(edited(same).encode(), "other.toml").digest() == base.digest()
    changes = ["duration = 2.1", "friction = 0.2", "friction = 0.1 -> lubrication = 0.1", "mass = 3.1", "period = 1.1"]
    changes += ["period = [1.5, 1.2] -> period = [1.5, 1.3]", "amplitudes = [[1.0, 0.1], [0.0, 1.0]]"]
    changes += ["periods = [0.9, 1.2]", "decay = [0.3, 0.3]", "friction = 0.1\nring = 1.0"]
    digests = {parse_scene(edited(change).encode(), "one").digest() for change in changes}
    assert len(digests | {base.digest()}) == len(changes) + 1


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


PEAKS = b"""title = "rig"
duration = 2.0
isolator = {period = 1.0, friction = 0.1}
bodies = [{mass = 1.0}]
excitation = {amplitudes = [[1.0, 0.0], [0.0, 1.0]], periods = [0.9, 1.1], decay = [0.3, 0.3]}
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


def test_every_quantity_is_mu_or_a_demand() -> None:
    assert set(QUANTITIES) - {"mu"} <= set(DEMANDS) & {field.name for field in fields(Demands)}
    assert {name: first - 1 for name, first in OF_BODIES.items() if name != "mu"} == PER_BODY


def test_a_file_states_measured_peaks_which_change_no_digest() -> None:
    scene = parse_scene(PEAKS, "rig.toml")
    peak, other = scene.measured or ()
    assert (peak.quantity, peak.body, peak.value, peak.source) == ("base_shear", None, 3.0, "run 7")
    assert (other.body, other.uncertainty, other.phases) == (1, 0.1, [0.0, 1.5])
    assert Scene.model_validate(scene.model_dump(exclude_none=True)) == scene
    plain = scene.with_values({"measured": None})
    assert (plain.measured, plain.digest()) == (None, scene.digest())
    assert scene.with_values({"measured.0.value": 2.5}).measured[0].value == 2.5  # type: ignore[index]


def test_a_record_has_no_phases() -> None:
    peak = {"quantity": "mu", "body": 1, "value": 2.3, "uncertainty": 0.1}
    pair = load_scene("synthetic-pair")
    assert pair.with_values({"measured": [peak]}).measured[0].phases is None  # type: ignore[index]
    said = refusal(pair.with_values, {"measured": [{**peak, "phases": [0.3, 1.1]}]})
    assert (said.key, said.rule) == ("measured.0.phases", "a record has no phases: remove it")
