"""The measured trade and how the cost grows: fronts, errors along every parameter, checked solutions, known slopes."""

import inspect
import re
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from known_analyses import computed
from known_results import known_trade
from places import scene_text
from rich.console import Console
from scipy.stats import linregress

from comparison.evidence.tradeoff import analysis, command, feature, growth, outside, single_runs, trade
from comparison.evidence.tradeoff.analysis import Measurement, SettingResult, join_results, make_entry, sample_phases
from comparison.evidence.tradeoff.growth import (
    QUANTITIES,
    STORED,
    CostGrowth,
    fit_slope,
    make_cost_series,
    split_upper_body,
)
from comparison.evidence.tradeoff.settings import QUESTIONS, REFERENCE_RUN, Setting, TradeoffQuestion, list_settings
from comparison.evidence.tradeoff.trade import find_error_quantile, is_pareto_optimal, load_trades, mark_pareto_fronts
from comparison.runner.output import publish_files
from comparison.study.batches import import_function
from reference import amplification
from reference.problem import Amplification, Scene, load_scene
from reference.support.command import UsageError

SCENE = load_scene("fig3-I")


SETTING = Setting("exact", "one", "step", "", 1.0, False, False, REFERENCE_RUN, {}, 1.0)


def test_nothing_on_the_front_is_beaten_and_all_else_is() -> None:
    pairs = [(1.0, 1e-2), (2.0, 1e-3), (3.0, 1e-4), (2.5, 2e-3), (1.0, 1e-1), (4.0, float("inf"))]
    assert [is_pareto_optimal(pair, pairs) for pair in pairs] == [True, True, True, False, False, False]
    assert is_pareto_optimal(pairs[0], [pairs[0]] * 2), "two that are alike"


def test_the_share_of_points_is_met_by_a_value_that_occurred() -> None:
    assert find_error_quantile(np.array([1.0, 2.0, 3.0, 40.0]), 0.95) == 40.0
    assert find_error_quantile(np.array([np.nan]), 0.5) is None
    share = np.arange(101.0)[:, None]
    shares = make_entry(SETTING, SettingResult(1.0 + share, share * (1.0 + share), 1.0, np.nan), np.ones((101, 1)))
    assert (shares.median, shares.most, shares.error_estimate) == ([50.0], [95.0], [95.0])


def test_a_setting_with_gaps_is_not_on_the_front() -> None:
    ones = np.ones((3, 1))
    good, lost, uneven, other = (
        make_entry(SETTING, SettingResult(ones * mu, 0.1 * ones * mu, seconds, np.nan), ones)
        for mu, seconds in (
            (1.1, 3.0),
            ([[1.0], [np.nan], [1.0]], 1.0),
            ([[1.0], [1.0], [1.5]], 6.0),  # a smaller median, a larger error at 95 %
            (1.0, 0.1),
        )
    )
    marked = mark_pareto_fronts([good, lost, uneven, replace(other, model_error=True)], 1)
    assert [setting.pareto_front for setting in marked] == [(True,), (False,), (False,), (False,)]
    partly = np.array([[1.0, np.nan], [1.0, 1.0]])
    one = make_entry(SETTING, SettingResult(partly, 0.1 * partly, 1.0, np.nan), np.ones((2, 2)))
    assert (lost.answered, one.answered) == (2, 1), "a value of every body is an answer"
    assert (good.seconds, good.error_estimate) == (1.0, [pytest.approx(0.1)]), "per point, and relative"
    parts = [
        SettingResult(ones[:2], ones[:2], part, step, why) for part, step, why in ((2.0, 0.1, ""), (4.0, 0.3, "no"))
    ]
    both = join_results(parts)
    assert (both.seconds, both.step, both.error_message) == (6.0, pytest.approx(0.2), "no")
    better = replace(good, question="small", seconds=0.5 * good.seconds, most=tuple(0.5 * each for each in good.most))
    assert [each.pareto_front for each in mark_pareto_fronts([good, better], 1)] == [(True,)] * 2, "of other equations"
    better = replace(better, question=good.question)
    assert [each.pareto_front for each in mark_pareto_fronts([good, better], 1)] == [(False,), (True,)]


