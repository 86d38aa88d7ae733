"""An engine of the user joins a study, is never more than its numbers allow, and spoils nothing for the others."""

import json
import os
import re
import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import user_engines
import xarray as xr
from fake_models import fake_hierarchy, smooth
from known_analyses import computed
from places import ROOT, limited_scene, scene_text
from report_texts import data_of, page_of, summary_of
from runs import Here, Run
from studies import body_comparisons, difference_rows, solved

import reference
from comparison.cli.user_models import inspect_in_worker, load_user_models, word_engine_options
from comparison.evidence.extremes.analysis import list_cells
from comparison.evidence.extremes.columns import make_user_column
from comparison.evidence.extremes.rows import list_extreme_cases
from comparison.evidence.tradeoff import analysis
from comparison.evidence.tradeoff.analysis import TradeOff
from comparison.evidence.tradeoff.feature import make_tradeoff_panels
from comparison.evidence.tradeoff.settings import QUESTIONS, list_user_settings
from comparison.runner.environment import fingerprint_engine, hash_source
from comparison.runner.processes import make_process_pool
from comparison.study.batches import drop_unusable, execute_batch
from comparison.study.models import EXACT_AS_INTEGRATED, MODEL_HIERARCHY, REGULARIZED, Model, pairs_of
from comparison.study.study import Study
from comparison.study.user_models import (
    REFERENCE_MODEL_KEYS,
    _read_answer,
    amplification,
    make_user_model,
    silence_output,
)
from comparison.surfaces.budget import list_budget_entries
from comparison.surfaces.headline import make_headline
from comparison.surfaces.missing_values import leave_out_empty_models, list_missing_values
from comparison.surfaces.surfaces import make_surface_tasks
from comparison.surfaces.waterfall import make_waterfall
from comparison.wording import percent
from reference.problem import Outcome, SceneError, load_scene, phase_grid

ONLY = ("--only", "differences")  # what the limits are held to, without pictures
DOCS = ROOT / "docs/other-engines.md"
SCENE = load_scene("fig3-I")
PHASES = np.array([(0.0, 0.0), (1.0, 2.0)])
RAISES = user_engines._solve.__code__.co_firstlineno + 1
RAISES_INSIDE = user_engines.raises_in_scipy.__code__.co_firstlineno + 3
EQUATIONS = tuple(model for model in MODEL_HIERARCHY if model.side == "reference")
ASKS = user_engines.asks_us_wrongly.__code__.co_firstlineno + 3


def supplied(function: str, name: str = "mine", like: str = "regularised") -> Model:
    return make_user_model(name, {"function": f"user_engines:{function}"}, like)


def studied(*models: Model) -> tuple[Study, xr.Dataset]:
    """A study with models of known answer and these, computed here."""
    study = Study((SCENE,), 4, 1e-3, [*fake_hierarchy(gap=0.01), *models])
    surfaces = solved(study)
    return leave_out_empty_models(study, surfaces), surfaces


