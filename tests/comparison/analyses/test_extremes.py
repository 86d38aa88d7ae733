"""The matrix of extremes: what is wrong is found, what is right passes, and the equations fail nowhere."""

import re
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from known_results import PLAIN, fake
from matplotlib.image import imread
from runs import no_executor

import multibody
from comparison.analyses.extremes import analysis
from comparison.analyses.extremes.command import main
from comparison.analyses.extremes.engine import amplification
from comparison.analyses.extremes.figure import draw_extremes
from comparison.analyses.extremes.matrix import STORED, Extreme, Matrix, Verdict
from comparison.analyses.extremes.rows import CAUSES, Row, rows, scene
from comparison.runner.cache import Cache
from comparison.runner.processes import Pool, TimeLimitError, WorkerDiedError, process_pool
from comparison.runner.runner import Runner
from comparison.runner.task import TaskResult
from comparison.runner.task_results import TaskResults
from reference.problem import Outcome

FAILING = {
    "raises": "an inner fault",
    "calls_nan_ok": "no finite number",
    "lies_about_its_error": "times what is claimed",
    "misses_the_tolerance": "asked: 0.001",
    "refuses_what_can_be_done": "but a finer run: ok",
    "gives_a_value_with_a_refusal": "and yet a value",
    "invents_a_status": "no answer of a model",
}


class Ending(ThreadPoolExecutor):
    """In place of worker processes: one that would hang takes too long, one that would crash dies."""

    def start(self, call: Any, seconds: float | None, group: str) -> Future[TaskResult]:
        [task] = call.args
        ends = {"hangs": TimeLimitError(f"no answer within {seconds:g} s of processor time"),
                "crashes": WorkerDiedError("exit code 3", exit_code=3)}  # fmt: skip
        error = ends.get(task.argument.column.amplification.partition(":")[2])
        if error is None:
            return self.submit(call)
        ended: Future[TaskResult] = Future()
        ended.set_exception(error)
        return ended


def computed(extremes: analysis.Extremes, results: TaskResults | None = None, executor: Pool = Ending) -> Matrix:
    """The matrix, by one worker."""
    results = results or TaskResults()
    Runner(results, 1, executor).run(extremes.tasks())
    return extremes.collect(None, None, results)


def named(group: str) -> list[Row]:
    return [row for row in analysis.reduced(list(rows())) if row.group == group]


@pytest.mark.parametrize("model", FAILING)
def test_a_model_that_is_wrong_fails_and_is_told_why(model):
    cell = analysis.solve_cell(analysis.Cell(PLAIN, fake(model)))
    assert cell.verdict == Verdict.FAILED
    assert FAILING[model] in cell.reason


def test_models_that_crash_in_a_worker_fail_with_the_reason():
    columns = [replace(fake(model), key=model) for model in ("crashes", "raises")]
    (row,) = computed(analysis.Extremes([replace(PLAIN, columns=("crashes", "raises"))], columns)).rows
    assert {entry.verdict for entry in row.entries.values()} == {Verdict.FAILED}
    assert "exit code 3" in row.entries["crashes"].reason
    assert FAILING["raises"] in row.entries["raises"].reason


def test_a_model_that_hangs_costs_its_cell_alone(tmp_path):
    other = replace(fake("honest"), key="other")
    extremes = analysis.Extremes([replace(PLAIN, columns=("fake", "other"))], [fake("hangs"), other], 2.0)
    (row,) = computed(extremes, TaskResults(Cache(tmp_path))).rows
    hanging = row.entries["fake"]
    assert (hanging.verdict, hanging.status) == ("FAILED", "time limit")
    assert hanging.reason == "hangs: no answer within 2 s of processor time"
    assert row.entries["other"].verdict == Verdict.CONVERGED
    results = TaskResults(Cache(tmp_path))
    assert results.missing(extremes.tasks()) == []
    assert extremes.collect(None, None, results).rows == [row]
    assert len(TaskResults(Cache(tmp_path)).missing(replace(extremes, limit=3.0).tasks())) == 1, "allowed more"


AGAINST_A_RULE = replace(PLAIN, scene=scene(friction=-0.1))