def test_phase_pairs_without_a_reference_solution_take_no_setting_off_the_front() -> None:
    """Planted: one motion that ends at the rim makes every setting incomplete, and the front empty."""
    solution = np.array([[2.0, 4.0], [np.nan, np.nan], [2.0, 4.0]])
    full, gap, nothing = (
        make_entry(SETTING, SettingResult(mu, 0.1 * mu, 6.0, np.nan), reference_solution)
        for mu, reference_solution in (
            (1.1 * solution, solution),
            (np.where([[False], [False], [True]], np.nan, solution), solution),
            (solution, np.full((3, 2), np.nan)),
        )
    )
    assert [(each.points, each.answered, each.complete) for each in (full, gap, nothing)] == [
        (2, 2, True), (2, 1, False), (0, 0, False)
    ]  # fmt: skip
    assert full.seconds == 2.0, "over all phase pairs, which it was asked for"
    assert [each.pareto_front for each in mark_pareto_fronts([full, gap, nothing], 2)] == [
        (True, True), (False, False), (False, False)
    ]  # fmt: skip
    found = analysis._make_solved_question(QUESTIONS[0], SettingResult(solution, 0.01 * solution, 6.0, np.nan), [gap])
    assert found.checks[0].startswith("it answers at 2 of them, its own error estimate is 1e-02 at most")
    for unknown, line in ((0.0, "no amplification has a relative error"), (np.nan, "it answers at none of them")):
        none = SettingResult(np.full((3, 2), unknown), np.full((3, 2), unknown), 6.0, np.nan)
        assert analysis._make_solved_question(QUESTIONS[0], none, [gap]).checks[0] == line
        assert make_entry(SETTING, none, solution).error_estimate == [None, None]


def test_a_motion_shorter_than_the_warming_one_is_not_lengthened(monkeypatch: pytest.MonkeyPatch) -> None:
    """Planted: warmed up over 0.2 s, 2e8 of its periods, which no scene may have; the first answer was lost."""
    fast = SCENE.with_values({"duration": 3e-6, "excitation.periods": [1e-9, 2e-9]})
    durations = []
    monkeypatch.setattr(analysis, "_warmed_functions", set())
    monkeypatch.setattr(analysis, "_call_function", lambda scene, *rest: durations.append(scene.duration))
    for scene in (fast, SCENE):
        analysis._warmed_functions.clear()
        analysis.measure_setting(Measurement(scene, ("a:b", {}), sample_phases(1)))
    assert durations == [3e-6, 3e-6, 0.2, SCENE.duration]


def test_a_reference_solution_states_its_error_its_cost_and_what_agrees() -> None:
    mu, share = np.array([[1.0, 2.0], [4.0, 5.0], [7.0, 8.0]]), np.array([[0.01, 0.03], [0.02, 0.005], [0.01, 0.01]])
    plain = make_entry(SETTING, SettingResult(mu, mu, 1.0, np.nan), mu)
    entries = [
        replace(plain, method=method, value=value, most=most, model_error=method.startswith("v_reg"))
        for method, value, most in (
            ("SciPy LSODA", 1e-4, (1e-4, 2e-4)),
            ("SciPy Radau", 1e-6, (3e-5, 1e-6)),
            ("SciPy Radau", 1e-8, (1e-6, None)),
            ("translational engine, one run", 0.5, (2e-3, 1e-3)),
            ("v_reg", 0.1, (0.0, 0.0)),
        )
    ]
    entries.append(replace(entries[0], method="SciPy DOP853", most=(1e-9, 1e-9), question="regularised"))
    entries.append(replace(entries[0], method="SciPy DOP853", most=(1e-9, 1e-9), answered=0))
    found = analysis._make_solved_question(QUESTIONS[0], SettingResult(mu, share * mu, 6.0, np.nan), entries)
    assert (found.points, found.error) == (3, pytest.approx(0.03))
    assert found.reference_solution == "the reference at a tolerance of 1e-10, 2 s per point"
    assert found.checks == [
        "its own error estimate is 3e-02 at most, its tolerance is not met: no smaller error can be told",
        "SciPy Radau (step 1e-06), another method on the same equations, agrees with it to 3e-05 at 95 %",
        "translational engine, one run (step 5e-01), other code from the bodies up, agrees with it to 2e-03 at 95 %",
    ]


