"""Every rule of the scene file: broken, it is one SceneError on one line with file, key, value and rule."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest
from scene_text import GOOD, edited

from reference.problem import Scene, SceneError, builtin_scenes, load_scene, parse_scene

# name: (line of the good file, what replaces it, key, value, words of the rule)
BROKEN = {
    "unknown key": ("duration = 2.0", "duration = 2.0\ncolour = 3", "colour", 3, "unknown key"),
    "unknown table": ("[isolator]", "[solver]\nstep = 1\n[isolator]", "solver", {"step": 1}, "unknown key"),
    "name": ("duration = 2.0", 'duration = 2.0\nname = "x"', "name", "x", "named after its file"),
    "no duration": ("duration = 2.0", "", "duration", None, "required"),
    "no mass": ("mass = 3.0", "", "bodies.0.mass", None, "required"),
    "duration text": ("duration = 2.0", 'duration = "2"', "duration", "2", "number"),
    "duration zero": ("duration = 2.0", "duration = 0.0", "duration", 0.0, "greater than 0"),
    "duration nan": ("duration = 2.0", "duration = nan", "duration", None, "finite"),
    "friction negative": ("friction = 0.1", "friction = -0.1", "isolator.friction", -0.1, "greater than or equal to 0"),
    "friction of the velocity without its rate": (
        "friction = 0.1",
        "friction = {slow = 0.1, fast = 0.2}",
        "isolator.friction",
        None,
        "give fast and rate together, or neither",
    ),
    "friction of the velocity without hold": (
        "friction = 0.1",
        "friction = {slow = 0.0, fast = 0.2, rate = 50.0}",
        "isolator.friction.slow",
        0.0,
        "greater than 0",
    ),
    "friction of the velocity with an unknown key": (
        "friction = 0.1",
        "friction = {slow = 0.1, fast = 0.2, rat = 50.0}",
        "isolator.friction.rat",
        50.0,
        "did you mean rate",
    ),
    "neither friction": ("friction = 0.1", "", "isolator", {"period": 1.0}, "exactly one of friction and lubrication"),
    "both frictions": (
        "friction = 0.1",
        "friction = 0.1\nlubrication = 0.2",
        "isolator",
        None,
        "exactly one of friction",
    ),
    "neither radius": ("period = 1.0", "", "isolator", {"friction": 0.1}, "exactly one of period and radius"),
    "both radii": ("period = 1.0", "period = 1.0\nradius = 0.3", "isolator", None, "exactly one of period and radius"),
    "two supports": ("[isolator]", "[isolator]\nsupports = 2", "isolator.supports", 2, "equal to 3"),
    "two positions": ("[isolator]", "[isolator]\nsupports = [[0, 1], [1, 0]]", "isolator.supports", None, "3 items"),
    "position far away": (
        "[isolator]",
        "[isolator]\nsupports = [[0, 1], [1, 0], [1, 1e7]]",
        "isolator.supports.2.1",
        1e7,
        "to 1e+06 m",
    ),
    "positions with a ring": (
        "[isolator]",
        "[isolator]\nring = 1.0\nsupports = [[0, 1], [1, -1], [-1, -1]]",
        "isolator.ring",
        1.0,
        "remove this key",
    ),
    "positions on one line": (
        "[isolator]",
        "[isolator]\nsupports = [[0.1, 0.1], [0.2, 0.2], [0.3, 0.3]]",
        "isolator.supports",
        None,
        "on one line",
    ),
    "a position twice": (
        "[isolator]",
        "[isolator]\nsupports = [[0, 1], [1, -1], [-1, -1], [0, 1]]",
        "isolator.supports",
        None,
        "at the same place",
    ),
    "positions beside the axis": (
        "[isolator]",
        "[isolator]\nsupports = [[1, 1], [2, 1], [1, 2]]",
        "bodies: center of mass of all [x, y] in m",
        [0.0, 0.0],
        "would carry nothing at rest",
    ),
    "yaw in degrees": ("mass = 1.0", "mass = 1.0\nyaw = 45.0", "bodies.1.yaw", 45.0, "rad"),
    "link period of one": ("period = [1.5, 1.2]", "period = [1.5]", "bodies.1.period", [1.5], "2 items"),
    "one row": ("[[1.0, 0.0], [0.0, 1.0]]", "[[1.0, 0.0]]", "excitation.amplitudes", [[1.0, 0.0]], "2 items"),
    "decay negative": ("decay = [0.3, 0.2]", "decay = [0.3, -0.2]", "excitation.decay.1", -0.2, "equal to 0"),
    "limit negative": ("[isolator]", "[acceptance]\nmedian = -1.0\n[isolator]", "acceptance.median", -1.0, "greater"),
    "broken TOML": ("[isolator]", "[isolator", "file", None, "valid TOML"),
    "key twice": ("duration = 2.0", "duration = 2.0\nduration = 3.0", "file", None, "valid TOML"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_a_broken_rule_is_one_line_with_file_key_value_and_rule(case):
    old, new, key, value, rule = BROKEN[case]
    with pytest.raises(SceneError) as caught:
        parse_scene(edited(old, new).encode(), "folder/mine.toml")
    error = caught.value
    assert error.key == key
    assert value is None or error.value == value
    assert rule in error.rule
    assert str(error).startswith(f"folder/mine.toml: {key} = ")
    assert str(error).endswith(error.rule)
    assert "\n" not in str(error)


@pytest.mark.parametrize(
    ("old", "new", "key", "rule"),
    [
        ("mass = 3.0", "mass = 3.0\nperiod = [1.0, 1.0]", "bodies.0", "platform"),
        ("mass = 3.0", "mass = 3.0\nstiffness = [1.0, 1.0]", "bodies.0", "platform"),
        ("period = [1.5, 1.2]", "", "bodies.1", "exactly one of period, stiffness and bars"),
        ("period = [1.5, 1.2]", "period = [1.5, 1.2]\nstiffness = [1.0, 1.0]", "bodies.1", "exactly one of period"),
        ("mass = 3.0", "mass = 3.0\nbars = {count = 4, bending_stiffness = 1.0, length = 1.0}", "bodies.0", "platform"),
        ("period = [1.5, 1.2]", "bars = {count = 4, bending_stiffness = 1.0}", "bodies.1.bars.length", "required"),
        ("period = [1.5, 1.2]", "bars = {count = 4.5, bending_stiffness = 1.0, length = 1.0}", "bodies.1.bars", "int"),
    ],
)
def test_a_wrong_link_names_its_body(old, new, key, rule):
    with pytest.raises(SceneError) as caught:
        parse_scene(edited(old, new).encode(), "mine.toml")
    assert caught.value.key.startswith(key)
    assert rule in caught.value.rule
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("period = 1.0\n", "period = 1e200\n"),
        ("period = 1.0\n", "period = 1e-200\n"),
        ("period = [1.5, 1.2]", "period = [1e-200, 1.2]"),
        ("period = [1.5, 1.2]", "period = [1e200, 1.2]"),
        ("mass = 3.0\n\n[[bodies]]\nmass = 1.0", "mass = 1e308\n\n[[bodies]]\nmass = 1e308"),
    ],
)
def test_values_that_overflow_in_si_units_are_refused(old, new):
    with pytest.raises(SceneError, match="finite and positive"):
        parse_scene(edited(old, new).encode(), "mine.toml")


def test_no_bodies_is_refused():
    text = GOOD.replace("[[bodies]]\nmass = 3.0\n\n[[bodies]]\nmass = 1.0\nperiod = [1.5, 1.2]\n", "")
    with pytest.raises(SceneError, match=r"mine\.toml: bodies = None: this key is required"):
        parse_scene(text.encode(), "mine.toml")
    with pytest.raises(SceneError, match="bodies = "):
        parse_scene(("bodies = []\n" + text).encode(), "mine.toml")


def test_bytes_that_are_not_utf8_are_refused():
    with pytest.raises(SceneError, match=r"mine: file = .*valid TOML in UTF-8"):
        parse_scene(b"\xff\xfe title", "mine")


@pytest.mark.parametrize("source", ["/does/not/exist.toml", "fig9", "", "no\0path", "x" * 5000])
def test_a_file_that_cannot_be_read_names_the_built_in_scenes(source):
    with pytest.raises(SceneError, match="fig3-I, fig3-II, fig4-dry, fig4-viscous") as caught:
        load_scene(source)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("amplitude", [0.0, -1.0, float("nan"), float("inf")])
def test_an_impossible_amplitude_is_refused(amplitude):
    with pytest.raises(SceneError, match=r"fig3-I: amplitude = .*finite and greater than 0"):
        load_scene("fig3-I", amplitude=amplitude)


def test_an_amplitude_for_a_loading_of_zeros_is_refused():
    text = edited("[[1.0, 0.0], [0.0, 1.0]]", "[[0.0, 0.0], [0.0, 0.0]]")
    with pytest.raises(SceneError, match=r"excitation\.amplitudes = 0\.0: all entries are 0"):
        parse_scene(text.encode(), "mine").with_amplitude(1.0)


def test_an_error_survives_the_way_home_from_a_worker_process():
    error = SceneError("mine.toml", "duration", -1.0, "must be greater than 0")
    back = pickle.loads(pickle.dumps(error))
    assert (back.file, back.key, back.value, back.rule) == ("mine.toml", "duration", -1.0, "must be greater than 0")
    assert str(back) == str(error)


def test_the_good_file_is_good(tmp_path: Path):
    """Otherwise every test above could pass for the wrong reason."""
    file = tmp_path / "mine.toml"
    file.write_text(GOOD)
    scene = load_scene(file)
    assert isinstance(scene, Scene)
    assert scene.name == "mine"
    assert scene.masses.tolist() == [3.0, 1.0]


def test_built_in_scenes_are_the_paper_s():
    assert builtin_scenes() == ["fig3-I", "fig3-II", "fig4-dry", "fig4-viscous"]
    for name in builtin_scenes():
        scene = load_scene(name)
        assert scene.name == name
        assert scene.duration == 20.0
        assert scene.total_mass / scene.masses[0] == 2.0
        assert scene.excitation.periods == [0.9, 1.1]
        assert scene.excitation.decay == pytest.approx([0.3 / 0.9, 0.3 / 1.1], rel=1e-15)
        assert scene.radius == pytest.approx(9.81 / (4.0 * 3.141592653589793**2), rel=1e-15)
        assert scene.lubricated == (name == "fig4-viscous")
        assert scene.amplitudes[:2].tolist() == ([[1, 0], [0, 1]] if name == "fig3-I" else [[1, 1], [1, 1]])
