"""A wrong command ends with exit code 2 and one line that names file, key, value and rule; nothing is written."""

import math
import os
import stat
from collections.abc import Callable
from pathlib import Path

import pytest
from fake_models import fake_hierarchy
from places import scene_text
from pydantic import TypeAdapter
from runs import Run

from comparison.result_types import Number, Radius

WRONG = [
    (["--grid", "1"], "command line: --grid = 1: must be a whole number from 2 to 512"),
    (["--grid", "513"], "command line: --grid = 513: must be a whole number from 2 to 512"),
    (["--grid", "3.5"], "command line: --grid = '3.5': must be a whole number from 2 to 512"),
    (["--jobs", "0"], "command line: --jobs = 0: must be a whole number from 1 to 1024"),
    (["--tolerance", "0"], "command line: --tolerance = 0.0: must be a number from 1e-08 to 0.1, relative"),
    (["--tolerance", "nan"], "command line: --tolerance = nan: must be a number"),
    (["--budget", "0"], "command line: --budget = 0.0: must be a number from 1 to 1e+07, s of the whole"),
    (["--amplitude", "inf"], "command line: --amplitude = inf: must be a number from 1e-12 to 1e+06, m/s^2"),
    (["--max-work", "0.5"], "command line: --max-work = 0.5: must be a number from 1 to 1e+12, steps of the engine"),
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


def test_an_impossible_amplitude_and_a_name_that_is_there_twice_name_the_scene(
    command: Callable[..., Run], tmp_path: Path
) -> None:
    file, other = tmp_path / "still.toml", tmp_path / "other" / "still.toml"
    other.parent.mkdir()
    matrix = "amplitudes = [[1.0, 0.0], [0.0, 1.0]]"
    file.write_text(scene_text("fig3-I", (matrix, "amplitudes = [[0.0, 0.0], [0.0, 0.0]]")), encoding="utf-8")
    other.write_text(scene_text("fig3-I"), encoding="utf-8")
    still = command(str(file), "--amplitude", "2")
    assert (still.code, still.err.count("\n")) == (2, 1)
    assert "excitation.amplitudes = 0.0: all entries are 0: nothing to scale" in still.err
    file.write_text(scene_text("fig3-I"), encoding="utf-8")
    twice = command(str(file), str(other))
    assert (twice.code, twice.err.count("\n")) == (2, 1)
    assert twice.err.startswith(f"{other}: scene = 'still': same name as {file}, which names its surfaces")


def test_a_wrong_file_beside_the_report_is_named_with_its_key_and_command(
    command: Callable[..., Run], tmp_path: Path
) -> None:
    (tmp_path / "report").mkdir()
    (tmp_path / "report" / "extremes.json").write_text('{"columns": {"small": 3}}', encoding="utf-8")
    run = command("fig3-I", hierarchy=fake_hierarchy("forbidden"))
    assert (run.code, run.err.count("\n")) == (2, 1)
    assert "extremes.json: not a matrix of extremes: columns.small: " in run.err
    assert run.err.endswith(": run python -m comparison.extremes\n")
    written = [TypeAdapter(kind).dump_json(value) for kind in (Number, Radius) for value in (math.nan, math.inf, 0.5)]
    assert written == [b"null", b"null", b"0.5", b"null", b'"inf"', b"0.5"], "JSON has no other numbers"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_out_that_cannot_be_written_is_refused_at_the_start(command: Callable[..., Run], tmp_path: Path) -> None:
    locked = tmp_path / "locked"
    locked.mkdir()
    locked.chmod(stat.S_IRUSR | stat.S_IXUSR)
    run = command("--out", str(locked / "report"), hierarchy=fake_hierarchy("forbidden"))
    assert run.code == 2
    assert "cannot be written: Permission denied" in run.err
