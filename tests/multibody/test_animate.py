"""The film of a run is written without a display, and shows the motion that was computed."""

from __future__ import annotations

import dataclasses
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from PIL import Image
from scenes_at_hand import one_body

import multibody
from multibody import animate
from multibody.animate import frames, main

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


def test_a_film_is_written_off_screen(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "short.toml").write_text(SHORT)
    out = tmp_path / "run.gif"
    assert main([str(tmp_path / "short.toml"), "--phases", "0.3", "1.1", "--out", str(out)]) == 0
    assert "status ok" in capsys.readouterr().out
    with Image.open(out) as film:
        assert film.n_frames == 6  # 25 per second and the first


class Screen:
    """Stands in for the engine's renderer and solver: notes what it is asked for."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.calls: list[str] = []
        self.end: float | None = None
        built = animate.assembled

        def assembled(*arguments: Any) -> Any:
            model = built(*arguments)
            self.model = model
            self.renderer = SimpleNamespace(
                Start=lambda: self.calls.append("start"),
                DoIdleTasks=lambda: self.calls.append("idle"),
                Stop=lambda: self.calls.append("stop"),
            )
            system = SimpleNamespace(SolveDynamic=self.solve, systemData=model.mbs.systemData)
            system.SetObjectParameter = model.mbs.SetObjectParameter
            return dataclasses.replace(model, mbs=system, keep_alive=(self,))

        monkeypatch.setattr(animate, "assembled", assembled)

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
    assert screen.model.liftoff == (model == "spatial")


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the screen is not named by a variable")
def test_without_a_screen_the_viewer_is_refused_in_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    assert main(["fig3-I", "--phases", "0.3", "1.1", "--view"]) == 2
    message = capsys.readouterr().err
    assert "--view" in message
    assert message.count("\n") == 1


def test_frames_follow_the_motion() -> None:
    motion = multibody.trajectory(one_body(amplitudes=[[3.0, 0.0], [0.0, 0.0]]), (0.0, 0.0))
    shown = frames(motion, 10.0)
    assert shown.shape == (11, 1, 3)
    np.testing.assert_allclose(shown[-1], motion.position[-1])
    middle = np.array([np.interp(0.5, motion.time, motion.position[:, 0, axis]) for axis in range(3)])
    np.testing.assert_allclose(shown[5, 0], middle)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nowhere.toml", "--phases", "0", "0"], "nowhere.toml"),
        (["fig3-I", "--phases", "0", "nan"], "phases"),
        (["fig3-I", "--phases", "0", "0", "--model", "flexible"], "model"),
        (["fig3-I", "--phases", "0", "0", "--speed", "0"], "--speed"),
        (["fig3-I", "--phases", "0", "0", "--out", "/nowhere/run.gif"], "--out"),
    ],
)
def test_wrong_options_end_with_one_line(words: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 2
    message = capsys.readouterr().err
    assert said in message
    assert message.count("\n") == 1
