"""Every rule of the scene file: broken, it is one SceneError on one line with file, key, value and rule."""

import pickle

import pytest
from chains import refusal
from scene_text import GOOD, edited

from reference.problem import SceneError, builtin_scenes, example_scenes, load_scene, parse_scene

CENTER = "bodies: center of mass of all [x, y] in m"
BARS = "bending_stiffness = 1, length = 1"
TWO = "\n\n[[bodies]]\nmass = "

# what is changed in the good file, key, value if it is one, words of the rule
BROKEN = [
    ("duration = 2.0\ncolour = 3", "colour", 3, "unknown key"),
    ("[isolator] -> [solver]\nstep = 1\n[isolator]", "solver", {"step": 1}, "unknown key"),
    ('duration = 2.0\nname = "x"', "name", "x", "named after its file"),
    ("duration = 2.0 ->", "duration", None, "required"),
    ('duration = "2"', "duration", "2", "number"),
    ("friction = {slow = 0.0, fast = 0.2, rate = 50.0}", "isolator.friction.slow", 0.0, "greater than 0"),
    ("friction = {slow = 0.1, fast = 0.2, rat = 50.0}", "isolator.friction.rat", 50.0, "did you mean rate"),
    ("friction = 0.1 ->", "isolator", {"period": 1.0}, "exactly one of friction and lubrication"),
    ("period = 1.0 ->", "isolator", {"friction": 0.1}, "exactly one of period and radius"),
    ("friction = 0.1\nsupports = 2", "isolator.supports", 2, "equal to 3"),
    ("friction = 0.1\nsupports = [[0, 1], [1, 0], [1, 1e7]]", "isolator.supports.2.1", 1e7, "to 1e+06 m"),
    ("friction = 0.1\nring = 1.0\nsupports = [[0, 1], [1, -1], [-1, -1]]", "isolator.ring", 1.0, "remove this key"),
    ("friction = 0.1\nsupports = [[0.1, 0.1], [0.2, 0.2], [0.3, 0.3]]", "isolator.supports", None, "on one line"),
    ("friction = 0.1\nsupports = [[0, 1], [1, -1], [0, 1]]", "isolator.supports", None, "at the same place"),
    ("friction = 0.1\nsupports = [[1, 1], [2, 1], [1, 2]]", CENTER, [0.0, 0.0], "would carry nothing at rest"),
    ("mass = 1.0 -> mass = 1.0\nyaw = 45.0", "bodies.1.yaw", 45.0, "rad"),
    ("[isolator] -> [acceptance]\nmedian = -1.0\n[isolator]", "acceptance.median", -1.0, "greater"),
    ("[isolator] -> [isolator", "file", None, "valid TOML"),
    (f"duration = {11 * '['}2.0{11 * ']'}", "file", None, "at most 10 tables and lists within one another"),
    (f"duration = {9 * '['}2.0{9 * ']'}", "duration", None, "number"),
    # links
    ("mass = 3.0 -> mass = 3.0\nstiffness = [1.0, 1.0]", "bodies.0.stiffness", None, "platform"),
    (f"mass = 3.0 -> mass = 3.0\nbars = {{count = 4, {BARS}}}", "bodies.0.bars", None, "platform"),
    ("period = [1.5, 1.2] ->", "bodies.1", None, "exactly one of period, stiffness and bars"),
    (f"period = [1.5, 1.2] -> bars = {{count = 4.5, {BARS}}}", "bodies.1.bars.count", 4.5, "int"),
    # values that overflow in SI units
    ("period = 1.0 -> period = 1e200", "isolator.period", 1e200, "finite and positive"),
    ("period = [1.5, 1.2] -> period = [1e-200, 1.2]", "bodies.1.period.0", 1e-200, "finite and positive"),
    (f"mass = 3.0{TWO}1.0 -> mass = 1e308{TWO}1e308", "bodies.0.mass", 1e308, "finite and positive"),
]


