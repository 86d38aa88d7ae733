"""The matrix of extremes: what is wrong is found, what is right passes, and the equations fail nowhere."""

import re
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from known_analyses import computed
from known_results import FOUND, PLAIN, fake

import multibody
from comparison.evidence.extremes import analysis
from comparison.evidence.extremes.causes import CAUSES
from comparison.evidence.extremes.columns import COLUMNS
from comparison.evidence.extremes.command import main
from comparison.evidence.extremes.engine import amplification
from comparison.evidence.extremes.matrix import STORED, CellVerdict, MatrixEntry
from comparison.evidence.extremes.rows import list_extreme_cases
from comparison.evidence.extremes.scenes import make_baseline_scene
from comparison.runner.processes import TimeLimitError, WorkerDiedError, make_process_pool
from comparison.runner.task import TaskResult
from reference.problem import Outcome, SceneError, ground_acceleration


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


def test_a_model_that_hangs_or_crashes_costs_its_cell_alone():
    asked = "hangs", "crashes", "raises", "honest"
    columns = [replace(fake(model), key=model) for model in (*asked, "no row of it")]
    matrix = computed(analysis.Extremes([replace(PLAIN, columns=asked)], columns, 2.0), Ending)
    assert matrix.columns == dict(zip(asked, asked))
    (row,) = matrix.rows
    found = {key: (entry.verdict, entry.status, entry.reason) for key, entry in row.entries.items()}
    assert found["hangs"] == ("FAILED", "time limit", "hangs: no answer within 2 s of processor time")
    assert found["crashes"] == ("FAILED", "worker died", "crashes: the worker process died 2 times (exit code 3)")
    assert found["raises"] == ("FAILED", "", "raises ZeroDivisionError: an inner fault")
    assert found["honest"][0] == CellVerdict.CONVERGED


def test_starts_at_the_friction_limit_stand_there_and_go_on_as_they_say() -> None:
    starts = {case.title: case for case in list_extreme_cases() if case.group == "start at the friction limit"}
    instants, rates = np.array([0.0, 1e-6]), {}
    for title, case in starts.items():
        scene = analysis.make_extreme_scene(case.scene)
        begin, later = ground_acceleration(scene, case.phases[0], instants)[:, 0] / (scene.dry_friction.slow * 9.81)
        assert begin == pytest.approx(1.0, rel=1e-12)
        rates[title] = (later - begin) / instants[1]
    # of cos(nu t + phase) / cos(phase) at t = 0: -nu tan(phase)
    nu = 2.0 * np.pi / scene.excitation.periods[0]
    known = {"turning there": 0.0, "rising beyond": nu * np.sqrt(3.0), "falling": -nu * np.sqrt(3.0)}
    assert rates == pytest.approx(known, abs=1e-3)


AGAINST_A_RULE = replace(PLAIN, scene=make_baseline_scene(friction=-0.1))


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
        (PLAIN, fake("raises"), "FAILED", "an inner fault"),
        (PLAIN, fake("honest", finer="raises"), "FAILED", "no finer run confirms it: none"),
        (replace(PLAIN, right=("contact lost",)), fake("honest"), "converged", "confirmed"),
        (replace(PLAIN, right=("rim reached",)), fake("at_the_rim", finer="honest"), "refused", "rim reached"),
        (PLAIN, fake("calls_nan_ok"), "FAILED", "no finite number"),
        (PLAIN, fake("lies_about_its_error"), "FAILED", "times what is claimed"),
        (PLAIN, fake("misses_the_tolerance"), "FAILED", "asked: 0.001"),
        (PLAIN, fake("refuses_what_can_be_done"), "FAILED", "but a finer run: ok"),
        (PLAIN, fake("gives_a_value_with_a_refusal"), "FAILED", "and yet a value"),
        (PLAIN, fake("invents_a_status"), "FAILED", "no answer of a model"),
    ],
)
def test_every_kind_of_answer_has_its_verdict(row, column, verdict, reason):
    cell = analysis.solve_cell(analysis.MatrixCell(row, column))
    assert (cell.verdict, reason in cell.reason) == (verdict, True), cell.reason