def test_the_engine_of_the_documentation_appears_in_the_report(
    command: Callable[..., Run], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = DOCS.read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    (option,) = re.findall(r"--grid 4 --model (mine=\S+)\n", text)
    assert len([line for line in code.splitlines() if line.strip()]) <= 25
    (tmp_path / "my_engine.py").write_text(code, encoding="utf-8")  # in a folder of its own, as a user would have it
    (tmp_path / "short.toml").write_text(scene_text("fig3-I", ("duration = 20.0", "duration = 1.5")))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    run = command("short.toml", "--grid", "2", "--model", option, "--only", "surfaces,differences", hierarchy=EQUATIONS)
    said = [line for line in run.err.splitlines() if not line.startswith("compiling the reference, once")]
    assert (run.code, said) == (0, [])
    with xr.open_dataset(run.report / "surfaces.nc", engine="h5netcdf") as surfaces:
        mine = surfaces.sel(model="mine", scene="short")
        assert (mine["status"] == "ok").all()
        assert (mine["cost"] > 0.0).all(), "measured, though it states none"
        mu, small = mine["mu"].values, surfaces["mu"].sel(model="small-regularised", scene="short").values
    np.testing.assert_allclose(mu, small, rtol=1e-3)  # it solves what its partner does
    assert np.abs(mu / small - 1.0).max() > 1e-9, "by itself"
    shown = data_of(run.report)["scenes"][0]
    assert "mine" in [pair["key"] for pair in shown["pairs"]]
    assert not shown["models"]["mine"]["surface"]
    rows = [row for row in summary_of(run.report)["scenes"][0]["differences"] if row["pair"] == "mine"]
    assert [(row["first"], row["ratio"] <= 1.0, row["not_ok"]) for row in rows] == [("small-regularised", True, 0)] * 2


@pytest.mark.long
def test_the_engine_of_the_documentation_is_off_by_what_the_page_says() -> None:
    text = " ".join(DOCS.read_text(encoding="utf-8").split())
    (code,) = re.findall(r"```python\n(.*?)```", DOCS.read_text(encoding="utf-8"), re.DOTALL)
    names: dict[str, object] = {}
    exec(code, names)
    phases = phase_grid(4)
    mu, error = names["amplification"](SCENE, phases)  # type: ignore[operator]
    of_laws = {model.key: reference.amplification(SCENE, phases, **model.settings) for model in EQUATIONS}  # type: ignore[arg-type]
    off = {key: np.abs(mu / law.mu - 1.0).max(axis=0) for key, law in of_laws.items()}
    small = off.pop("small-regularised")
    stated = re.search(r"off by at most (\S+) % \(μ<sub>1</sub>\) and (\S+) % \(μ<sub>2</sub>\), a third", text)
    assert stated is not None
    assert (100.0 * small <= [float(number) for number in stated.groups()]).all()
    np.testing.assert_allclose(error, 1e-3 * mu)
    assert small[0] < 1e-3 / 3.0, "a third of the stated error"
    for key, (platform, _) in off.items():
        assert f"{percent(platform)} (`{key}`)" in text


PLAIN, FORM = "mine=user_engines:plain", "must be NAME=module:function[@KEY], as mine=my_engine:amplification"


@pytest.mark.parametrize(
    ("words", "rule"),
    [
        *(([word], f"--model = '{word}': {FORM}") for word in ("mine", "mine=my_engine", "mine=my engine:f")),
        *(([f"{name}=e:f"], f"--model = '{name}=e:f': NAME must begin") for name in ("", "../a", "my_name")),
        *(
            ([f"{name}=e:f"], f"--model = '{name}=e:f': {name} names a model, a difference or a limit")
            for name in ("spatial", "like-for-like", "ratio")
        ),
        (["mine=my_engine:f@spatial"], "--model = 'mine=my_engine:f@spatial': KEY must be one of small, exact, sma"),
        ([PLAIN, "--model", "mine=user_engines:raises"], f"--model = '{PLAIN}': mine is there twice"),
        ([PLAIN, "--scheduler", "tcp://127.0.0.1:1"], f"--model = '{PLAIN}': is a function of this machine"),
        ([PLAIN, "--model-limit", "soon"], "--model-limit = 'soon': must be a number from 1 to 1e+06, s of processor"),
    ],
)
def test_a_wrong_spelling_is_one_line_and_exit_code_2(command: Callable[..., Run], words: list[str], rule: str) -> None:
    run = command("fig3-I", "--grid", "2", "--model", *words)
    assert (run.code, run.out, run.report.exists(), run.err.count("\n")) == (2, "", False, 1)
    assert run.err.startswith(f"command line: {rule}")


@pytest.mark.parametrize(
    ("path", "fault"),
    [
        ("no_such_module:f", "there is no module no_such_module: run the command in the folder of its file"),
        ("user_engines:nothing", "user_engines has no nothing"),
        ("user_engines:NUMBER", "cannot be called as NUMBER(scene, phases): NUMBER is int, not a function"),
        ("user_engines:with_three", "cannot be called as with_three(scene, phases): missing a required argument"),
        ("at_once:f", "importing at_once raises ZeroDivisionError: division by zero (at_once.py, line 2)"),
        ("engine_that_exits:f", "importing engine_that_exits raises SystemExit: 0"),
        ("engine_that_lacks:f", "there is no module no_such_package"),
    ],
)
def test_what_cannot_be_imported_or_called_is_named(
    path: str, fault: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "at_once.py").write_text("\n1 / 0\n")
    (tmp_path / "engine_that_exits.py").write_text("raise SystemExit(0)\n")
    (tmp_path / "engine_that_lacks.py").write_text("import no_such_package\n")
    monkeypatch.syspath_prepend(str(tmp_path))
    said, _ = inspect_in_worker(path)
    assert said.startswith(fault)
    assert (": run the command" in said, "\n" in said) == (path.startswith("no_such"), False)


def test_an_import_that_ends_its_process_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "engine_that_leaves.py").write_text("import os\nprint('noise')\nos._exit(7)\n")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    with pytest.raises(SceneError, match="importing it ends the process: exit code 7"):
        load_user_models(["mine=engine_that_leaves:f"])
    assert sys.path[-1] == str(tmp_path), "last, so that it hides nothing"
    monkeypatch.setattr("comparison.cli.user_models.Workers", Here)
    typed = "mine=user_engines:no_such_function@small"
    with pytest.raises(SceneError) as told:
        load_user_models([typed])
    assert (told.value.key, told.value.value) == ("--model", typed)
    (model,) = load_user_models(["mine=user_engines:plain@small"], "7.5")
    assert (model.timeout, model.like) == (7.5, "small")