@pytest.mark.parametrize(("change", "key", "value", "rule"), BROKEN)
def test_a_broken_rule_is_one_line_with_file_key_value_and_rule(change, key, value, rule):
    error = refusal(parse_scene, edited(change).encode(), "folder/mine.toml", kind=SceneError)
    assert error.key == key
    assert value is None or error.value == value
    assert rule in error.rule
    assert str(error).startswith(f"folder/mine.toml: {key} = ")
    assert str(error).endswith(error.rule)
    back = pickle.loads(pickle.dumps(error))  # the way home from a worker process
    assert (str(back), back.file, back.key, back.rule) == (str(error), "folder/mine.toml", error.key, error.rule)


def test_what_is_no_file_or_text_of_a_scene_is_one_line():
    text = GOOD.replace("[[bodies]]\nmass = 3.0\n\n[[bodies]]\nmass = 1.0\nperiod = [1.5, 1.2]\n", "")
    for content, said in {
        text: "bodies = None: this key is required",
        "bodies = []\n" + text: "bodies = []: List should have at least 1 item",
        b"\xff\xfe title": "file = ",
    }.items():
        content = content.encode() if isinstance(content, str) else content
        assert str(refusal(parse_scene, content, "mine.toml")).startswith(f"mine.toml: {said}")
    for source in ("/does/not/exist.toml", "fig9", "", "no\0path", "x" * 5000):
        assert "fig3-I, fig3-II, fig4-dry, fig4-viscous" in refusal(load_scene, source, kind=SceneError).rule


def test_an_impossible_amplitude_is_refused():
    for amplitude in (0.0, -1.0, float("nan"), float("inf")):
        line = str(refusal(load_scene, "fig3-I", amplitude=amplitude))
        assert line == f"fig3-I: amplitude = {amplitude}: must be finite and greater than 0 m/s^2"
    silent = parse_scene(edited("amplitudes = [[0.0, 0.0], [0.0, 0.0]]").encode(), "mine")
    assert str(refusal(silent.with_amplitude, 1.0)).startswith("mine: excitation.amplitudes = 0.0: all entries are 0")


BOTH = [[1, 1], [1, 1], [0, 0]]
BUILT_IN = {  # law of friction, periods of the link, amplitudes, largest median difference accepted
    "fig3-I": ({"friction": 0.1}, [1.5, 1.2], [[1, 0], [0, 1], [0, 0]], 1e-4),
    "fig3-II": ({"friction": 0.1}, [1.5, 1.2], BOTH, 1e-4),
    "fig4-dry": ({"friction": 0.1}, [1.5, 1.5], BOTH, 1e-4),
    "fig4-viscous": ({"lubrication": 0.5}, [1.5, 1.5], BOTH, 1e-4),
    "synthetic-pair": ({"friction": 0.1}, [1.5, 1.2], None, 1e-3),
    "synthetic-triple": ({"friction": 0.1}, [1.5, 1.2], None, 1e-3),
}


def test_built_in_scenes_are_the_paper_s():
    assert builtin_scenes() + example_scenes() == list(BUILT_IN)
    for name, (law, periods, amplitudes, close) in BUILT_IN.items():
        scene = load_scene(name)
        platform, upper = scene.bodies
        assert (scene.name, scene.duration) == (name, 16.0 if name == "synthetic-triple" else 20.0)
        assert (platform.mass, upper.mass, upper.period) == (1.0, 1.0, periods)
        assert (platform.height, upper.height) == (0.2, 1.2)
        assert platform.size == upper.size == [2.0, 2.0, 0.2]
        geometry = {"period": 1.0, "supports": 4, "ring": 1.0, "sphere_radius": 0.05}
        assert scene.isolator.model_dump(exclude_none=True) == geometry | law
        limits = {"median": close, "maximum": 1e-3, "ratio": 2.0, "closure": 1e-12, "failed": 0}
        assert scene.acceptance.model_dump(exclude_none=True) == limits
        if amplitudes:
            assert scene.excitation.periods == [0.9, 1.1]
            assert scene.excitation.decay == pytest.approx([0.3 / 0.9, 0.3 / 1.1], rel=1e-15)
            assert scene.amplitudes.tolist() == amplitudes
        else:
            assert scene.excitation.scale == 1.0