def test_the_equations_fail_at_no_extreme():
    groups = {"friction", "v_reg, m/s", "vertical loading, m/s^2", "outside the rules"}
    chosen = [row for row in analysis.select_quick(list(list_extreme_cases())) if row.group in groups]
    assert {row.group for row in chosen} == groups
    by_engine = {cell.row.group for cell in analysis.list_cells(chosen) if cell.column.key == "translational"}
    assert by_engine == {"outside the rules"}
    for cell in analysis.list_cells(chosen):
        entry = analysis.solve_cell(cell)
        assert entry.verdict != CellVerdict.FAILED, (cell.row.title, cell.column.key, entry.reason)
        assert entry.total >= entry.seconds, "with its finer runs"


QUANTITIES = {
    "friction": lambda at: at.friction_coefficient,
    "lubrication, s/m": lambda at: at.friction_coefficient,
    "rate of friction, s/m": lambda at: (at.dry_friction.rate, at.dry_friction.slow, at.dry_friction.fast),
    "amplitude, m/s^2": lambda at: (at.amplitudes[0, 0], at.friction_coefficient),
    "vertical loading, m/s^2": lambda at: at.amplitudes[2, 0],
    "rho, m": lambda at: (at.radius, np.abs(at.amplitudes).max()),
    "travel, m": lambda at: at.isolator.travel,
    "bodies N": lambda at: len(at.bodies),
    "total mass, kg": lambda at: at.total_mass,
    "platform's share of the mass": lambda at: at.masses[0] / at.total_mass,
    "link periods, s": lambda at: at.bodies[1].period[0],
    "damping of the links, of critical": lambda at: (*np.unique(at.bodies[1].damping), at.bodies[1].period[0]),
    "axial stiffness of the bars, N": lambda at: at.bodies[1].bars.axial_stiffness,
    "positions of supports": lambda at: (
        9 if len(at.isolator.supports) == 9 else -np.sort(-np.ptp(at.isolator.supports, axis=0))),
    "harmonics": lambda at: 1.0 / np.array(at.excitation.periods),
    "load over the buckling load of bars": lambda at: 9.81 / (4.0 * np.pi**2 * at.bodies[1].bars.bending_stiffness),
    "decay, 1/s": lambda at: at.excitation.decay[1],
    "duration, s": lambda at: at.duration,
    "three supports, ring in m": lambda at: at.isolator.ring,
    "offset over the ring": lambda at: np.hypot(*at.offsets[1]) / at.isolator.ring,
    "yaw, rad": lambda at: at.yaws[1],
}  # fmt: skip


REFUSALS = {
    "1.000001": "bodies.1.bars: weight on each bar in N", "1, under a body 6 m above": "topple under their weight",
    "0.5": "[-0.7071, -0.7071] would carry nothing", "1": "[-0.7071, -0.7071] would carry nothing",
    "on one line": "the supports are on one line", "friction -0.1": "isolator.friction = -0.1: must",
    "mass 0": "bodies.0.mass = 0.0: must", "duration 0": "duration = 0.0: must",
    "travel beyond the radius": "isolator.travel = 0.3: must be below the radius",
    "radius beyond double precision": "isolator.period = 1e+200: must",
    "amplitude not a number": "excitation.amplitudes.0.0 = nan: must",
}  # fmt: skip