def test_functions_are_used_from_python_by_their_place() -> None:
    words = word_engine_options({"a": user_engines.plain, "b": "user_engines:raises@exact"})
    assert words == ["--model", "a=user_engines:plain", "--model", "b=user_engines:raises@exact"]
    with pytest.raises(SceneError, match=r"models: a = '.*<lambda>': worker processes import an engine by its name"):
        word_engine_options({"a": lambda scene, phases: None})

    def nested(scene: object, phases: object) -> None: ...

    for unnamed in (nested, partial(user_engines.plain)):
        with pytest.raises(SceneError, match="worker processes import an engine by its name: define it at the top"):
            word_engine_options({"a": unnamed})


@pytest.mark.parametrize("form", ["plain", "with_error", "as_object", "as_full_object", "as_list"])
def test_every_form_of_answer_is_read(form: str) -> None:
    study = Study((SCENE,), 2, 1e-3, [replace(supplied(form), batch=4)])
    batch = replace(study.batches()[0], phases=PHASES)
    answer = execute_batch(batch)
    np.testing.assert_array_equal(answer.mu, smooth(SCENE, PHASES, 1e-3).mu)
    error = 1e-3 if form in ("with_error", "as_full_object") else np.nan
    np.testing.assert_array_equal(answer.error, error * answer.mu)
    assert (answer.status, answer.error_message, batch.accepts(answer)) == (["ok", "ok"], "", True)
    displacement, instant = (0.1, 3.2) if form == "as_full_object" else (np.nan, np.nan)
    np.testing.assert_array_equal([answer.displacement, answer.instant], [[displacement] * 2, [instant] * 2])


@pytest.mark.parametrize(
    ("function", "message"),
    [
        ("raises", f"RuntimeError: the matrix is singular (user_engines.py, line {RAISES})"),
        ("raises_in_scipy", f"ZeroDivisionError: division by zero (user_engines.py, line {RAISES_INSIDE})"),
        (
            "asks_us_wrongly",
            f"ValueError: equations = 'none': must be one of exact, small (user_engines.py, line {ASKS})",
        ),
        ("misshapen", "ValueError: the engine's mu has shape (3,), asked: (4, 2)"),
        ("texts", "TypeError: the engine's mu has <U1 in place of real numbers"),
        ("nothing_at_all", "TypeError: the engine's mu is None"),
        ("three_parts", "TypeError: the engine returned a tuple of 3: give mu, (mu, error) or an object"),
        ("complex_numbers", "TypeError: the engine's mu has complex128 in place of real numbers"),
        ("truths", "TypeError: the engine's mu has bool in place of real numbers"),
        ("exits", "RuntimeError: the engine asked the process to end: exit code 0"),
        ("too_few_outcomes", "ValueError: the engine's status has 1 entries, asked: 4"),
    ],
)
def test_what_is_no_answer_costs_its_own_points_and_says_why(function: str, message: str) -> None:
    model = replace(supplied(function), batch=4)
    study = Study((SCENE,), 2, 1e-3, [*fake_hierarchy(), model])
    (batch,) = [batch for batch in study.batches() if batch.model == "mine" and len(batch.phases) == 4]
    result = execute_batch(batch)
    assert np.isnan(result.mu).all()
    assert set(result.status) == {Outcome.SOLVER_FAILED.value}
    assert result.error_message == message


