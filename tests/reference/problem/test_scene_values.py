"""What a valid scene says in SI units; files of random bytes, random tables and random valid scenes."""

import json
import math
import tomllib
from unittest import mock

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scene_text import GOOD

from reference.problem import GRAVITY, Scene, SceneError, load_scene, parse_scene

numbers = st.floats(1e-3, 1e3)
pairs = st.lists(numbers, min_size=2, max_size=2)
rows = st.lists(st.floats(-10.0, 10.0), min_size=2, max_size=2)


def one_of_two(first: str, second: str, values: st.SearchStrategy) -> st.SearchStrategy:
    return st.builds(lambda key, value: {key: value}, st.sampled_from([first, second]), values)


def merged(*parts: st.SearchStrategy) -> st.SearchStrategy:
    return st.tuples(*parts).map(lambda tables: {key: value for table in tables for key, value in table.items()})


platforms = st.fixed_dictionaries({"mass": numbers}, optional={"height": numbers})
links = merged(platforms, one_of_two("period", "stiffness", pairs))
scenes = st.fixed_dictionaries(
    {
        "title": st.text(st.characters(codec="utf-8", exclude_categories=["Cc", "Cs"]), max_size=20),
        "duration": numbers,
        "isolator": merged(
            one_of_two("period", "radius", st.floats(1e-2, 1e2)),
            one_of_two("friction", "lubrication", st.floats(0.0, 2.0)),
        ),
        "bodies": st.tuples(platforms, st.lists(links, max_size=4)).map(lambda parts: [parts[0], *parts[1]]),
        "excitation": st.fixed_dictionaries(
            {
                "amplitudes": st.lists(rows, min_size=2, max_size=3),
                "periods": pairs,
                "decay": st.lists(st.floats(0.0, 5.0), min_size=2, max_size=2),
            }
        ),
    }
)


def toml(data: dict) -> str:
    """A scene as TOML; strings and lists of numbers are written alike in JSON."""
    lines = [f"{key} = {json.dumps(data[key], ensure_ascii=False)}" for key in ("title", "duration")]
    tables = [("[isolator]", data["isolator"]), *(("[[bodies]]", body) for body in data["bodies"])]
    for head, table in [*tables, ("[excitation]", data["excitation"])]:
        lines += [head, *(f"{key} = {json.dumps(value)}" for key, value in table.items())]
    return "\n".join(lines)


@given(scenes)
@settings(max_examples=40, deadline=None)
def test_a_valid_scene_goes_through_a_file_and_back_unchanged(data):
    scene = parse_scene(toml(data).encode(), "folder/random.toml")
    direct = Scene.model_validate({**data, "name": "random"})
    assert scene == direct
    assert scene.digest() == direct.digest()
    np.testing.assert_array_equal(scene.masses, [body["mass"] for body in data["bodies"]])
    assert scene.total_mass == pytest.approx(sum(body["mass"] for body in data["bodies"]), rel=1e-14)
    for row, body in zip(scene.stiffness, data["bodies"][1:]):
        given = body.get("stiffness") or [body["mass"] * (2.0 * math.pi / t) ** 2 for t in body["period"]]
        np.testing.assert_allclose(row, given, rtol=1e-14)
    assert scene.radius == pytest.approx(
        data["isolator"].get("radius") or GRAVITY * data["isolator"].get("period", 0.0) ** 2 / (4.0 * math.pi**2),
        rel=1e-14,
    )


@given(st.binary(max_size=300))
@example(b"\x00")
@example(b"title = 1e999999")
@example(b"[" * 5000)
@example(b"duration = " + b"9" * 5000)
def test_any_bytes_are_a_scene_or_a_scene_error(content):
    with pytest.raises(SceneError):  # no bytes this short make a scene
        parse_scene(content, "random")


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
    with mock.patch("reference.problem.scene_file.tomllib.loads", return_value=data):
        told, scene = None, None
        try:
            scene = parse_scene(b"", "random")
        except SceneError as error:
            told = error
    if scene is None:
        assert told is not None
        assert told.rule
        assert "\n" not in str(told)
    else:
        assert np.isfinite(scene.stiffness).all()
        assert math.isfinite(scene.radius)


def test_the_amplitude_override_scales_the_whole_matrix():
    scene = load_scene("fig3-II", amplitude=2.5)
    np.testing.assert_allclose(scene.amplitudes[:2], 2.5, rtol=1e-15)
    assert not scene.amplitudes[2].any()
    assert scene.name == "fig3-II"
    uneven = parse_scene(GOOD.replace("[[1.0, 0.0], [0.0, 1.0]]", "[[0.5, -2.0], [0.0, 1.0]]").encode(), "mine")
    np.testing.assert_allclose(uneven.with_amplitude(1.0).amplitudes[:2], [[0.25, -1.0], [0.0, 0.5]], rtol=1e-15)


def test_the_digest_sees_what_changes_results_and_nothing_else():
    base = parse_scene(GOOD.encode(), "one.toml")
    assert parse_scene(GOOD.encode(), "other.toml").digest() == base.digest()
    assert parse_scene(GOOD.replace("two bodies", "renamed").encode(), "one").digest() == base.digest()
    limits = GOOD.replace("[isolator]", "[acceptance]\nmedian = 1e-3\n[isolator]")
    assert parse_scene(limits.encode(), "one").digest() == base.digest()
    digests = {base.digest()}
    changes = [
        ("duration = 2.0", "duration = 2.1"),
        ("period = 1.0\n", "period = 1.1\n"),
        ("friction = 0.1", "friction = 0.2"),
        ("friction = 0.1", "lubrication = 0.1"),
        ("mass = 3.0", "mass = 3.1"),
        ("[1.5, 1.2]", "[1.5, 1.3]"),
        ("[1.0, 0.0]", "[1.0, 0.1]"),
        ("[0.9, 1.1]", "[0.9, 1.2]"),
        ("[0.3, 0.2]", "[0.3, 0.3]"),
        ("friction = 0.1", "friction = 0.1\nring = 1.0"),
    ]
    for old, new in changes:
        digests.add(parse_scene(GOOD.replace(old, new).encode(), "one").digest())
    assert len(digests) == len(changes) + 1