@pytest.mark.parametrize(
    ("name", "friction"),
    [("fig3-I", 0.1), ("fig3-I", {"slow": 0.05, "fast": 0.15, "rate": 0.9}), ("fig4-viscous", None)],
    ids=str,
)
def test_scipy_has_the_factors_of_the_equations(monkeypatch: pytest.MonkeyPatch, name: str, friction: object) -> None:
    for function in ("compute_state_derivative", "compute_state_derivatives", "exact_acceleration"):  # not compiled
        monkeypatch.setattr(outside, function, getattr(outside, function).py_func)
    bodies = [{"mass": 1.0}, *({"mass": 0.5, "period": [0.6, 0.5], "damping": ratio} for ratio in (0.3, 0.1))]
    values = {"duration": 0.8, "bodies": bodies} | ({"isolator.friction": friction} if friction else {})
    along = load_scene(name).amplitudes[:2].tolist()
    scene = load_scene(name).with_values({**values, "excitation.amplitudes": [*along, [0.7, -0.4]]}).with_amplitude(3.0)
    expected = amplification(scene, [(0.3, 1.1)], regularization=None if scene.lubricated else 1e-2)
    found = outside.solve_factors_by_scipy(scene, [(0.3, 1.1)], "LSODA", 1e-8, 1e-2)
    np.testing.assert_allclose(found, expected.mu, rtol=2e-6)


def test_single_runs_have_the_factors_at_the_step_that_is_asked() -> None:
    short, phases = load_scene("fig3-I").with_values({"duration": 0.5}), [(0.3, 1.1)]
    expected = amplification(short, phases, regularization=1e-3).mu
    loose, tight = (
        single_runs.run_reference_once(short, phases, inside, regularization=1e-3) for inside in (1e-3, 1e-8)
    )
    assert np.abs(tight[0] / expected - 1.0).max() < 1e-5
    assert 0.5 > loose[1] > tight[1] > 1e-4, "mean steps, s"
    pairs = [(0.3, 1.1), (3.0, 2.0)]
    steps = [single_runs.run_reference_once(short, each, 1e-6)[1] for each in (pairs[:1], pairs[1:], pairs)]
    assert steps[0] != pytest.approx(steps[1], rel=0.02)
    assert 2.0 / steps[2] == pytest.approx(1.0 / steps[0] + 1.0 / steps[1], rel=1e-12), "of as many steps on average"
    runs = (single_runs.run_engine_once(short, phases, "translational", 1e-3, step) for step in (1.0, 16.0))
    usual, coarse = (np.abs(run / expected - 1.0).max() for run in runs)
    assert usual < 1e-3 < coarse
    assert (
        np.abs(single_runs.run_at_constant_step(short, phases, "trapezoidal", 5e-4, 1e-3) / expected - 1.0).max() < 5e-3
    )


def test_truths_are_a_hundred_times_tighter_than_tolerances() -> None:
    pairs = sample_phases(48)
    assert (pairs[:3] == sample_phases(3)).all(), "the points of a smaller sample are the first of a larger one"
    assert 0.0 <= pairs.min() < 0.5 < 5.8 < pairs.max(axis=0).min() <= pairs.max() < 2.0 * np.pi
    every = list_settings(load_scene("fig3-I"))
    for question in QUESTIONS:
        of_question = [setting for setting in every if setting.question == question.key]
        side = "multibody" if question.key == "spatial" else "reference"
        held = [setting.value for setting in of_question if setting.controlled and side in setting.function]
        assert question.reference_solution[1]["tolerance"] <= 1.0001e-2 * min(held)
    quick: dict[str, set[float]] = {}
    for each in list_settings(SCENE, quick=True):
        quick.setdefault(each.method, set()).add(each.value)
    names = "translational engine, one run: step", "SciPy LSODA", "SciPy Radau", "Exudyn, RK44"
    assert [quick[name] for name in names] == [{8.0, 1.0}, {1e-4, 1e-10}, {1e-4, 1e-8}, {4e-4, 1e-4}]
    loosest = {each.method: each.value for each in reversed(every) if each.question == "exact"}
    assert [loosest[f"reference, {runs}"] for runs in ("two runs and an estimate", "one run")] == [1e-2, 1e-1]
    for each in every:
        inspect.signature(import_function(each.function)).bind(SCENE, sample_phases(1), **each.settings)
    model_errors = [each for each in every if each.model_error]
    for each in model_errors:
        assert each.settings == {"tolerance": 1e-6, "regularization": each.value}
        faster = "reference:amplification", {"cutoff": each.value, "tolerance": 1e-10}
        assert each.against == (faster if "faster than v_reg" in each.method else None)
    assert len(model_errors) == 2 * 6