def test_values_that_are_none_are_never_ok(monkeypatch: pytest.MonkeyPatch) -> None:
    answer = amplification(SCENE, PHASES, engine={"function": "user_engines:half"})
    assert list(answer.status) == [Outcome.VALUE_OUT_OF_RANGE, "ok"]
    assert np.isnan(answer.mu[0]).all()
    own_words = amplification(SCENE, PHASES, engine={"function": "user_engines:own_words"})
    assert list(own_words.status) == [Outcome.RIM_REACHED, Outcome.SOLVER_FAILED]
    assert own_words.error_message == "the engine's status is 'the matrix is singular'"
    nothing = amplification(SCENE, PHASES, engine={"function": "user_engines:zeros"})
    assert (list(nothing.status), nothing.mu.any(), nothing.error.any()) == (["ok", "ok"], False, False)
    assert PHASES[1].tolist() == [1.0, 2.0], "an engine has phases of its own to change"
    spent = iter([1.0, 2.0, 5.5, 5.0])
    times = lambda: SimpleNamespace(children_user=next(spent), children_system=next(spent))  # noqa: E731
    monkeypatch.setattr("comparison.study.user_models.os.times", times)
    cost = amplification(SCENE, PHASES, engine={"function": "user_engines:plain"}).cost
    assert 7.5 <= cost < 8.5, "what its processes cost is its own"


@pytest.mark.parametrize("like", REFERENCE_MODEL_KEYS)
def test_the_documentation_names_every_argument(like: str) -> None:
    table = DOCS.read_text(encoding="utf-8").split("| by name | passed | value |")[1].split("\n\n")[0]
    rows = {line.split("`")[1]: line for line in table.splitlines()[2:]}
    user_engines.told.clear()
    (batch,) = Study((SCENE,), 1, 1e-3, [supplied("takes_all", like=like)], full=True).batches()
    execute_batch(batch)
    told = dict(user_engines.told)
    assert set(told) <= set(rows)
    columns = {name: row.split("|")[2] for name, row in rows.items()}
    passed = {name for name, when in columns.items() if "always" in when or f"`@{like}`" in when}
    assert set(told) - {"full"} == passed
    number, none = rows["regularization"].split("`None`")
    assert f"`@{like}`" in (none if told["regularization"] is None else number)
    assert (f"`@{like}`" in rows["equations"]) == (told["equations"] == "small")
    user_engines.told.clear()
    execute_batch(replace(batch, settings={**batch.settings, "engine": {"function": "user_engines:listens"}}))
    assert user_engines.told == {key: told[key] for key in ("tolerance", "regularization")}, "what it names"


@pytest.mark.parametrize("function", ["plain", "raises"])
def test_a_user_engine_changes_no_other_number(function: str) -> None:
    alone, without = studied()
    study, surfaces = studied(supplied(function))
    others = [model.key for model in alone.hierarchy]
    xr.testing.assert_identical(surfaces.sel(model=others), without)
    entries = [list_budget_entries(body_comparisons(*each)) for each in ((study, surfaces), (alone, without))]
    assert repr(entries[0]) == repr(entries[1])  # repr: NaN is not equal to itself
    theirs = [row for row in difference_rows(study, surfaces) if row.pair != "mine"]
    assert repr(theirs) == repr(difference_rows(alone, without))
    keys = [task.key for task in make_surface_tasks(study) if task.argument.model != "mine"]
    assert keys == [task.key for task in make_surface_tasks(alone)]
    assert {gap.model for gap in list_missing_values(study, surfaces)} == ({"mine"} if function == "raises" else set())
    assert ("mine" in {pair.key for pair in study.pairs(SCENE)}) == (function == "plain")