@pytest.mark.parametrize(
    ("row", "column", "verdict", "reason"),
    [
        (PLAIN, fake("honest"), "converged", "confirmed"),
        (replace(PLAIN, settings={"tolerance": 1e-7}), fake("honest"), "converged", "confirmed"),  # by as much less
        (PLAIN, fake("at_the_rim"), "refused", "rim reached"),
        (PLAIN, fake("at_the_rim", finer="unable"), "refused", "rim reached"),
        (PLAIN, fake("unable"), "limit", "step limit"),
        (PLAIN, fake("honest", finer="unable"), "FAILED", "no finer run confirms it: step limit"),
        (replace(PLAIN, right=("contact lost",)), fake("at_the_rim"), "FAILED", "instead of contact lost"),
        (replace(AGAINST_A_RULE, invalid=True), fake("honest"), "refused", "friction"),
        (AGAINST_A_RULE, fake("honest"), "FAILED", "friction"),
        (replace(PLAIN, invalid=True), fake("honest"), "FAILED", "accepts an input that is against the rules"),
    ],
)
def test_every_kind_of_answer_has_its_verdict(row, column, verdict, reason):
    cell = analysis.solve_cell(analysis.Cell(row, column))
    assert (cell.verdict, reason in cell.reason) == (verdict, True), cell.reason


@pytest.mark.parametrize("group", ["friction", "v_reg, m/s", "vertical loading, m/s^2", "outside the rules"])
def test_the_equations_fail_at_no_extreme(group):
    tasks = analysis.cells(named(group))
    assert tasks
    for cell in tasks:
        entry = analysis.solve_cell(cell)
        assert entry.verdict != Verdict.FAILED, (cell.row.title, cell.column.key, entry.reason)


@pytest.mark.long
def test_the_equations_fail_at_none_of_the_extremes():
    matrix = computed(analysis.Extremes(analysis.reduced(list(rows())), limit=120.0), executor=process_pool)
    assert [(row.group, row.title, title, cell.reason) for row, title, cell in matrix.listed(Verdict.FAILED)] == []
    assert sum(matrix.counts().values()) >= 120


def test_the_command_writes_the_matrix_and_computes_once(tmp_path, capsys):
    words = ["--models", "small", "--rows", "amplitude, m/s^2 1e", "--jobs", "1", "--out", str(tmp_path / "report")]
    assert main(words, ThreadPoolExecutor) == 0
    out = capsys.readouterr().out
    assert re.search(
        r"^3 cells in .* s of processor time: \d+ converged, \d+ refused, \d+ limit, 0 FAILED\.$", out, re.M
    )
    matrix = STORED.load(tmp_path / "report")
    assert matrix.run["command"].startswith("python -m comparison.extremes --models small ")
    assert {row.group for row in matrix.rows} == {"amplitude, m/s^2"}
    assert (tmp_path / "report" / "extremes.png").read_bytes().startswith(b"\x89PNG")
    assert main(words, no_executor) == 0
    assert f"3 of 3 tasks are in {tmp_path / 'report'}.tiles: only the others are computed." in capsys.readouterr().out
    again = STORED.load(tmp_path / "report")
    assert (again.rows, again.run["stored_before"]) == (matrix.rows, 3)
    with pytest.raises(AssertionError, match="computed"):
        main([*words, "--fresh"], no_executor)
    capsys.readouterr()
    assert main(words, ThreadPoolExecutor) == 0
    assert "tasks are in" not in capsys.readouterr().out, "what --fresh dropped is computed by the next run"


def test_a_failed_cell_is_an_exit_code_and_in_the_picture(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("comparison.analyses.extremes.command.COLUMNS", (fake("calls_nan_ok"),))
    monkeypatch.setattr("comparison.analyses.extremes.command.rows", lambda: iter([PLAIN]))
    assert main(["--jobs", "1", "--out", str(tmp_path / "report")], ThreadPoolExecutor) == 1
    assert "FAILED: anything plain" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "rule"),
    [
        (["--jobs", "0"], "must be a whole number from 1"),
        (["--limit", "-1"], "--limit = "),
        (["--rows", "no such extreme"], "no cell is left: take part of a row's name"),
        (["--only", "friction"], "selects analyses of a study; the extremes are chosen with --rows TEXT"),
    ],
)
def test_a_wrong_option_is_one_line(words, rule, tmp_path, capsys):
    assert main([*words, "--out", str(tmp_path / "report")], no_executor) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert rule in line