def test_every_measurement_ends() -> None:
    """Planted: an explicit method on stiff links computes for hours, and takes every other setting with it."""
    tasks = analysis.TradeOff([SCENE, SCENE.with_values({"duration": 2000.0})]).tasks()
    assert {round(task.timeout - 20.0 * task.seconds, 6) for task in tasks} == {60.0}
    assert max(task.timeout for task in tasks) == 20.0 * 500.0 + 60.0, "500 s of a phase pair at the finest step"


def test_a_taller_and_longer_scene_is_announced_with_its_own_time() -> None:
    usual = load_scene("fig3-I")
    tall = split_upper_body(usual, 6).with_values({"duration": 30.0})
    expected = [sum(task.seconds for task in analysis.TradeOff([scene], True).tasks()) for scene in (usual, tall)]
    assert expected[1] == pytest.approx(4.5 * expected[0]), "three times the bodies, 1.5 times the duration"


def test_a_time_limit_makes_no_cost_zero(monkeypatch: pytest.MonkeyPatch) -> None:
    """Planted: on Linux the clock of a process with a limit goes in steps of 4 ms, and most settings cost nothing."""
    for own, whole, expected in ((25e-5, 0.0, 25e-5), (25e-5, 4e-3, 25e-5), (0.5, 8.0, 7.99)):
        clocks = iter([(1.0, 2.0), (1.0 + own, 2.0 + whole)])
        monkeypatch.setattr(analysis, "_read_clocks", lambda clocks=clocks: next(clocks))
        found = analysis._call_function(SCENE, sample_phases(1), f"{__name__}:_known", {"gap": 0.0})
        assert found.seconds == pytest.approx(expected)
    monkeypatch.undo()
    begin = analysis._read_clocks()
    sum(range(10**5))
    assert 0.0 < analysis._measure_since(begin) < 10.0


def test_no_method_is_recommended_beyond_what_its_reference_solution_can_tell() -> None:
    """Planted: an error of 0 against a solution that is itself known to 200 only."""
    ones = np.ones((2, 1))
    solution = SettingResult(ones, 3e-4 * ones, 1.0, np.nan)
    entry = make_entry(SETTING, SettingResult(ones, 0.1 * ones, 1.0, np.nan), ones)
    found = analysis._make_solved_question(QUESTIONS[0], solution, [entry])
    off = replace(entry, method="translational engine", most=(7e4,))
    assert analysis._word_agreements(QUESTIONS[0], [off])[0].endswith(", differs from it by 7e+04 at 95 %")
    assert found.checks[0].endswith("3e-04 at most, its tolerance is not met: no smaller error can be told")
    measured = replace(known_trade("fig3-I"), bodies=1, questions=[found], entries=[entry])
    [answer] = feature.word_fastest_methods(measured)
    assert answer["text"] == (
        "for 1e-02 ask one, step 1 (500 ms, no error estimate); for 1e-03 ask one, step 1 (500 ms, no error estimate); "
        "for 1e-04 not compared, the reference solution has an error of 3e-04; "
        "for 1e-06 not compared, the reference solution has an error of 3e-04."
    )


LASTED: list[float] = []  # durations of the scenes that `_known` was asked for


def _known(scene: Scene, phases: np.ndarray, gap: float, tolerance: float = 1e-6) -> Amplification:
    """mu = 1 + gap at every phase pair."""
    LASTED.append(scene.duration)
    mu = np.full((len(phases), 2), 1.0 + gap)
    nothing = np.full(len(phases), np.nan)
    return Amplification(mu, 1e-3 * mu, np.full(len(phases), "ok"), nothing, 0.0)