def test_an_unknown_error_explains_no_difference_of_a_users_engine() -> None:
    study, surfaces = studied(supplied("off"))
    assert [pair.key for pair in study.pairs(SCENE)] == ["mine", "total", "translational", "like-for-like"]
    comparison = body_comparisons(study, surfaces)[1]
    said = (
        "mine (your engine) differs from the exact equations, v_reg by +2.1 % in the mean over 4 × 4 initial phases, "
        "and by +2.1 % at most, at "
    )
    sentence = make_headline(comparison, make_waterfall(comparison)).sentence.split(": ", 1)[1]
    assert sentence.startswith(said)
    assert (
        ": agreement within twice the errors not compared, as mine does not state every error. Exudyn (spa" in sentence
    )
    assert "equations and friction law the equations and Exudyn differ beyond twice their errors" in sentence
    assert "the two codes" not in sentence, "it would be taken for the engine of the user"


ALL, OUT, FAILED = 4, Outcome.VALUE_OUT_OF_RANGE.value, Outcome.SOLVER_FAILED.value
ABSURD = {
    **dict.fromkeys(("huge", "large", "infinite", "negative", "lowest", "longer", "huge_error", "infinite_error"), OUT),
    "no_number": FAILED,
    **dict.fromkeys(("wide", "tiny", "at_the_end_of_the_range"), "ok"),
}


def test_values_that_are_none_cost_no_other_model_its_report(command: Callable[..., Run]) -> None:
    words = ["fig3-I", "--grid", "2", "--only", "differences,surfaces,budget"]
    others = summary_of(command(*words).report)["scenes"][0]["differences"]
    keys = {function.replace("_", "-"): function for function in ABSURD}
    run = command(*words, *(word for key, of in keys.items() for word in ("--model", f"{key}=user_engines:{of}")))
    assert (run.code, run.err) == (0, "")
    scene = summary_of(run.report)["scenes"][0]
    assert [row for row in scene["differences"] if row["pair"] not in keys] == others
    page = page_of(run.report)
    shown = run.out + page + (run.report / "summary.md").read_text(encoding="utf-8")
    assert not re.search(r"\b(inf|nan) ?%|\be\+\d", shown)
    for key, function in keys.items():
        outcome, model = ABSURD[function], scene["models"][key]
        assert model["outcomes"] == {outcome: ALL}
        if outcome != "ok":
            why = f"no usable value by {key} (your engine) ({ALL} × {outcome})."
            assert f"{key} (your engine) is not compared with the exact equations, v_reg: {why}" in run.out
            assert (model["cap_share"], model["travel_share"]) == (None, None)
        assert f'<p class="engine">fig3-I, platform: {key} (your engine) ' in page


@pytest.mark.parametrize(
    ("function", "counted", "lines"),
    [
        ("not_converged", 0, 2),
        ("tolerance_not_met", 0, 2),
        ("once_not_converged", 3, 1),
        ("ok_after_all", 4, 2),
    ],
)
def test_a_status_that_is_not_ok_is_no_value_for_headline_and_gate(
    function: str, counted: int, lines: int, command: Callable[..., Run]
) -> None:
    """Nine times too large, with a small error: what is ok differs by 800 %, and what is not differs by nothing."""
    run = command(
        "fig3-I", "--grid", "2", *ONLY, "--check", "--model", f"mine=user_engines:{function}",
        hierarchy=fake_hierarchy(gap=5e-5),
    )  # fmt: skip
    assert run.code == 1
    assert run.err.count("limit broken: fig3-I: ") == lines
    assert ("800 %" in run.out) is (function == "ok_after_all")
    rows = [row for row in summary_of(run.report)["scenes"][0]["differences"] if row["pair"] == "mine"]
    assert [row["asked"] - row["unanswered"] for row in rows] == ([counted] * 2 if counted else [])
    gaps = {gap["model"]: gap["points"] for gap in summary_of(run.report)["unanswered"]}
    assert gaps == ({} if counted == ALL else {"mine": ALL - counted})
    share = summary_of(run.report)["scenes"][0]["models"]["mine"]["cap_share"]
    assert (share is None) is (function != "ok_after_all"), "nor has its motion a size"
    if "not_converged" in function:
        assert "the engine's status is 'not converged'" in run.err
    if function == "once_not_converged":
        assert "over 3 of 2 × 2 initial phases, as 1 phase pair lacks a usable value, and by 0 % at most" in run.out


