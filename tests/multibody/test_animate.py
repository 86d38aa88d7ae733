"""The film of a run is written without a display, and shows the motion that was computed."""

import dataclasses
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from exudyn.rigidBodyUtilities import RotXYZ2RotationMatrix
from numpy.typing import NDArray
from PIL import Image
from scenes_at_hand import changed, one_body
from scipy.spatial import ConvexHull

import multibody
from multibody import animate
from multibody import film as film_module
from multibody.animate import main
from multibody.film import Look, box_corners, contact_paths, film, frames, magnified
from reference.problem import load_scene

SHORT = """
title = "short"
duration = 0.2
[isolator]
period = 1.0
friction = 0.05
[[bodies]]
mass = 1.0
[[bodies]]
mass = 1.0
period = [1.5, 1.2]
[excitation]
amplitudes = [[2.0, 0.0], [0.0, 2.0]]
periods = [0.9, 1.1]
decay = [0.3, 0.3]
"""


@pytest.fixture
def words(tmp_path: Path) -> list[str]:
    (tmp_path / "short.toml").write_text(SHORT)
    return [str(tmp_path / "short.toml"), "--phases", "0.3", "1.1", "--out", str(tmp_path / "run.gif")]


def test_a_film_is_written_off_screen(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 0
    assert "status ok" in capsys.readouterr().out
    with Image.open(words[-1]) as film:
        assert film.n_frames == 6  # 25 per second and the first


def test_a_refused_motion_is_one_line(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    Path(words[0]).write_text(SHORT.replace("duration = 0.2", "duration = 1e4"))
    assert main([*words, "--speed", "1e3"]) == 2
    message = capsys.readouterr().err
    assert message.startswith("short: there is no motion to show: step limit: refused before any step")
    assert "a looser tolerance does not help" in message
    assert message.count("\n") == 1
    assert not Path(words[-1]).exists()


def test_a_film_never_takes_the_place_of_a_file(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    out = Path(words[-1])
    out.write_bytes(b"mine")
    assert main(words) == 0
    assert out.read_bytes() == b"mine"
    assert capsys.readouterr().err == f"{out} exists and stays: the film is in {out.with_name('run-2.gif')}\n"
    with Image.open(out.with_name("run-2.gif")) as film:
        assert film.n_frames == 6


class Screen:
    """Stands in for the engine's renderer and solver: notes what it is asked for."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.calls: list[str] = []
        self.end: float | None = None
        built = animate.assemble

        def assemble(*arguments: Any) -> Any:
            model = built(*arguments)
            self.model = model
            self.renderer = SimpleNamespace(
                Start=lambda: self.calls.append("start"),
                DoIdleTasks=lambda: self.calls.append("idle"),
                Stop=lambda: self.calls.append("stop"),
            )
            system = SimpleNamespace(SolveDynamic=self.solve, systemData=model.mbs.systemData)
            system.SetObjectParameter = model.mbs.SetObjectParameter
            return dataclasses.replace(model, mbs=system, references=(self,))

        monkeypatch.setattr(animate, "assemble", assemble)

    def solve(self, settings: Any) -> None:
        self.calls.append("solve")
        self.end = settings.timeIntegration.endTime


@pytest.mark.parametrize("model", ["translational", "spatial"])
def test_the_viewer_shows_the_whole_run_of_the_model_asked_for(model: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DISPLAY", ":0")
    screen = Screen(monkeypatch)
    assert main(["fig3-I", "--phases", "0.3", "1.1", "--model", model, "--view"]) == 0
    assert screen.calls == ["start", "idle", "solve", "idle", "stop"]
    assert screen.end == pytest.approx(20.0 / screen.model.units.time)
    assert screen.model.allows_liftoff == (model == "spatial")


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the screen is not named by a variable")
def test_without_a_screen_the_viewer_is_refused_in_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    assert main(["fig3-I", "--phases", "0.3", "1.1", "--view"]) == 2
    message = capsys.readouterr().err
    assert "--view" in message
    assert message.count("\n") == 1


def test_the_drawn_corners_turn_with_the_body() -> None:
    center, size = np.array([1.0, 2.0, 3.0]), np.array([4.0, 2.0, 1.0])
    quarter = box_corners(center, size, np.array([0.0, 0.0, np.pi / 2.0])) - center
    # a quarter about z swaps length and width; the corner at (+, +) goes to (-, +)
    np.testing.assert_allclose(np.abs(quarter), np.tile([1.0, 2.0, 0.5], (8, 1)), atol=1e-15)
    np.testing.assert_allclose(quarter[-1], [-1.0, 2.0, 0.5], atol=1e-15)
    angles = np.array([0.3, -0.2, 0.5])
    turned = box_corners(center, size, angles) - center
    straight = box_corners(center, size, np.zeros(3)) - center
    # the engine's own matrix of its angles
    np.testing.assert_allclose(turned, straight @ RotXYZ2RotationMatrix(angles).T, atol=1e-14)


def test_the_film_of_the_spatial_model_shows_its_turns(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = changed(load_scene("fig3-I"), duration=1.5)
    motion = multibody.trajectory(scene, (2.0, 0.7), model="spatial")
    turns = motion.extra["turns"]
    np.testing.assert_array_equal(turns[:, 0, 2], motion.extra["yaw"])
    assert np.abs(turns[:, 1, 2]).max() > 1e-5  # the body above turns too

    seen: list[NDArray[np.float64]] = []
    monkeypatch.setattr(film_module, "ConvexHull", lambda flat: seen.append(flat) or ConvexHull(flat))
    film(scene, motion, "spatial", Look(stretch=1.0), 4)
    from_above = np.array(seen[-6])  # three views of two bodies in the last frame: the platform in the first
    edge = from_above[4] - from_above[0]  # along the box's own x
    yaw, factor = motion.extra["yaw"][-1], magnified(frames(motion.time, turns, 4)[..., 2], 0.3)
    assert factor >= 10.0
    # to the square of the tilt drawn, which is 0.3 at most
    assert np.arctan2(edge[1], edge[0]) == pytest.approx(factor * yaw, rel=0.1)


def test_contact_points_move_against_the_platform() -> None:
    scene = load_scene("fig3-I")
    shift = np.array([[0.01, -0.02, 0.0]])
    lever = 0.05 / scene.radius
    moved = contact_paths(scene, shift, np.zeros((1, 3)))
    np.testing.assert_allclose(moved, np.tile(-lever * shift[:, :2], (1, 4, 1)), atol=1e-15)
    yawed = contact_paths(scene, np.zeros((1, 3)), np.array([[0.0, 0.0, 1e-3]]))[0]
    # the supports of a ring of 1 m stand at 45 degrees: each goes along the ring, the first towards (-, +)
    np.testing.assert_allclose(yawed[0], -lever * 1e-3 * np.sqrt(0.5) * np.array([-1.0, 1.0]), rtol=1e-3)
    aside = scene.with_values({"bodies.0.offset": [0.1, 0.05]})  # it turns about its center of mass
    [yawed] = contact_paths(aside, np.zeros((1, 3)), np.array([[0.0, 0.0, 1e-3]]))
    arm = np.sqrt(0.5) - np.array([0.1, 0.05])
    np.testing.assert_allclose(yawed[0], -lever * 1e-3 * np.array([-arm[1], arm[0]]), rtol=1e-3)


@pytest.mark.parametrize(
    ("largest", "factor"), [(0.0, 1e4), (1e-9, 1e4), (9.4e-5, 2e3), (1.4e-3, 200.0), (0.3, 1.0), (1.0, 1.0)]
)
def test_turns_are_magnified_by_round_factors_and_never_reduced(largest: float, factor: float) -> None:
    assert magnified(np.array([0.0, -largest]), 0.3) == factor


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nowhere.toml", "--phases", "0", "0"], "nowhere.toml"),
        (["fig3-I", "--phases", "0", "nan"], "phases"),
        (["fig3-I", "--phases", "0", "0", "--model", "flexible"], "model"),
        (["fig3-I", "--phases", "0", "0", "--speed", "1e-9"], "--speed"),
        (["fig3-I", "--phases", "0", "0", "--stretch", "1e300"], "--stretch"),
        (["fig3-I", "--phases", "0", "0", "--rate", "30"], "--rate"),
        (["fig3-I", "--phases", "0", "0", "--size", "10", "10"], "--size"),
        (["fig3-I", "--phases", "0", "0", "--out", "/nowhere/run.gif"], "--out"),
        (["fig3-I", "--phases", "0", "0", "--out", "run.mp4"], "must end in .gif"),
        (["fig3-I", "--phases", "0", "0", "--out", "/"], "is a folder"),
    ],
)
def test_wrong_options_end_with_one_line_before_anything_is_run(
    words: list[str], said: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    if said not in ("phases", "model"):  # which the run itself refuses, before its first step
        monkeypatch.setattr(animate, "trajectory", lambda *given: pytest.fail("a motion was computed"))
    assert main(words) == 2
    message = capsys.readouterr().err
    assert said in message
    assert message.count("\n") == 1


def test_size_and_rate_are_those_asked_for(words: list[str]) -> None:
    assert main([*words, "--rate", "50", "--size", "640", "400"]) == 0
    with Image.open(words[-1]) as film:
        assert film.n_frames == 11
        assert film.size == (640, 400)
        assert film.info["duration"] == 20  # ms


def test_frames_follow_the_motion() -> None:
    motion = multibody.trajectory(one_body(amplitudes=[[3.0, 0.0], [0.0, 0.0]]), (0.0, 0.0))
    shown = frames(motion.time, motion.position, 11)
    assert shown.shape == (11, 1, 3)
    np.testing.assert_allclose(shown[-1], motion.position[-1])
    middle = np.array([np.interp(0.5, motion.time, motion.position[:, 0, axis]) for axis in range(3)])
    np.testing.assert_allclose(shown[5, 0], middle)


def test_the_picture_names_the_model_and_the_factors(monkeypatch: pytest.MonkeyPatch) -> None:
    titles: list[str] = []
    monkeypatch.setattr(film_module.Figure, "suptitle", lambda figure, text, **style: titles.append(text))
    scene = changed(load_scene("fig3-I"), duration=0.5)
    film(scene, multibody.trajectory(scene, (2.0, 0.7), tolerance=1e-2), "translational", Look(), 2)
    assert "translational model of the engine" in titles[0]
    assert "displacements x 5" in titles[0]