def test_the_command_measures_nothing_twice(tmp_path, monkeypatch, capsys):
    path, gaps = f"{__name__}:_known", (1e-3, 1e-2)
    question = TradeoffQuestion("exact", "known", (path, {"gap": 0.0, "tolerance": 1e-9}), 5, 3, 100.0)
    known = [Setting("exact", "one", "gap", "", gap, False, False, path, {"gap": gap}, 100.0) for gap in gaps]
    monkeypatch.setattr(analysis, "list_settings", lambda scene, quick: known)
    monkeypatch.setattr(analysis, "list_questions", lambda scene: [question])
    stored = trade.STORED.as_json(trade.TradeFile(trade.SCHEMA, [known_trade("fig3-II")]))
    publish_files(tmp_path / "out", {trade.FILE: stored}, "a test")
    words = ["fig3-I", "--quick", "--jobs", "1", "--out", str(tmp_path / "out")]
    monkeypatch.setattr(analysis, "_warmed_functions", set())
    LASTED.clear()
    assert command.main(words, ThreadPoolExecutor) == 0
    assert [0.2, *[20.0] * 9] == LASTED, "what is compiled on first use is called before it is timed"
    lines = capsys.readouterr().out.splitlines()
    begin = lines.index(f"{load_scene('fig3-I').title} (fig3-I)")
    assert lines[begin + 1] == "Unless they are stored: about 908 s with 1 workers.", "nine phase pairs, and imports"
    assert lines[-1] == f"Trade: {tmp_path / 'out' / trade.FILE}, and SCENE-tradeoff.nc next to it."
    before, first = load_trades(tmp_path / "out")
    assert (before.scene, len(before.entries)) == ("fig3-II", 2), "other scenes keep theirs"
    assert [entry.most for entry in first.entries] == [pytest.approx([gap] * 2) for gap in gaps]
    values = xr.load_dataset(tmp_path / "out" / "fig3-I-tradeoff.nc", engine="h5netcdf")
    assert dict(values.sizes) == {"setting": 2, "point": 3, "body": 2}
    assert np.stack([values["alpha1"], values["alpha2"]], axis=1).tolist() == sample_phases(3).tolist()
    stated = {name: values[name].values.tolist() for name in ("value", "question", "method", "parameter", "unit")}
    assert stated == {"value": list(gaps), "question": ["exact"] * 2, "method": ["one"] * 2, "parameter": ["gap"] * 2,
                      "unit": [""] * 2}  # fmt: skip
    assert values["seconds"].values.tolist() == [entry.seconds for entry in first.entries]
    assert values["mu"][:, 0, 0].values == pytest.approx([1.001, 1.01])
    assert (values["reference_solution"] == 1.0).all()
    assert values["error_estimate"][0].values == pytest.approx(np.full((3, 2), 1.001e-3))
    monkeypatch.setattr(analysis, "import_function", lambda path: pytest.fail("it was measured again"))
    assert command.main(words, ThreadPoolExecutor) == 0
    _, again = load_trades(tmp_path / "out")
    assert (again.entries, again.run["stored_before"]) == (first.entries, 9)


def test_a_question_with_fewer_points_leaves_the_rest_open() -> None:
    entries, phases = known_trade("fig3-I").entries, sample_phases(3)
    known = trade.label_values(entries, {"mu": [np.full((3, 2), 1.5), np.full((2, 2), 2.5)]}, phases)
    assert known["mu"][:, :, 1].values.tolist() == [[1.5] * 3, [2.5, 2.5, pytest.approx(np.nan, nan_ok=True)]]


