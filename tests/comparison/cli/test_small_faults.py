"""What once ended in a traceback, or reached the terminal as it came, ends in one line."""

import csv
import errno
import io
import os
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from places import ROOT

import reference
from comparison.analyses.ensemble import table as ensemble
from comparison.cli import start
from comparison.cli.arguments import EndedEarlyError, write_and_show
from comparison.cli.arguments import command as command_of
from comparison.cli.start import list_commands
from reference.problem import load_family
from reference.problem.scene_file import parse_scene

ROWS = "\n".join(f"{0.02 * n:.2f},{np.sin(0.3 * n):.5f},0.1" for n in range(200))
RECORD = f"time [s],ax [m/s^2],ay [m/s^2]\n{ROWS}\n"
SUITE = """title = "suite"
isolator = {radius = 1.0, friction = 0.1}
bodies = [{mass = 1.0}]
excitation = {record = {suite = "motions", motion = "all"}}
"""


def suite(folder: Path, names: list[str]) -> str:
    """A scene with all motions of a folder."""
    (folder / "motions").mkdir()
    for name in names:
        (folder / "motions" / f"{name}.csv").write_text(RECORD)
    (folder / "suite.toml").write_text(SUITE)
    return str(folder / "suite.toml")


def test_control_characters_of_a_motion_s_name_do_not_reach_the_terminal(tmp_path: Path) -> None:
    family = load_family(suite(tmp_path, ["\x1b[31mred", "two\nlines", "plain"]))
    labels = family.labels["excitation.record.motion"]
    assert sorted(labels) == ["plain", "two\ufffdlines", "\ufffd[31mred"]


def test_a_suite_with_too_many_motions_is_blamed_on_the_suite(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("reference.problem.families.MAX_SCENES", 2)
    with pytest.raises(reference.SceneError, match=r"excitation.record.suite = 'motions': 3 motions: a family"):
        load_family(suite(tmp_path, ["a", "b", "c"]))


@pytest.mark.parametrize("name", ["=1+1", "\n=1+1", " =1+1", "\t@a", "\r+1", "-1", "+1", "@A1", "\tx"])
def test_no_cell_of_the_table_begins_like_a_formula(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    monkeypatch.setattr(ensemble, "make_table_rows", lambda points, result: [{"motion": name, "scale": -1.0}])
    text = ensemble.format_table((), ())  # type: ignore[arg-type]
    assert f"'{name}" in text
    assert text.endswith(",-1.0\n")
    assert [*csv.reader(io.StringIO(text, newline=""))][1:] == [[f"'{name}", "-1.0"]]
    assert ("\r" in name or "\n" in name) == (f'"\'{name}"' in text), "in quotation marks"


def test_a_scene_is_parsed_from_bytes_alone() -> None:
    text: Any = "x"
    with pytest.raises(TypeError, match="text = 'x': must be the text of a scene file as bytes"):
        parse_scene(text, "x")


@pytest.mark.parametrize("value", ["0", "-1", "many", "", "9" * 5000])
def test_each_wrong_number_in_the_environment_is_one_line(tmp_path: Path, value: str) -> None:
    wrong = {"NUMBA_NUM_THREADS": value, "SOURCE_DATE_EPOCH": "x"}
    words = [sys.executable, "-P", "-m", "comparison.run", "--plan"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), **wrong}
    ended = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True)
    lines = sorted(ended.stderr.splitlines())
    assert (ended.returncode, len(lines)) == (2, 2)
    for (name, text), least, line in zip(wrong.items(), (1, 0), lines, strict=True):
        assert line.startswith(f"environment: {name} = {text[:80]!r}: must be a whole number from {least}")


@pytest.mark.parametrize("name", ["NUMBA_CPU_NAME", "NUMBA_CPU_FEATURES"])
def test_a_processor_that_the_compiler_does_not_know_is_one_line(name: str, monkeypatch: Any, capfd: Any) -> None:
    """Planted: LLVM's own complaint, once for each compiled function, among the results."""
    monkeypatch.setenv(name, "+zzz")
    with pytest.raises(SystemExit, match="2"):
        start._refuse_environment()
    line, end, rest = capfd.readouterr().err.partition("\n")
    assert line.startswith(f"environment: {name} = '+zzz': '+zzz' is not a recognized ")
    assert line.endswith("for this target: correct this environment variable, or remove it")
    assert (end, rest) == ("\n", "")
    monkeypatch.setenv(name, "generic" if name == "NUMBA_CPU_NAME" else "")
    start._refuse_environment()
    assert capfd.readouterr().err == ""


def test_what_cannot_be_written_is_shown_all_the_same(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def write() -> list[Path]:
        raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(EndedEarlyError, match="No space left on device") as ended:
        write_and_show(tmp_path, write, lambda: print("the table"))
    assert (ended.value.code, capsys.readouterr().out) == (3, "the table\n")


def test_what_cannot_be_shown_is_written_all_the_same(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "table"
    assert write_and_show(tmp_path, lambda: [file], lambda: print(SimpleNamespace().nothing)) == [file]
    assert capsys.readouterr().err.startswith("results could not be shown: AttributeError: ")


@pytest.mark.parametrize("words", [("claims", "\x1b[31m\n"), ("ensemble", "fig3-I", "--model", "x" * 5000)])
def test_a_wrong_word_is_one_printable_line_of_moderate_length(words: tuple[str, ...], capsys: Any) -> None:
    command, *options = words
    assert import_module(list_commands()[command].module).main(options) == 2
    line, end, rest = capsys.readouterr().err.partition("\n")
    assert (line.isprintable(), len(line) < 700, end, rest) == (True, True, "\n", "")
    assert line.endswith("(--help lists the options)")


@pytest.mark.parametrize("words", [("run", "--grid=--"), ("ensemble", "fig3-I", "--against=--"), ("init", "--ci=--")])
def test_two_dashes_are_the_value_of_no_option(words: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    command, *options = words
    main = import_module(list_commands()[command].module).main
    assert main(options) == 2
    said = capsys.readouterr().err
    assert said == f"command line: argument {options[-1][:-3]}: expected a value, not '--' (--help lists the options)\n"


@pytest.mark.parametrize(("given", "expected"), [((), ["words", "typed"]), (([],), []), ((("a", "b"),), ["a", "b"])])
def test_a_command_takes_the_words_typed_only_if_none_are_given(
    given: tuple[Any, ...], expected: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[Any] = []
    monkeypatch.setattr(sys, "argv", ["script.py", "words", "typed"])
    assert command_of(lambda words: seen.append(words) or 0)(*given) == 0
    assert seen == [expected]