@pytest.mark.parametrize(
    ("function", "body_lines"),
    [
        ("with_error", []),
        ("off_with_error", ["3 found, 2 allowed by default; largest difference +2.1 % at (0°, 0°)"] * 2),
        ("off", ["an error estimate is missing, 2 allowed by default; largest difference +2.1 % at (0°, 0°)"] * 2),
    ],
)
@pytest.mark.parametrize("limits", ["", "[acceptance]\nmedian = 1e-4\n"])
def test_an_engine_without_limits_must_agree_within_twice_the_errors(
    function: str, body_lines: list[str], limits: str, command: Callable[..., Run], tmp_path: Path
) -> None:
    scene = limited_scene(tmp_path, limits)
    run = command(
        scene, "--grid", "2", *ONLY, "--check", "--model", f"mine=user_engines:{function}",
        hierarchy=fake_hierarchy(gap=5e-5),
    )  # fmt: skip
    *broken, last = run.err.splitlines()
    assert (run.code, len(broken)) == (int(bool(body_lines)), len(body_lines))
    texts = [f"limit broken: limited: body {body}: acceptance.mine.ratio: " for body in (1, 2)]
    assert [line.startswith(text) for line, text in zip(broken, texts)] == [True] * len(broken)
    assert [line.split(": ", 4)[4].split(" at ")[0] for line in broken] == [
        line.split(" at ")[0] for line in body_lines
    ]
    assert last.startswith("--check: not checked, as no limit is stated: total, translational")
    assert last.endswith(" of limited")
    assert ("like-for-like" in last) is (not limits)
    said = (run.report / "summary.md").read_text(encoding="utf-8")
    assert "Every acceptance limit" not in said + page_of(run.report)
    assert ("acceptance limits hold" in said) is (not body_lines)
    junit = (run.report / "junit.xml").read_text(encoding="utf-8")
    case = '<testcase classname="limited" name="acceptance.mine.ratio = 2 by default"'
    assert case + (" />" if not body_lines else ">") in junit
    assert junit.count('<skipped message="not checked, as no limit is stated"') == (3 if not limits else 2)


@pytest.mark.parametrize(
    ("function", "engine", "count"), [("once_not_converged", "smooth", 1), ("with_error", "failing_point", 0)]
)
def test_missing_values_of_an_engine_break_the_gate_of_a_scene_without_limits(
    function: str, engine: str, count: int, command: Callable[..., Run], tmp_path: Path
) -> None:
    """Those of Exudyn do not: no limit is stated."""
    words = ["--grid", "4", *ONLY, "--check", "--model", f"mine=user_engines:{function}"]
    run = command(limited_scene(tmp_path, ""), *words, hierarchy=fake_hierarchy(engine))
    line = "limit broken: limited: acceptance.failed: 1 points without an answer (mine 1 of 16), 0 allowed by default"
    assert (run.code, run.err.count(line), run.err.count("acceptance.failed")) == (count, count, count)


def test_what_is_no_number_of_an_answer_is_unknown_and_costs_no_other() -> None:
    nan = np.nan
    answer = SimpleNamespace(
        mu=[[1.0, 2.0], [nan, 2.0], [3.0, 4.0]], error=[[0.1, -0.3], [0.1, 0.2], [0.3, 0.4]],
        instant=[1.0, 2.0, 1e13], displacement=[0.1, 0.2, -0.5],
    )  # fmt: skip
    found = _read_answer(answer, 3, 2, 0.5)
    assert found.status.tolist() == ["ok", "solver failed", "ok"]
    np.testing.assert_array_equal(found.error[[0, 2]], [[0.1, nan], [0.3, 0.4]])
    np.testing.assert_array_equal([found.instant, found.displacement], [[1.0, 2.0, nan], [0.1, nan, nan]])


def test_a_value_of_ours_counts_by_its_status_and_its_error() -> None:
    """Not met, with an error that is stated, is a value of our own models; any other word is none of anybody's."""
    for own, counted in (
        (True, [True, True, True, False, False, False]),
        (False, [True, True, False, False, False, False]),
    ):
        mu, error = np.full((6, 2), 2.0), np.full((6, 2), 0.5)
        error[3] = 0.5, np.nan
        status = ["ok", "ok, roughly", "tolerance not met", "tolerance not met", "rim reached", "okay".upper()]
        drop_unusable(mu, error, status, own)
        assert np.isfinite(mu).all(axis=1).tolist() == counted
        assert status == ["ok", "ok, roughly", "tolerance not met", "tolerance not met", "rim reached", "OKAY"]