def test_a_known_slope_is_found_in_the_larger_half() -> None:
    values = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0]
    seconds = [1.0, 1.0, 1.0, *(value**1.5 for value in values[3:])]
    assert fit_slope(values, seconds) == pytest.approx((1.5, 0.0), abs=1e-12)
    assert fit_slope([*values, 64.0], [*seconds, np.nan])[0] == pytest.approx(1.5), "no answer does not count"
    assert np.isnan(fit_slope(values[:2], seconds[:2])[0])
    odd, costs = [1.0, *values], [1.0, 1.0, 1.0, 5.0, *seconds[3:]]
    assert fit_slope(odd, costs)[0] == pytest.approx(linregress(np.log(odd[3:]), np.log(costs[3:])).slope), "four of 7"
    line = linregress(np.log([1.0, 2.0, 4.0]), np.log([1.0, 3.0, 5.0]))
    assert fit_slope([1.0, 2.0, 4.0], [1.0, 3.0, 5.0]) == pytest.approx((line.slope, line.stderr))


def test_a_tall_scene_has_its_bodies_one_above_the_other() -> None:
    scene = split_upper_body(SCENE, 6)
    heights = [body.height for body in scene.bodies]
    assert (len(heights), heights) == (6, sorted(heights))
    assert scene.isolator.ring >= 6.0
    bare = SCENE.with_values({"bodies.1.height": None})
    assert [body.height for body in split_upper_body(bare, 3).bodies[1:]] == [1.0, 2.0]
    assert scene.masses[1:].tolist() == pytest.approx([SCENE.masses[1] / 5.0] * 5)
    assert scene.amplitudes.tolist() == (3.0 * SCENE.amplitudes).tolist(), "else friction holds it"
    assert [(each.name, each.unit) for each in QUANTITIES] == [("bodies", ""), ("duration", "s"), ("phase pairs", "")]
    assert QUANTITIES[1].scene(SCENE, 30.0).duration == 30.0


def test_the_front_is_printed_with_median_and_95_percent(capsys: pytest.CaptureFixture[str]) -> None:
    first, second = (measured := known_trade("fig3-I")).entries
    quicker = replace(first, method="other", value=0.5, unit="s", seconds=1e-3, pareto_front=(False, True))
    lacking = {"key": "none", "title": "nothing", "points": 7, "checks": ["it fails", "so does that"]}
    listed = [*measured.questions, replace(measured.questions[0], **lacking)]
    entries = [replace(first, pareto_front=(True, False)), replace(second, pareto_front=(False, False)), quicker]
    command.print_trade(Console(width=200), replace(measured, questions=listed, entries=entries))
    lines = [re.split(r"\s{2,}", line.strip()) for line in capsys.readouterr().out.splitlines()]
    heads = ["on the Pareto front of a mu", "value", "s per point", "median error", "95 %"]
    assert [line for line in lines if not {*line[0]} <= {"─"}] == [
        ["fig3-I, exact equations: 3 phase pairs"],
        ["reference solution: the reference; it agrees <with itself>"],
        heads,
        ["other", "5e-01 s", "0.001", "1e-09", "2e-09", "3e-08", "4e-08"],
        ["reference, one run", "1e-03", "0.002", "1e-09", "2e-09", "3e-08", "4e-08"],
        ["fig3-I, nothing: 7 phase pairs"],
        ["reference solution: the reference; it fails; so does that"],
        ["no setting answers at each of these phase pairs"],
    ]


def test_the_cost_is_of_a_phase_pair_or_of_a_whole_call(monkeypatch: pytest.MonkeyPatch) -> None:
    pairs_of_call = set()

    def measured(measurement: Measurement) -> SettingResult:
        """A second for every body of every phase pair."""
        mu = np.ones((len(measurement.phases), len(measurement.scene.bodies)))
        pairs_of_call.add((measurement.function[0], len(mu)))
        return SettingResult(mu, mu, float(mu.size), np.nan)

    monkeypatch.setattr(growth, "measure_setting", measured)
    few = [replace(QUANTITIES[0], values=(2, 4, 8)), replace(QUANTITIES[2], values=(4, 18))]
    monkeypatch.setattr(growth, "QUANTITIES", few)
    *bodies, pairs = computed(CostGrowth(SCENE))
    assert [each.seconds for each in bodies] == [[2.0, 4.0, 8.0]] * 3, "of every model"
    assert (pairs.quantity, pairs.seconds) == ("phase pairs", [8.0, 36.0])
    equations = [("reference:amplification", count) for count in (16, 4, 18)]
    assert pairs_of_call == {*equations, ("multibody:amplification", 1)}


