"""
The measured trade: fronts that nothing beats, errors that fall along every parameter, reference_solutions that are
checked.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from known_analyses import collected
from known_results import known_trade

from comparison.analyses.tradeoff import analysis, command
from comparison.analyses.tradeoff.analysis import Measured, Measurement, TradeOff, entry, joined, sample
from comparison.analyses.tradeoff.settings import QUESTIONS, RUN, Question, Setting, settings
from comparison.analyses.tradeoff.trade import (
    FILE,
    MeasuredTrade,
    Trade,
    load,
    quantile,
    unbeaten,
    with_pareto_fronts,
)
from comparison.study.study import Study
from reference.problem import Amplification, Scene, load_scene

SECONDS = 1.5  # of motion: a slide and a stop


@pytest.fixture(scope="module")
def scene() -> Scene:
    return load_scene("fig3-I").with_values({"duration": SECONDS})


@pytest.fixture(scope="module")
def trade(scene: Scene) -> Trade:
    """The quick trade, without what is dear, in this process."""
    dear = "Exudyn", "Radau", "DOP853"
    planar = [setting for setting in settings(scene, quick=True) if setting.question != "spatial"]
    cheap = [setting for setting in planar if not any(name in setting.method for name in dear)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(analysis, "settings", lambda scene, quick: cheap)
        patch.setattr(
            analysis, "asked", lambda scene: [question for question in QUESTIONS if question.key != "spatial"]
        )
        (measured,) = collected(
            TradeOff(quick=True), Study((scene,), 1, 1e-3), executor=lambda jobs: ThreadPoolExecutor(1)
        )
    return measured.trade


def test_nothing_on_the_front_is_beaten_and_all_else_is() -> None:
    pairs = [(1.0, 1e-2), (2.0, 1e-3), (3.0, 1e-4), (2.5, 2e-3), (1.0, 1e-1), (4.0, float("inf"))]
    assert [unbeaten(pair, pairs) for pair in pairs] == [True, True, True, False, False, False]
    assert unbeaten(pairs[0], [pairs[0]] * 2), "two that are alike"


def test_the_share_of_points_is_met_by_a_value_that_occurred() -> None:
    assert quantile(np.array([1.0, 2.0, 3.0, 40.0]), 0.95) == 40.0
    assert quantile(np.array([np.nan]), 0.5) is None


def test_a_setting_with_gaps_is_not_on_the_front() -> None:
    setting = Setting("exact", "one", "step", "", 1.0, False, False, RUN, {}, 1.0)
    ones = np.ones((3, 1))
    good, lost, other = (
        entry(setting, Measured(ones * mu, 0.1 * ones * mu, seconds, np.nan), ones)
        for mu, seconds in ((1.1, 3.0), ([[1.0], [np.nan], [1.0]], 1.0), (1.0, 0.1))
    )
    marked = with_pareto_fronts([good, lost, replace(other, model_error=True)], 1)
    assert [setting.pareto_front for setting in marked] == [(True,), (False,), (False,)]
    assert lost.answered == 2
    assert (good.seconds, good.error_estimate) == (1.0, [pytest.approx(0.1)]), "per point, and relative"


def test_the_times_of_all_parts_add_up() -> None:
    assert joined([Measured(np.ones((2, 1)), np.ones((2, 1)), part, np.nan) for part in (2.0, 4.0)]).seconds == 6.0


@pytest.mark.long
@pytest.mark.parametrize("question", ["exact", "small", "regularised"])
def test_the_error_of_the_reference_falls_with_its_tolerance(trade: Trade, question: str) -> None:
    for method in ("reference, one run", "reference, two runs and an estimate"):
        errors = np.array([setting.most for setting in trade.methods(question)[method]], dtype=float)
        # from 1e-1 to 1e-8: a method of order 13 with steps of order 7 gains far more than a thousand
        assert (errors[-1] < 1e-8).all()


@pytest.mark.long
def test_error_estimates_of_the_reference_hold(trade: Trade) -> None:
    controlled = [setting for setting in trade.entries if setting.controlled and setting.method.startswith("reference")]
    assert controlled
    for setting in controlled:
        for error, error_estimate in zip(setting.most, setting.error_estimate, strict=True):
            assert error <= max(error_estimate, 1e-10), setting  # the reference solution is not known better


@pytest.mark.long
def test_scipy_and_the_engine_tend_to_the_truth_of_the_reference(trade: Trade) -> None:
    """The check that the diagram states: codes and methods with little in common meet."""
    for method, within in (("SciPy LSODA", 1e-7), ("translational engine, two levels", 1e-5)):
        curve = [setting for setting in trade.of("regularised") if setting.method.startswith(method)]
        assert max(curve[-1].most) < within
        assert max(curve[-1].most) < 0.1 * max(curve[0].most)
    checks = next(question.checks for question in trade.questions if question.key == "regularised")
    assert any("SciPy LSODA" in line for line in checks)
    assert any("translational engine" in line for line in checks)


@pytest.mark.long
def test_v_reg_is_a_model_error_that_falls(trade: Trade) -> None:
    curve = [setting for setting in trade.of("exact") if "faster than v_reg" in setting.method]
    errors = np.array([setting.most for setting in curve], dtype=float)
    assert len(curve) > 2
    assert all(setting.model_error and not any(setting.pareto_front) for setting in curve)
    assert (np.diff(errors[:, 1]) < 0.0).all(), "mu_2 is well conditioned: in proportion to v_reg"


def test_truths_are_a_hundred_times_tighter_than_tolerances() -> None:
    for question in QUESTIONS:
        of_question = [setting for setting in settings(load_scene("fig3-I")) if setting.question == question.key]
        side = "multibody" if question.key == "spatial" else "reference"
        held = [setting.value for setting in of_question if setting.controlled and side in setting.function]
        assert any(setting.parameter == "tolerance of mu" for setting in of_question)
        assert question.reference_solution[1]["tolerance"] <= 1.0001e-2 * min(held)


def test_the_loosest_tolerances_are_those_that_are_taken() -> None:
    """mu to within 1e-2 at worst; a single step also to within 1e-1."""
    loosest = {each.method: each.value for each in reversed(settings(load_scene("fig3-I"))) if each.question == "exact"}
    assert loosest["reference, two runs and an estimate"] == 1e-2
    assert loosest["reference, one run"] == 1e-1


def test_the_command_writes_what_the_report_reads(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    trade = known_trade("fig3-I")
    data = xr.Dataset({"mu": ("point", [1.0])})
    monkeypatch.setattr(command, "measured_trades", lambda *arguments: [MeasuredTrade(trade, data)])
    assert command.main(["fig3-I", "--quick", "--out", str(tmp_path / "out")]) == 0
    names = {file.name for file in (tmp_path / "out").iterdir()}
    assert names == {FILE, "fig3-I-tradeoff.nc", "fig3-I-tradeoff.png", "fig3-I-tradeoff.pdf", "manifest.json"}
    again = load(tmp_path / "out")
    assert again is not None
    assert json.loads(json.dumps(again[0].__dict__, default=vars)) == json.loads(
        json.dumps(trade.__dict__, default=vars)
    )
    assert "on the Pareto front" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "said"),
    [(["nowhere.toml"], "nowhere.toml"), (["--jobs", "0"], "--jobs = 0: must be a whole number from 1")],
)
def test_a_wrong_command_is_one_line(words: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert command.main(words) == 2
    line = capsys.readouterr().err
    assert said in line
    assert line.count("\n") == 1


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no pipes with names")
def test_a_pipe_in_place_of_a_trade_is_refused_in_one_line(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / FILE)
    with pytest.raises(ValueError, match="not a regular file: must be a measured trade: run python -m") as refusal:
        load(tmp_path)
    assert "\n" not in str(refusal.value)


def test_a_model_that_raises_leaves_points_without_a_value(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(path: str) -> Callable[..., object]:
        raise RuntimeError("the matrix is singular")

    monkeypatch.setattr(analysis, "imported", broken)
    measured = analysis.measure(Measurement(load_scene("fig3-I"), ("anything:at all", {}), 0, sample(2)))
    assert np.isnan(measured.mu).all()
    assert "the matrix is singular" in measured.error_message


def _known(scene: Scene, phases: np.ndarray, gap: float, tolerance: float = 1e-6) -> Amplification:
    """mu = 1 + gap at every phase pair."""
    mu = np.full((len(phases), 2), 1.0 + gap)
    nothing = np.full(len(phases), np.nan)
    return Amplification(mu, 1e-3 * mu, np.full(len(phases), "ok"), nothing, 0.0)


def test_the_command_measures_nothing_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = f"{__name__}:_known"
    question = Question("exact", "known", (path, {"gap": 0.0, "tolerance": 1e-9}), 5, 3, 100.0)
    known = [Setting("exact", "one", "gap", "", gap, False, False, path, {"gap": gap}, 100.0) for gap in (1e-3, 1e-2)]
    monkeypatch.setattr(analysis, "settings", lambda scene, quick: known)
    monkeypatch.setattr(analysis, "asked", lambda scene: [question])
    words = ["fig3-I", "--quick", "--jobs", "1", "--out", str(tmp_path / "out")]
    assert command.main(words, ThreadPoolExecutor) == 0
    first = load(tmp_path / "out")
    assert first is not None
    assert [entry.most for entry in first[0].entries] == [pytest.approx([gap, gap]) for gap in (1e-3, 1e-2)]
    values = xr.load_dataset(tmp_path / "out" / "fig3-I-tradeoff.nc", engine="h5netcdf")
    assert dict(values.sizes) == {"setting": 2, "point": 3, "body": 2}
    capsys.readouterr()
    monkeypatch.setattr(analysis, "imported", lambda path: pytest.fail("it was measured again"))
    assert command.main(words, ThreadPoolExecutor) == 0
    assert "9 of 9 tasks are in" in capsys.readouterr().out
    again = load(tmp_path / "out")
    assert again is not None
    assert (again[0].entries, again[0].questions) == (first[0].entries, first[0].questions)
    assert again[0].run["stored_before"] == 9
    again_values = xr.load_dataset(tmp_path / "out" / "fig3-I-tradeoff.nc", engine="h5netcdf")
    xr.testing.assert_equal(again_values, values)  # to the last bit, processor time included
