"""What `run`, `ensemble` and their plans say of the records that were read: whoever was not told sees what is wrong."""

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from comparison.analyses.ensemble.command import main as ensemble
from comparison.run import main as run

SCENE = """title = "two bodies"
isolator = {{radius = 0.25, friction = 0.05}}
bodies = [{{mass = 1e3}}, {{mass = 1e3, period = [0.4, 0.3]}}]
excitation = {{record = {}}}
"""
TIME = 0.01 * np.arange(400)
ALONG_X = np.exp(-(((TIME - 2.0) / 0.8) ** 2)) * np.sin(9.0 * TIME)
ALONG_X -= ALONG_X.mean()


def table(x: np.ndarray, y: np.ndarray, header: str = "time [s],ax [m/s^2],ay [m/s^2]") -> str:
    return "\n".join([header, *(f"{t:.2f},{a:.6f},{b:.6f}" for t, a, b in zip(TIME, x, y))]) + "\n"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "suite").mkdir()
    return tmp_path


def plan(capsys: pytest.CaptureFixture[str], record: str) -> str:
    Path("mine.toml").write_text(SCENE.format(record))
    assert run(["mine.toml", "--plan"], executor=lambda workers: ThreadPoolExecutor(1)) == 0
    return capsys.readouterr().out


def test_a_plan_shows_what_was_read_and_warns(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    peak = np.abs(ALONG_X).max()
    Path("right.csv").write_text(table(ALONG_X, 0.5 * ALONG_X))
    said = plan(capsys, '"right.csv"')
    assert "Record right.csv: 400 samples, step 0.01 s, 3.99 s\n  right.csv, CSV\n" in said
    assert f"x: peak {peak:.4g} m/s^2 = {peak / 9.81:.4g} g, mean/peak" in said
    assert "final velocity" in said
    assert "Warning" not in said

    Path("line.csv").write_text(table(ALONG_X + 0.08, 0.5 * ALONG_X))
    said = plan(capsys, '"line.csv"')
    assert "Warning: x ends at +0.319 m/s with a mean of +0.08 m/s^2" in said
    assert 'detrend = "mean" or "linear" in [excitation] takes it off' in said


def test_motions_of_a_suite_are_said_once_for_all_scales(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for number in range(1, 7):
        drift = 0.1 if number == 5 else 0.0
        Path(f"suite/m{number}.csv").write_text(table(number * ALONG_X + drift, 0.9 * ALONG_X))
    Path("mine.toml").write_text(SCENE.format('"suite/m1.csv"'))
    words = ["mine.toml", "--suite", "suite", "--scales", "0.5", "1", "3", "--engine", "0", "--plan", "--out", "out"]
    assert ensemble(words, executor=lambda workers: ThreadPoolExecutor(1)) == 0
    said = capsys.readouterr().out
    assert said.startswith("6 motions.\n")
    for number in range(1, 7):
        assert said.count(f"m{number}.csv, CSV") == 1
        assert f"x: peak {np.abs(number * ALONG_X + (0.1 if number == 5 else 0.0)).max():.4g} m/s^2" in said
    assert said.count("Warning") == 1
    assert "Record m5: 400 samples, step 0.01 s, 3.99 s\n  m5.csv, CSV\n  x: peak " in said


def test_the_ensemble_writes_the_list_of_its_motions(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("GM001", "GM002"):
        Path(f"suite/{name}.AT2").write_text(
            f"A\nB\nIN UNITS OF G\nNPTS= 40, DT= .05 SEC\n{'0.1 ' * 20}{'-0.1 ' * 20}\n"
        )
    Path("mine.toml").write_text(SCENE.format('"suite/m1.csv"'))
    words = ["mine.toml", "--suite", "suite", "--engine", "0", "--plan"]
    assert ensemble(words, executor=lambda workers: ThreadPoolExecutor(1)) == 2
    assert "numbers 1, 2 are no azimuths across each other" in capsys.readouterr().err
    single = [*words, "--components", "1", "--write-motions"]
    assert ensemble(single, executor=lambda workers: ThreadPoolExecutor(1)) == 0
    said = capsys.readouterr().out
    assert "2 motions, one component each: x = GM001.AT2, and so on." in said
    assert Path("suite/motions.csv").read_text() == "name,x,y,z,factor\nGM001,GM001.AT2,,,1\nGM002,GM002.AT2,,,1\n"
    assert ensemble(words, executor=lambda workers: ThreadPoolExecutor(1)) == 0
    assert "2 motions, as motions.csv lists them" in capsys.readouterr().out
