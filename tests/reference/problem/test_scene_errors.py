"""What is no scene is one line with file, key, value and rule; the built-in scenes are those of the paper."""

import pickle

import pytest
from chains import refusal

from reference.problem import SceneError, builtin_scenes, example_scenes, load_scene, parse_scene
from reference.problem.scene_file import scene_text

TEXT = scene_text("fig3-I").decode()
BODILESS = TEXT[: TEXT.index("[[bodies]]")] + TEXT[TEXT.index("[excitation]") :]


def test_what_is_no_file_or_text_of_a_scene_is_one_line():
    for content, said in {
        TEXT.replace("[isolator]", "[solver]\nstep = 1\n[isolator]"): "solver = {'step': 1}: unknown key",
        'name = "x"\n' + TEXT: "name = 'x': unknown key; the scene is named after its file",
        TEXT.replace("[isolator]", "[isolator"): "file = ",
        TEXT.replace("20.0", f"{11 * '['}2.0{11 * ']'}"): "file = ",
        TEXT.replace("20.0", f"{9 * '['}2.0{9 * ']'}"): "duration = ",
        BODILESS: "bodies: this key is required",
        TEXT.replace("periods =", "period ="): "excitation.period = [0.9, 1.1]: unknown key; did you mean periods?",
        "bodies = []\n" + BODILESS: "bodies = []: must be a list of at least 1; this list has 0",
        b"\xff\xfe title": "file = ",
    }.items():
        content = content.encode() if isinstance(content, str) else content
        error = refusal(parse_scene, content, "folder/mine.toml", kind=SceneError)
        assert str(error).startswith(f"folder/mine.toml: {said}")
        back = pickle.loads(pickle.dumps(error))  # the way home from a worker process
        assert (str(back), back.file, back.key, back.rule) == (str(error), "folder/mine.toml", error.key, error.rule)
    for source in ("/does/not/exist.toml", "fig9", "", "no\0path", "x" * 5000):
        assert "fig3-I, fig3-II, fig4-dry, fig4-viscous" in refusal(load_scene, source, kind=SceneError).rule


def test_an_impossible_amplitude_is_refused():
    for amplitude in (0.0, -1.0, float("nan"), float("inf")):
        line = str(refusal(load_scene, "fig3-I", amplitude=amplitude))
        assert line == f"fig3-I: amplitude = {amplitude}: must be finite and greater than 0 m/s^2"
    silent = load_scene("fig3-I").with_values({"excitation.amplitudes": [[0.0, 0.0], [0.0, 0.0]]})
    assert str(refusal(silent.with_amplitude, 1.0)).startswith(
        "fig3-I[amplitudes changed]: excitation.amplitudes = 0.0: all entries are 0"
    )


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