def test_a_scene_that_cannot_grow_keeps_what_can_be_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    """Planted: a ValidationError of one grown scene takes all measurements with it."""
    ones = SettingResult(np.ones((1, 1)), np.ones((1, 1)), 2.0, np.nan)
    monkeypatch.setattr(growth, "measure_setting", lambda measurement: ones)
    monkeypatch.setattr(growth, "QUANTITIES", [replace(each, values=each.values[:2]) for each in QUANTITIES])
    alone = SCENE.with_values({"bodies": SCENE.model_dump(exclude_none=True)["bodies"][:1]})
    fast = alone.with_values({"duration": 1e-3, "excitation.periods": [2e-5, 3e-5]})  # at most 20 s
    found = computed(CostGrowth(fast))
    known = [[None, None]] * 3 + [[2.0, None]] * 3 + [[2.0, 2.0]]
    assert [each.seconds for each in found] == known, "no chain of a platform alone, no motion of 30 s"
    placed = SCENE.with_values({"isolator.ring": None, "isolator.supports": [[2.0, 0.0], [-1.0, 1.0], [-1.0, -1.0]]})
    tall = split_upper_body(placed, 4)
    assert (tall.isolator.supports, tall.isolator.ring, len(tall.bodies)) == (3, 4.0, 4)


def test_the_command_writes_and_prints_the_growth(monkeypatch, capsys, tmp_path):
    bodies = make_cost_series("bodies", "", "exact", (2.0, 4.0, 8.0), (0.5, 2.0, 8.0))
    workers = make_cost_series("workers", "", "exact", (1.0, 2.0), (3.0, float("nan")))
    monkeypatch.setattr(command, "compute_tasks", lambda *rest: None)
    monkeypatch.setattr(CostGrowth, "collect", lambda *rest: [bodies])
    monkeypatch.setattr(command, "measure_by_workers", lambda *rest: workers)
    assert command.main(["fig3-I", "--growth", "--out", str(tmp_path)]) == 0
    found = STORED.load(tmp_path)
    assert found.series == [bodies, workers]
    *lines, last = capsys.readouterr().out.splitlines()
    assert last == f"Growth: {tmp_path / growth.FILE}"
    rows = [line.split() for line in lines]
    assert ["bodies", "exact", "2", "0.5"] in rows
    assert ["bodies", "exact", "8", "8", "2.00", "±", "0.00"] in rows, "the slope stands in the last row"
    assert ["workers", "exact", "2", "no", "answer"] in rows


def test_workers_share_the_same_calls(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[object] = []
    timed: list[int] = []
    monkeypatch.setattr(growth, "measure_setting", calls.append)
    clock = SimpleNamespace(monotonic=lambda: timed.append(len(calls)) or float(len(timed)))
    monkeypatch.setattr(growth, "time", clock)
    monkeypatch.setattr(growth, "count_cores", lambda: 3)
    series = growth.measure_by_workers(SCENE, ThreadPoolExecutor)
    assert list(series.values) == [1.0, 2.0, 3.0]
    assert len(calls) == 3 * growth.WORKER_CALLS + 2 * (1 + 2 + 3), (
        "the same work for all, and two calls to warm each up"
    )
    assert np.diff(timed)[::2].tolist() == [growth.WORKER_CALLS] * 3, "the clock starts when all are warm"


def test_an_earlier_table_that_is_damaged_is_refused_and_stays(tmp_path: Path) -> None:
    file = tmp_path / trade.STORED.name
    for content in (b"{", b'{"schema": "another"}', b"[1, 2]"):
        file.write_bytes(content)
        with pytest.raises(UsageError, match=f"{file.name}: not a measured trade"):
            command._load_trades(tmp_path)
        assert file.read_bytes() == content


def test_two_files_of_one_name_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    """Planted: "warm: same name as warm", which tells no file."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a").mkdir()
    for file in ("warm.toml", "a/warm.toml"):
        (tmp_path / file).write_text(scene_text("fig3-I"))
    assert command.main(["warm.toml", "a/warm.toml"]) == 2
    assert capsys.readouterr().err.startswith("a/warm.toml: scene = 'warm': same name as warm.toml, which")