def test_a_scene_limits_every_engine_by_its_name(command: Callable[..., Run], tmp_path: Path) -> None:
    functions = {"good": "with_error", "bad": "off_with_error", "half": "with_one_error", "vague": "vague"}
    engines = [word for name, of in functions.items() for word in ("--model", f"{name}=user_engines:{of}")]
    limits = {"median": 0.02, "maximum": 0.02, "ratio": 2.0}
    table = "".join(f"{key} = {value}\n" for key, value in limits.items())
    tables = "".join(f"[acceptance.{name}]\n{table}" for name in ("good", "bad")) + "[acceptance.half]\nratio = 2.0\n"
    scene = limited_scene(tmp_path, "[acceptance]\nfailed = 3\n" + tables)
    run = command(scene, "--grid", "2", *engines, *ONLY, "--check")
    assert run.code == 1
    broken = [
        f"body {body}: acceptance.bad.{key}: {found} found, {limits[key]:g} allowed"
        for key, found in (("median", "0.021"), ("maximum", "0.021"), ("ratio", "3"))  # it claims 7e-3
        for body in (1, 2)
    ]
    broken += [f"body {body}: acceptance.half.ratio: an error estimate is missing, 2 allowed" for body in (1, 2)]
    left_out = (
        "vague: only values with errors above half of them at any of 4 phase pairs. Comparisons leave this model out"
    )
    broken.append(f"acceptance.vague.ratio: nothing to compare ({left_out}), 2 allowed by default")
    broken.append("acceptance.failed: 4 points without an answer (vague 4 of 4), 3 allowed")
    *lines, last = run.err.splitlines()
    assert lines == [f"limit broken: limited: {line}" for line in broken]
    assert last == ("--check: not checked, as no limit is stated: total, translational, like-for-like of limited")
    assert "vague: only values with errors above half of them at any of 4 phase pairs" in run.out
    junit = (run.report / "junit.xml").read_text(encoding="utf-8")
    assert all(f'name="acceptance.good.{key} = {value:g}"' in junit for key, value in limits.items())
    assert 'tests="12" failures="6" skipped="3"' in junit
    assert 'name="acceptance.vague.ratio = 2 by default"' in junit
    assert summary_of(run.report)["scenes"][0]["acceptance"]["bad"] == limits
    absent = command(scene, "--grid", "2", *ONLY, "--check", hierarchy=fake_hierarchy("forbidden"))
    assert (absent.code, absent.err.count("\n")) == (2, 1)
    assert "acceptance.good = {'median': 0.02, 'maximum': 0.02, 'ratio': 2.0}: this study has no" in absent.err
    assert "--model good=module:function enters it" in absent.err
    unchecked = command(scene, "--grid", "2", *ONLY).report
    assert "no engine bad in this study" in (unchecked / "summary.md").read_text(encoding="utf-8")


def test_it_is_compared_with_the_model_of_its_law() -> None:
    wet = load_scene("fig4-viscous")
    for like in REFERENCE_MODEL_KEYS:
        dry_pairs, wet_pairs = (
            {pair.key: pair.first.key for pair in pairs_of(scene, [*fake_hierarchy(), supplied("plain", like=like)])}
            for scene in (SCENE, wet)
        )
        assert dry_pairs["mine"] == like
        assert wet_pairs["mine"] == ("small" if like.startswith("small") else "exact"), "its geometry"


def test_its_results_belong_to_its_source_and_its_helpers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(tmp_path))
    seen = []
    for helper, engine in (("1", "1"), ("2", "1"), ("2", "2"), ("2", "2")):
        (tmp_path / "its_helper.py").write_text(f"NUMBER = {helper}\n")
        (tmp_path / "its_engine.py").write_text(f"import json, numpy\nimport its_helper\nNUMBER = {engine}\n")
        hash_source.cache_clear()
        seen.append(fingerprint_engine("its_engine"))
    assert seen[2] == seen[3]
    assert len({json.dumps(about, sort_keys=True) for about in seen}) == 3
    assert set(seen[0]) == {"numpy", "source of its_engine", "source of its_helper"}
    (tmp_path / "its_folder").mkdir()  # without __init__.py
    (tmp_path / "its_folder" / "inner.py").write_text("import reference\n")
    assert {"source of its_folder.inner", "source of reference"} <= set(fingerprint_engine("its_folder.inner"))


