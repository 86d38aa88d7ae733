"""The matrix of extremes: what is wrong is found, what is right passes, and the equations fail nowhere."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest
from rich.console import Console

import reference
from comparison.analysis.extremes.cells import Cell, _scene, cells, solve_cell
from comparison.analysis.extremes.engine import amplification
from comparison.analysis.extremes.matrix import FILE, Entry, Matrix, as_json, load
from comparison.analysis.extremes.rows import COLUMNS, Column, Row, rows, scene
from comparison.analysis.extremes.verdicts import Verdict
from comparison.cli.extremes import main, reduced, run
from comparison.report.figures.extremes import draw_extremes

PLAIN = Row("anything", "plain", scene(), ("fake",))
FAILING = {
    "crashes": "exit code 3",
    "raises": "an inner fault",
    "calls_nan_ok": "no finite number",
    "lies_about_its_error": "times what is claimed",
    "misses_the_tolerance": "asked: 0.001",
    "refuses_what_can_be_done": "but a finer run: ok",
    "gives_a_value_with_a_refusal": "and yet a value",
    "invents_a_status": "no answer of a model",
}


def fake(model: str, finer: str = "") -> Column:
    """A column whose model, and the finer one that confirms it, are from extreme_models."""
    path = f"extreme_models:{model}"
    return Column("fake", model, path, {}, 1e-3, ((f"extreme_models:{finer or model}", {}, 1e-5),))


def computed(chosen: list[Row], *columns: Column, limit: float = 60.0) -> Matrix:
    return run(chosen, 1, limit, Console(quiet=True), "a test", columns or COLUMNS)


def entry(column: Column, row: Row = PLAIN, limit: float = 60.0) -> Entry:
    return computed([row], column, limit=limit).rows[0].entries["fake"]


def named(group: str) -> list[Row]:
    return [row for row in reduced(list(rows())) if row.group == group]


@pytest.mark.parametrize("model", FAILING)
def test_a_model_that_is_wrong_fails_and_is_told_why(model):
    found = entry(fake(model))
    assert found.verdict == Verdict.FAILED
    assert FAILING[model] in found.reason


def test_a_model_that_hangs_is_killed_and_the_next_cell_is_solved():
    other = replace(fake("honest"), key="other")
    found = computed([replace(PLAIN, columns=("fake", "other"))], fake("hangs"), other, limit=2.0)
    assert found.rows[0].entries["fake"].reason == "hangs: no answer within 2 s of processor time"
    assert found.rows[0].entries["other"].verdict == Verdict.CONVERGED


def test_a_model_that_a_busy_machine_keeps_waiting_does_not_hang():
    """Two runs of 2.5 s each, which compute next to nothing, under a limit of 1 s."""
    assert entry(fake("is_kept_waiting"), limit=1.0).verdict == Verdict.CONVERGED


def test_a_model_that_computes_nothing_any_more_is_killed_in_the_end(monkeypatch):
    monkeypatch.setattr("comparison.analysis.extremes.worker.STALLED", 4.0)
    assert entry(fake("waits_for_ever"), limit=1.0).reason == "hangs: no answer within 4 s"


def test_a_model_that_is_right_converges_or_refuses_or_says_what_it_cannot():
    assert solve_cell(Cell(PLAIN, fake("honest"))).judged.verdict == Verdict.CONVERGED
    assert solve_cell(Cell(PLAIN, fake("at_the_rim"))).judged.verdict == Verdict.REFUSED
    assert solve_cell(Cell(PLAIN, fake("unable"))).judged.verdict == Verdict.LIMIT


def test_a_value_that_no_finer_run_confirms_fails():
    found = solve_cell(Cell(PLAIN, fake("honest", finer="unable"))).judged
    assert found.verdict == Verdict.FAILED
    assert "no finer run confirms it: step limit" in found.reason


def test_a_refusal_must_be_the_right_one_where_the_row_says_which():
    row = replace(PLAIN, right=("contact lost",))
    assert "instead of contact lost" in solve_cell(Cell(row, fake("at_the_rim"))).judged.reason


def test_an_input_against_the_rules_must_be_refused_and_no_other_may_be():
    wrong = replace(PLAIN, scene=scene(friction=-0.1))
    assert solve_cell(Cell(replace(wrong, invalid=True), fake("honest"))).judged.verdict == Verdict.REFUSED
    assert solve_cell(Cell(wrong, fake("honest"))).judged.verdict == Verdict.FAILED
    assert solve_cell(Cell(replace(PLAIN, invalid=True), fake("honest"))).judged.verdict == Verdict.FAILED


def test_the_matrix_has_every_extreme_and_at_least_120_cells():
    every = list(rows())
    groups = Counter(row.group for row in every)
    for group in (
        "friction", "v_reg, m/s", "amplitude, m/s^2", "rho, m", "bodies N", "total mass, kg",
        "platform's share of the mass", "link periods, s", "harmonics", "decay, 1/s", "duration, s",
        "vertical loading, m/s^2", "phases", "direction", "start at the friction limit", "three supports, ring in m",
    ):  # fmt: skip
        assert groups[group] > 0, group
    assert len(cells(every)) >= 120
    assert len({(row.group, row.title, key) for row in every for key in row.columns}) == len(cells(every))


@pytest.mark.parametrize("group", ["friction", "v_reg, m/s", "vertical loading, m/s^2", "outside the rules"])
def test_the_equations_fail_at_no_extreme(group):
    tasks = cells(named(group))
    assert tasks
    for cell in tasks:
        found = solve_cell(cell).judged
        assert found.verdict != Verdict.FAILED, (cell.row.title, cell.column.key, found.reason)


def test_a_motion_of_a_millisecond_converges_though_rounding_bounds_its_second_factor():
    """mu_2 is 5e-6, a difference of accelerations near 1: no run knows it better than 2e-7 of itself."""
    for row in rows():
        if (row.group, row.title) == ("duration, s", "0.001"):
            found = [solve_cell(Cell(row, column)).judged for column in COLUMNS[:3]]
    assert [one.verdict for one in found] == [Verdict.CONVERGED] * 3, [one.reason for one in found]
    assert 1e-7 < found[2].error < 1e-6


@pytest.mark.long
def test_the_equations_fail_at_none_of_the_extremes():
    found = computed(reduced(list(rows())), limit=120.0)
    assert [(row.group, row.title, title, cell.reason) for row, title, cell in found.listed(Verdict.FAILED)] == []
    assert sum(found.counts().values()) >= 120


def test_the_command_writes_the_matrix_and_its_picture(tmp_path, capsys):
    code = main(["--models", "small", "--only", "amplitude", "--jobs", "1", "--out", str(tmp_path)])
    out = capsys.readouterr().out
    assert code == 0
    assert "0 FAILED" in out
    found = load(tmp_path)
    assert found is not None
    assert found.run["command"].startswith("python -m comparison.extremes --models small ")
    assert {row.group for row in found.rows} == {"amplitude, m/s^2", "outside the rules"} - {"outside the rules"}
    assert (tmp_path / "extremes.png").read_bytes().startswith(b"\x89PNG")


def test_a_failed_cell_is_an_exit_code_and_in_the_picture(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("comparison.cli.extremes.COLUMNS", (fake("calls_nan_ok"),))
    monkeypatch.setattr("comparison.cli.extremes.rows", lambda: iter([PLAIN]))
    assert main(["--jobs", "1", "--out", str(tmp_path)]) == 1
    assert "FAILED: anything plain" in capsys.readouterr().out


@pytest.mark.parametrize("words", [["--jobs", "0"], ["--limit", "-1"], ["--only", "no such extreme"]])
def test_a_wrong_option_is_one_line(words, tmp_path, capsys):
    assert main([*words, "--out", str(tmp_path)]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_the_file_is_read_back_as_it_was_and_another_file_is_refused(tmp_path: Path):
    found = Matrix(
        {"fake": "a fake"},
        [_extreme("converged", 1e-7), _extreme("FAILED", None)],
        {"command": "a test", "seconds": 1.0, "cpu_seconds": 2.0},
    )
    assert load(tmp_path) is None
    (tmp_path / FILE).write_bytes(as_json(found))
    assert load(tmp_path) == found
    draw_extremes(tmp_path / "picture.png", found)
    (tmp_path / "extremes.json").write_text(json.dumps({"rows": []}), encoding="utf-8")
    with pytest.raises(ValueError, match="not a matrix of extremes"):
        load(tmp_path)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        ('{"columns": {}, "rows": [], "run": {}, "old": 1}', "old = 1: "),
        ('{"columns": {}, "rows": 3, "run": {}}', "rows = 3: "),
        ('{"columns": {}', "Invalid JSON"),
        ("\xff", "Invalid JSON"),
    ],
)
def test_a_matrix_of_an_earlier_version_is_refused_in_one_line(content: str, reason: str, tmp_path: Path):
    (tmp_path / FILE).write_bytes(content.encode("latin-1"))
    with pytest.raises(ValueError, match="not a matrix of extremes") as error:
        load(tmp_path)
    assert reason in str(error.value)
    assert "\n" not in str(error.value)


def test_a_matrix_with_a_verdict_that_is_none_is_refused(tmp_path: Path):
    found = Matrix({"fake": "a fake"}, [_extreme("fine", 1e-7)], {"command": "a test"})
    (tmp_path / FILE).write_bytes(as_json(found))
    with pytest.raises(ValueError, match="'fine' is not a valid Verdict"):
        load(tmp_path)


def _extreme(verdict: str, error: float | None):
    from comparison.analysis.extremes.matrix import Extreme

    return Extreme("a group", verdict, {"fake": Entry(verdict, "a reason", error, 0.25, 0.5)})


@pytest.mark.parametrize("given", [{"contact_stiffness": 1e4}, {"contact_stiffness": 1e6}, {"step": 0.1}])
def test_the_error_knows_what_a_bad_choice_of_stiffness_or_step_costs(given):
    written = _scene(scene(duration=0.5))
    engine = amplification(written, [(0.3, 1.1)], tolerance=1e-2, **given)
    exact = reference.amplification(written, [(0.3, 1.1)], equations="exact", regularization=1e-3)
    assert engine.status[0] in ("ok", "tolerance not met")
    assert (abs(engine.mu - exact.mu) <= engine.error + exact.error).all()


def test_the_reduced_form_asks_the_engine_as_well():
    asked = {cell.column.key for cell in cells(reduced(list(rows())))}
    assert asked == {column.key for column in COLUMNS}