@pytest.mark.parametrize(("models", "groups"), [(1, 1), (3, 2)])
def test_the_legend_of_the_picture_lies_within_it(tmp_path: Path, models: int, groups: int) -> None:
    columns = {f"model {number}": "an engine" for number in range(models)}
    rows = [Extreme(f"group {number % groups}", "1", {}) for number in range(8)]
    draw_extremes(tmp_path / "picture.png", Matrix(columns, rows, {}))
    picture = imread(tmp_path / "picture.png")
    assert (picture[:, [0, -1]] == 1.0).all(), "nothing goes on beyond its borders"


def test_levels_begin_at_the_stated_stiffness_and_step(monkeypatch: pytest.MonkeyPatch) -> None:
    brief, asked = analysis.read_scene(scene(duration=0.5)), {}
    usual = multibody.levels(brief, "translational", 1e-2, 1e-3)[0]
    monkeypatch.setattr("multibody.amplification", lambda *rest, levels, **settings: asked.update(first=levels[0]))
    amplification(brief, [(0.3, 1.1)], contact_stiffness=1e4)
    assert asked["first"].penetration == pytest.approx(brief.total_mass * 9.81 / (1e4 * brief.radius))
    amplification(brief, [(0.3, 1.1)], step=0.1)
    assert asked["first"].step * np.sqrt(brief.radius / 9.81) == pytest.approx(0.1)
    assert asked["first"].error_floor / usual.error_floor == pytest.approx((asked["first"].step / usual.step) ** 2)


def test_every_known_cause_of_a_limit_is_that_of_a_cell():
    asked = {((cell.row.group, cell.row.title), cell.column.key) for cell in analysis.cells(list(rows()))}
    assert {(extreme, model) for extreme, models in CAUSES.items() for model in models} <= asked


def test_a_limit_states_its_cause_and_no_other_verdict_does(monkeypatch):
    monkeypatch.setitem(CAUSES, (PLAIN.group, PLAIN.title), {"fake": "the fake gives up"})
    assert analysis.solve_cell(analysis.Cell(PLAIN, fake("unable"))).reason == "step limit: the fake gives up"
    assert "gives up" not in analysis.solve_cell(analysis.Cell(PLAIN, fake("honest"))).reason


def test_a_value_that_says_nothing_is_not_confirmed() -> None:
    mu = np.array([[1.0, 2.0]])
    for status, share, says in (
        (Outcome.TOLERANCE_NOT_MET, 1.0, False),
        (Outcome.TOLERANCE_NOT_MET, 0.9, True),
        (Outcome.OK, 1.0, True),
        (Outcome.RIM_REACHED, 1.0, True),
        (Outcome.STEP_LIMIT, 1.0, False),
    ):
        assert analysis.answers(analysis.Reply(mu, share * mu, (status.value,))) == says, (status, share)


def test_the_body_that_is_farthest_beyond_its_own_error_fails() -> None:
    reply, known = (
        analysis.Reply(np.array([[10.0 + off, 1.0 + 0.1 * off]]), np.array([[error, 0.01 * error]]), ("ok",))
        for off, error in ((0.05, 0.1), (0.0, 0.0))
    )
    entry = analysis.judged(reply, [known], 1e-1, False, ())
    assert (entry.verdict, entry.reason[:14]) == ("FAILED", "mu_2 is off by"), "mu_1 is off by more, and allowed to be"


@pytest.mark.parametrize(
    ("off", "claimed", "finer", "verdict"),
    [
        (0.9e-3, 1e-3, 1e-6, "converged"),
        (1.5e-3, 1e-3, 1e-6, "FAILED"),
        (0.0, 1e-3, 2e-3, "FAILED"),  # the finer run knows it less well than claimed, and not to a tenth of 1e-2
        (0.0, 1e-4, 9e-4, "converged"),
        (0.0, 1.5e-2, 1e-6, "FAILED"),
        (0.9e-2, np.nan, 1e-6, "converged"),
        (1.5e-2, np.nan, 1e-6, "limit"),
    ],
)
def test_an_error_half_of_what_it_should_be_fails(off: float, claimed: float, finer: float, verdict: str) -> None:
    mu = np.array([[1.0, 2.0], [1.0, 2.0]])
    reply = analysis.Reply(mu * [[1.0, 1.0], [1.0, 1.0 + off]], claimed * mu, ("ok", "ok"))
    assert analysis.judged(reply, [analysis.Reply(mu, finer * mu, ("ok", "ok"))], 1e-2, False, ()).verdict == verdict