def test_a_row_has_the_quantity_that_it_names():
    every, seen = list(list_extreme_cases()), set()
    for row in every:
        title = row.title.replace("-g exactly", "9.81")
        numbers = [float(each) for each in re.findall(r"(?<![\w.^])(?:\d[.\d]*(?:e[-+]?\d+)?|inf)", title)]
        if row.group in QUANTITIES and numbers and not row.invalid:
            found = np.ravel(QUANTITIES[row.group](analysis.make_extreme_scene(row.scene)))
            assert found[: len(numbers)] == pytest.approx(numbers, rel=1e-2), row.name
            seen.add(row.group)
        if row.group == "rho, m" and not row.invalid:
            at = analysis.make_extreme_scene(row.scene)
            rise = 0.0 if at.flat else max(at.radius - 0.25, 0.0)
            assert [body.height for body in at.bodies] == pytest.approx([0.2 + rise, 1.2 + rise]), row.name
        for key in ("regularization", "cutoff", "contact_stiffness", "step", "tolerance"):
            if key in row.settings and not (key == "tolerance" and row.amplification) and not row.invalid:
                assert row.settings[key] == pytest.approx(float(row.title)), row.name
    assert seen == {*QUANTITIES}
    cells = [((cell.row.group, cell.row.title), cell.column.key) for cell in analysis.list_cells(every)]
    asked = {*cells}
    assert (len(every), len(cells), len(asked)) == (171, 609, 609), "no two are called alike"
    tasks = analysis.Extremes(every, limit=7.0).tasks()
    assert {(task.argument.row.quick, task.argument.column.key, task.seconds, task.timeout) for task in tasks} == {
        *((True, column.key, column.seconds, 7.0) for column in COLUMNS),
        *((False, column.key, 30.0, 7.0) for column in COLUMNS[:4]),
    }
    waiting = {(task.argument.column.key, task.needs_compiled_reference) for task in tasks}
    assert waiting == {(column.key, column.key != "spatial") for column in COLUMNS}, "they ask no equations"
    refused = {row.title: row.scene for row in every if row.invalid and not row.settings}
    assert refused.keys() == REFUSALS.keys()
    for title, stated in refused.items():
        with pytest.raises(SceneError, match=re.escape(REFUSALS[title])):
            analysis.make_extreme_scene(stated)
    for column in COLUMNS:
        assert all(finer <= 0.1 * column.tolerance * (1.0 + 1e-9) for _, _, finer in column.finer), column.key
    assert {(extreme, model) for extreme, models in CAUSES.items() for model in models} <= asked


@pytest.mark.long
def test_the_equations_fail_at_none_of_the_extremes():
    extremes = analysis.Extremes(analysis.select_quick(list(list_extreme_cases())), limit=120.0)
    matrix = computed(extremes, make_process_pool)
    assert [
        (row.group, row.title, title, cell.reason) for row, title, cell in matrix.cells_of(CellVerdict.FAILED)
    ] == []
    assert sum(matrix.counts().values()) >= 120


def test_the_command_names_limits_and_failures(tmp_path, monkeypatch, capsys):
    columns = tuple(replace(fake(model), key=model) for model in ("calls_nan_ok", "unable", "at_the_rim", "honest"))
    plain = replace(PLAIN, columns=tuple(each.key for each in columns))
    monkeypatch.setattr("comparison.evidence.extremes.command.COLUMNS", columns)
    monkeypatch.setattr("comparison.evidence.extremes.command.list_extreme_cases", lambda: iter([plain]))
    assert main(["--jobs", "1", "--limit", "7", "--out", str(tmp_path / "report")], ThreadPoolExecutor) == 1
    assert STORED.load(tmp_path / "report").run["limit"] == 7.0
    limit, failed, counts, *_ = capsys.readouterr().out.splitlines()[-5:]
    assert limit == "limit: anything plain, unable: step limit"
    assert failed == "FAILED: anything plain, calls_nan_ok: ok, but no finite number"
    assert counts.endswith(": 1 converged, 1 refused, 1 limit, 1 FAILED.")
    monkeypatch.setattr(analysis.Extremes, "collect", lambda *rest: FOUND)
    main(["--jobs", "1", "--out", str(tmp_path / "report")], ThreadPoolExecutor)
    counts = "1 converged, 0 refused, 1 limit, 1 FAILED"
    assert f"1.0 s of processor time: {counts}" in capsys.readouterr().out
    assert FOUND.count_line == f"3 cells: {counts}"