@pytest.mark.long
def test_engines_that_hang_or_crash_cost_nobody_else(command: Callable[..., Run]) -> None:
    engines = ("prints", "computes-for-ever", "waits-for-ever", "leaves", "spoils-its-process")
    words = [word for name in engines for word in ("--model", f"{name}=user_engines:{name.replace('-', '_')}")]
    run = command("fig3-I", "--grid", "2", *words, *ONLY, "--model-limit", "2", executor=make_process_pool)
    assert run.code == 0
    assert "noise" not in run.out + run.err
    with xr.open_dataset(run.report / "surfaces.nc", engine="h5netcdf") as data:
        outcomes = [set(data["status"].sel(model=name).values.ravel().tolist()) for name in engines]
        assert np.isfinite(data["mu"].sel(model=["small", "prints"])).all()
    assert outcomes.pop(3) - {"not asked"} == {"worker died"}, "after two deaths it may not be asked again"
    assert [each - {"not asked"} for each in outcomes] == [{"ok"}, {"time limit"}, {"time limit"}, {"ok"}]


def test_extremes_of_its_law_concern_a_user_engine() -> None:
    every = list(list_extreme_cases())
    column = make_user_column(supplied("plain"))
    assert column.finer == tuple(("reference:amplification", REGULARIZED.settings, each) for each in (1e-8, 1e-6))
    met = {cell.row.name for cell in list_cells(every, [column])}
    alike = {row.name for row in every if "regularised" in row.columns and not row.amplification}
    assert met == alike


def test_outside_a_worker_process_nothing_is_dropped(capfd: pytest.CaptureFixture[str]) -> None:
    with silence_output():
        os.write(1, b"said\n")
    assert capfd.readouterr().out == "said\n"


def test_the_curve_of_a_user_engine_runs_over_its_tolerance() -> None:
    def curve(names: str, like: str = "regularised") -> list[tuple[str, float, object]]:
        model = make_user_model("mine", {"function": "user_engines:plain", "names": names}, like)
        return [(one.question, one.value, one.against) for one in list_user_settings([model])]

    assert curve("tolerance") == [("regularised", value, None) for value in (1e-2, 1e-3, 1e-4, 1e-5)]
    resolved = "reference:amplification", {**EXACT_AS_INTEGRATED.settings, "tolerance": 1e-10}
    assert (curve(""), curve("", "resolved")) == ([("regularised", 1e-3, None)], [("exact", 1e-3, resolved)])
    models = (make_user_model("mine", {"function": "user_engines:plain"}, limit=7.0),)
    tasks = TradeOff([SCENE], True, models).tasks()
    mine = [task.timeout / len(task.argument.phases) for task in tasks if task.group]
    assert set(mine) == {7.0}


def test_the_trade_has_the_curve_of_a_user_engine(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(analysis, "list_settings", lambda scene, quick: [])
    monkeypatch.setattr(
        analysis, "list_questions", lambda scene: [one for one in QUESTIONS if one.key == "regularised"]
    )
    models = supplied("as_reference", "good"), supplied("raises", "bad")
    scene = SCENE.with_values({"duration": 1.0})
    (measured,) = computed(TradeOff([scene], True, models), lambda jobs: ThreadPoolExecutor(1))
    good, bad = measured.trade.entries
    assert (good.answered, bad.answered) == (good.points, 0)
    assert bad.error_message == f"RuntimeError: the matrix is singular (user_engines.py, line {RAISES})"
    assert max(error for error in good.most if error is not None) == pytest.approx(1e-3, rel=1e-3)
    assert good.error_estimate == [None, None], "it states none"
    assert good.pareto_front == (True, True)
    curves = {line["name"] for each in make_tradeoff_panels(measured.trade) for line in each["plot"]["series"]}
    assert curves == {good.method}, "one without an answer has no curve"
