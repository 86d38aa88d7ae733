"""A wrong command ends with exit code 2 and one line that names file, key, value and rule; nothing is written."""

from collections.abc import Callable
from pathlib import Path

import pytest
from fake_models import fake_hierarchy
from places import scene_text
from runs import Run

WRONG = [
    (["--grid", "1"], "command line: --grid = 1: must be a whole number from 2 to 512"),
    (["--grid", "513"], "command line: --grid = 513: must be a whole number from 2 to 512"),
    (["--grid", "3.5"], "command line: --grid = '3.5': must be a whole number from 2 to 512"),
    (["--jobs", "0"], "command line: --jobs = 0: must be a whole number from 1 to 1024"),
    (["--tolerance", "0"], "command line: --tolerance = 0.0: must be a number from 1e-08 to 0.1, relative"),
    (["--tolerance", "nan"], "command line: --tolerance = nan: must be a number"),
    (["--budget", "0"], "command line: --budget = 0.0: must be a number from 1 to 1e+07, s of the whole"),
    (["--amplitude", "inf"], "command line: --amplitude = inf: must be a number from 1e-12 to 1e+06, m/s^2"),
    (["--max-work", "0.5"], "command line: --max-work = 0.5: must be a number from 1 to 1e+12, steps of Exudyn"),
    (["--gri", "3"], "command line: unrecognized arguments: --gri"),
    (["--grid"], "command line: argument --grid: expected one argument"),
    (["fig9"], "fig9: scene = 'fig9': No such file or directory; give a TOML file or one of fig3-I"),
    (["fig3-I", "missing.toml"], "missing.toml: "),
    (["fig3-I", "fig3-I"], "fig3-I: scene = 'fig3-I': same name as fig3-I, which"),
    (["/"], "/: scene = '/': Is a directory"),
]


@pytest.mark.parametrize(("words", "line"), WRONG)
def test_a_wrong_option_is_one_line_and_exit_code_2(
    command: Callable[..., Run], words: list[str], line: str, tmp_path: Path
) -> None:
    run = command(*words, hierarchy=fake_hierarchy("forbidden"))
    assert (run.code, run.out, run.err.count("\n")) == (2, "", 1)
    assert run.err.startswith(line)
    assert list(tmp_path.iterdir()) == [], "nothing half-written"


def test_an_impossible_amplitude_names_the_scene(command: Callable[..., Run], tmp_path: Path) -> None:
    matrix = "amplitudes = [[1.0, 0.0], [0.0, 1.0]]"
    still = scene_text("fig3-I", (matrix, "amplitudes = [[0.0, 0.0], [0.0, 0.0]]"))
    (tmp_path / "still.toml").write_text(still, encoding="utf-8")
    run = command(str(tmp_path / "still.toml"), "--amplitude", "2")
    assert (run.code, run.err.count("\n")) == (2, 1)
    assert "excitation.amplitudes = 0.0: all entries are 0: nothing to scale" in run.err