def test_levels_begin_at_the_stated_stiffness_and_step(monkeypatch: pytest.MonkeyPatch) -> None:
    brief, asked = analysis.make_extreme_scene(make_baseline_scene(duration=0.5)), {}
    usual, *more = multibody.levels(brief, "translational", 1e-2, 1e-3)
    monkeypatch.setattr("multibody.amplification", lambda *rest, levels, **settings: asked.update(levels=levels))
    amplification(brief, [(0.3, 1.1)], contact_stiffness=1e4)
    assert asked["levels"][0].penetration == pytest.approx(brief.total_mass * 9.81 / (1e4 * brief.radius))
    first, *found = (level.penetration for level in asked["levels"])
    shares = zip(found, more, (1.0 / 3.0, 2.0 / 3.0, 1.0, 1.0, 1.0))
    assert all(got == pytest.approx(first ** (1.0 - s) * level.penetration**s) for got, level, s in shares)
    amplification(brief, [(0.3, 1.1)], step=0.1)
    assert asked["levels"][0].step * np.sqrt(brief.radius / 9.81) == pytest.approx(0.1)
    longer = asked["levels"][0].step / usual.step
    assert asked["levels"][0].error_floor / usual.error_floor == pytest.approx(longer**2)
    assert asked["levels"][0].max_divisions - usual.max_divisions == np.ceil(np.log(longer) / np.log(4.0))


def test_the_engine_does_the_work_that_a_row_allows(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[Any] = []
    monkeypatch.setattr(analysis, "import_function", lambda path: lambda *given, **settings: asked.append(settings))
    column = replace(fake("honest"), settings={"max_work": 6e5})
    analysis.solve_cell(analysis.MatrixCell(replace(PLAIN, max_work=123.0), column))
    assert asked == [{"max_work": 123.0, "tolerance": 1e-3}]


def test_a_limit_states_its_cause_and_no_other_verdict_does(monkeypatch):
    monkeypatch.setitem(CAUSES, (PLAIN.group, PLAIN.title), {"fake": "the fake gives up"})
    assert analysis.solve_cell(analysis.MatrixCell(PLAIN, fake("unable"))).reason == "step limit: the fake gives up"
    assert "gives up" not in analysis.solve_cell(analysis.MatrixCell(PLAIN, fake("honest"))).reason


def test_a_value_with_an_error_as_large_as_itself_is_not_confirmed() -> None:
    mu, status = np.array([[1.0, 2.0], [3.0, 4.0]]), (Outcome.TOLERANCE_NOT_MET.value,) * 2
    for shares, claims in (([1.0, 1.0], False), ([1.0, 0.9], True), ([[1.0, 1.0], [0.9, 1.0]], True)):
        assert analysis.makes_checkable_claim(analysis.ModelAnswer(mu, shares * mu, status)) == claims


NONE, BOTH, ONE = (np.nan, np.nan), (1.0, 2.0), (1.0, np.nan)


@pytest.mark.parametrize(("mu", "error", "finer", "status", "verdict"), [
    (ONE, 1e-5, [(BOTH, 1e-6)], "ok", "FAILED"), (ONE, np.nan, [(BOTH, 1e-6)], "ok", "FAILED"),
    (ONE, np.nan, [(NONE, np.nan)], "rim reached", "FAILED"),  # and yet a value
    (BOTH, 1e-5, [(ONE, 1e-6)], "ok", "FAILED"), (BOTH, 1e-5, [(BOTH, (1e-6, 9e-3))], "ok", "FAILED"),
    (BOTH, np.nan, [(BOTH, 1e-6), ((1.1, 2.0), 1e-6)], "ok", "converged"),  # the first is the most trusted
    (BOTH, np.nan, [((1.1, 2.0), 1e-6), (BOTH, 1e-6)], "ok", "limit"),
])  # fmt: skip
def test_a_value_is_that_of_every_body_and_of_the_finest_run(mu, error, finer, status, verdict) -> None:
    reply, *runs = (analysis.ModelAnswer(np.array([value]), np.broadcast_to(known, (1, 2)), (status,))
                    for value, known in ((mu, error), *finer))  # fmt: skip
    assert analysis.judge_answer(reply, runs, 1e-3, False, ()).verdict == verdict


def test_a_motion_that_leaves_the_model_is_refused() -> None:
    mu, verdicts = np.full((1, 2), np.nan), {}
    for outcome in Outcome:
        reply = analysis.ModelAnswer(mu, mu, (outcome.value,))
        verdicts.setdefault(str(analysis.judge_answer(reply, [reply], 1e-3, False, ()).verdict), set()).add(
            outcome.value
        )
    physics = {"rim reached", "travel reached", "contact lost", "overturned", "painleve paradox"}
    assert verdicts["refused"] == physics | {"non-finite load", "no ground motion"}
    assert verdicts["limit"] == {"step limit", "solver failed"}


def test_a_value_of_zero_is_no_infinite_error() -> None:
    """Planted: "ok with an error estimate of inf" in a sentence."""
    reply = analysis.ModelAnswer(np.zeros((1, 2)), np.zeros((1, 2)), ("ok",))
    entry = analysis.judge_answer(reply, [reply], 1e-3, False, ())
    assert (entry.verdict, entry.reason, entry.error) == (analysis.CellVerdict.FAILED, "ok with mu = 0", None)


def test_the_body_that_is_farthest_beyond_its_own_error_fails() -> None:
    reply, known = (
        analysis.ModelAnswer(np.array([[10.0 + off, 1.0 + 0.1 * off]]), np.array([[error, 0.01 * error]]), ("ok",))
        for off, error in ((0.05, 0.1), (0.0, 0.0))
    )
    entry = analysis.judge_answer(reply, [known], 1e-1, False, ())
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
    reply = analysis.ModelAnswer(mu * [[1.0, 1.0], [1.0, 1.0 + off]], claimed * mu, ("ok", "ok"))
    assert (
        analysis.judge_answer(reply, [analysis.ModelAnswer(mu, finer * mu, ("ok", "ok"))], 1e-2, False, ()).verdict
        == verdict
    )


@pytest.mark.parametrize("error", [(-1e-5, 1e-5), (1e-5, -1e-5), (1e-5, np.nan), (1e-5, 3e-3)])
def test_an_error_estimate_that_is_none_of_one_body_fails(error: tuple[float, float]) -> None:
    mu, ok = np.array([[1.0, 2.0]]), (Outcome.OK.value,)
    finer = analysis.ModelAnswer(mu, 1e-6 * mu, ok)
    verdicts = [analysis.judge_answer(analysis.ModelAnswer(mu, np.array([each]), ok), [finer], 1e-3, False, ()).verdict
                for each in (error, (1e-5, 1e-5))]  # fmt: skip
    assert verdicts == [CellVerdict.FAILED, CellVerdict.CONVERGED]


def test_an_engine_of_the_user_has_a_column_beside_the_model_that_it_is_like() -> None:
    own = replace(COLUMNS[0], key="mine", title="My engine", like=COLUMNS[0].key)
    entries = {key: MatrixEntry("converged", key) for key in (COLUMNS[0].key, "mine")}
    results: Any = SimpleNamespace(value=lambda task, failure: entries[task.argument.column.key])
    matrix = analysis.Extremes([replace(PLAIN, columns=(COLUMNS[0].key,))], [COLUMNS[0], own]).collect(results)
    assert matrix.columns == {COLUMNS[0].key: COLUMNS[0].title, "mine": "My engine"}
    assert matrix.rows[0].entries == entries
