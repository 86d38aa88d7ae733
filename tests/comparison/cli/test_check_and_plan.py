"""--check exits 1 when a stated limit is broken, --plan computes nothing, and the closing table has its rows."""

import os
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from fake_models import fake_hierarchy
from places import limited_scene, scene_text
from report_texts import page_of
from runs import Run, no_executor
from studies import body_comparisons, difference_rows, solved

import reference
from comparison.analyses.demands.analysis import DemandSurfaces
from comparison.cli import terminal
from comparison.cli.options import parse_options
from comparison.run import _tighter_command
from comparison.runner.processes import count_cores
from comparison.study.costs import estimate_model_seconds, estimate_motion_seconds
from comparison.study.models import MODEL_HIERARCHY
from comparison.study.study import Study
from comparison.surfaces.acceptance import Limit, check_limits
from comparison.surfaces.missing_values import list_missing_values

UNCHECKED = "--check: not checked, as no limit is stated: total, translational of fig3-I\n"
SMALL = ["fig3-I", "--grid", "2", "--only", "differences"]


def limits_of(study: Study, surfaces: xr.Dataset) -> list[Limit]:
    """The limits of a study, compared with its surfaces."""
    return check_limits(body_comparisons(study, surfaces), list_missing_values(study, surfaces))


def test_check_exits_1_and_names_scene_body_key_found_and_limit(command: Callable[..., Run], tmp_path: Path) -> None:
    within = command(*SMALL, "--check", hierarchy=fake_hierarchy(gap=5e-5))  # the scene allows a median of 1e-4
    assert (within.code, within.err) == (0, UNCHECKED)
    run = command(*SMALL, "--check", hierarchy=fake_hierarchy(gap=5e-4))
    assert run.code == 1
    assert run.err.splitlines() == [  # 5e-4 is within the maximum of 1e-3 that is allowed
        *(f"limit broken: fig3-I: body {body}: acceptance.median: 0.0005 found, 0.0001 allowed" for body in (1, 2)),
        UNCHECKED.strip(),
    ]
    unchecked = command(*SMALL, hierarchy=fake_hierarchy(gap=5e-4))
    assert unchecked.code == 0
    assert "acceptance limits broken" in page_of(unchecked.report)
    plain = limited_scene(tmp_path, "", "plain.toml")
    alone = command(plain, *SMALL[1:], "--check")
    assert (alone.code, alone.err) == (0, "--check: no scene states [acceptance] limits: nothing was checked\n")
    beside = command(plain, *SMALL, "--check", hierarchy=fake_hierarchy(gap=5e-5))
    everything = "total, translational, like-for-like of plain"
    assert beside.err == f"{UNCHECKED.strip()}; {everything}\n"


def test_check_says_where_limits_on_demands_are_checked(command: Callable[..., Run], tmp_path: Path) -> None:
    limited = limited_scene(
        tmp_path, "[acceptance]\nmedian = 1.0\n[acceptance.demands]\ndisplacement = 0.1", "mine.toml"
    )
    run = command(limited, *SMALL[1:], "--check", hierarchy=fake_hierarchy(gap=5e-5))
    assert run.err.startswith("--check: [acceptance.demands] of mine: phase-resonance ensemble --check checks it\n")


@pytest.mark.parametrize(
    ("confirm", "gap", "found"), [(True, 5e-4, ["5"]), (False, 5e-4, []), (True, 2.5e-3, ["2.49", "24.9"])]
)
def test_a_limit_must_hold_at_a_tenth_of_the_tolerance(
    confirm: bool, gap: float, found: list[str], command: Callable[..., Run], tmp_path: Path
) -> None:
    """The engine claims its tolerance as its error: 0.5 of both errors at 1e-3 are 5 at 1e-4, where 2 are allowed."""
    scene = limited_scene(tmp_path, f"[acceptance]\nratio = 2.0\n{'confirm = true' if confirm else ''}\n", "mine.toml")
    words = [scene, limited_scene(tmp_path, "", "beside.toml"), "--grid", "2", "--check", "--only", "budget"]
    run = command(*words, hierarchy=fake_hierarchy(gap=gap))
    assert run.code == int(confirm)
    assert re.findall(r"body 1: acceptance.ratio: (\S+) found", run.err) == found
    assert run.report.with_name("report-tighter").exists() is confirm


def test_a_limit_that_is_broken_at_first_stays_broken(command: Callable[..., Run], tmp_path: Path) -> None:
    """5e-4 at a tolerance of 1e-3, 5e-5 at a tenth of it."""
    scene = limited_scene(tmp_path, "[acceptance]\nmedian = 2e-4\nconfirm = true\n", "mine.toml")
    run = command(scene, "--grid", "2", "--check", "--skip", "claims", hierarchy=fake_hierarchy("nearing"))
    assert (run.code, run.err.count("acceptance.median: 0.0005 found")) == (1, 2)


@pytest.mark.parametrize(("limits", "code"), [("closure = 1.0", 1), ("maximum = 9.0", 1), ("failed = 2", 0)])
def test_a_point_without_an_answer_breaks_any_limit(
    limits: str, code: int, command: Callable[..., Run], tmp_path: Path
) -> None:
    """The engine fails at one of 4 x 4 phase pairs, in both of its models."""
    scene = limited_scene(tmp_path, f"[acceptance]\n{limits}\n", "mine.toml")
    run = command(scene, "--grid", "4", "--check", "--only", "budget", hierarchy=fake_hierarchy("failing_point"))
    assert (run.code, run.err.count("failed: 2 points without an answer")) == (code, code), run.err


def test_the_second_run_of_a_check_has_its_own_tolerance_folder_and_analyses(tmp_path: Path) -> None:
    words = ["fig3-I", "--also=demands", "--skip", "claims", "--tolerance", "2e-3", "--out", str(tmp_path / "r")]
    tighter = ["--tolerance", "0.0002", "--out", str(tmp_path / "r-tighter"), "--only", "differences,budget"]
    assert _tighter_command(parse_options(words), words) == ["fig3-I", *tighter]


def test_plan_counts_the_work_and_computes_and_writes_nothing(command: Callable[..., Run]) -> None:
    words = ["fig3-I", "fig4-viscous", "--plan", "--grid", "16", "--jobs", "2"]
    run = command(*words, "--only", "differences", hierarchy=fake_hierarchy("forbidden"), executor=no_executor)
    assert (run.code, run.report.exists()) == (0, False)
    rows = [line.split() for line in run.out.splitlines() if line.split()[:1] in (["fig3-I"], ["fig4-viscous"])]
    assert [row[-3:] for row in rows] == [
        *[["256", "256", "1e-06"]] * 6, ["256", "256", "1e-03"], ["16", "16", "1e-03"],
        *[["256", "256", "1e-06"]] * 2, ["256", "256", "1e-03"], ["16", "16", "1e-03"],
    ]  # fmt: skip
    text = " ".join(run.out.split())
    assert "Analyses (tasks): held-out phases (0), pictures (chosen by the surfaces)." in text
    assert "A recorded motion" not in text
    assert "Not in the report: surfaces (not asked for), motions (not asked for)" in text
    levels = [f"equations 16 x 16 phases, translational engine {n} x {n} phases, spatial engine 4 x 4" for n in (8, 16)]
    assert f"Level 1 of 3: {levels[0]} phases. Level 2 of 3: {levels[1]} phases. Level 3 of 3: {levels[1]}" in text
    # 16 x 16 phase pairs at 0.06 s and 4 x 4 at 0.22 s of both scenes, the equations, two analyses, modules and report
    points = 256 * (2 * 0.06 + 2 * 2 * 0.0005 + 2 * 0.0005 + 2 * 0.001) + 16 * 2 * 0.22
    seconds = 4.0 + (points + 2 * 3.0 + 2 * 3.5) / 2 + 4.0
    assert f"Roughly {seconds:.0f} s with 2 workers and 20 s for compiling on a new installation" in text
    mirrored = command("fig3-I", *words[2:], "--only", "differences", hierarchy=MODEL_HIERARCHY).out
    (small,) = (line.split() for line in mirrored.splitlines() if "small equations, v_reg" in line)
    assert small[-3:] == ["256", "64", "1e-06"]
    points = 64 * (4 * 0.0005 + 2 * 0.001 + 0.06 + 0.22)  # a quarter of them
    assert f"Roughly {4.0 + (points + 3.0 + 3.5) / 2 + 4.0:.0f} s with" in mirrored


def test_bounds_of_the_command_line_make_two_scenes_of_each() -> None:
    scenes = parse_options(["fig3-I", "fig4-dry", "--bounds", "0.8", "1.5", "--plan"]).scenes
    names = [f"{name}[{bound} bound]" for name in ("fig3-I", "fig4-dry") for bound in ("lower", "upper")]
    assert [scene.name for scene in scenes] == names
    assert [scene.friction_coefficient for scene in scenes] == [0.08, 0.15] * 2


def test_a_reason_to_refuse_is_told_once_with_every_scene_and_model(monkeypatch: pytest.MonkeyPatch) -> None:
    study = Study((reference.load_scene("fig3-I"), reference.load_scene("fig4-dry")), 4, 1e-3, fake_hierarchy())
    refused = {("fig3-I", "spatial"): "too long", ("fig4-dry", "spatial"): "too long", ("fig4-dry", "exact"): "other"}
    monkeypatch.setattr(terminal, "find_refusal", lambda scene, model, *rest: refused.get((scene.name, model.key)))
    titles = {model.key: model.title for model in study.hierarchy}
    assert terminal._list_refusals(study) == {
        "too long": [f"{name}, {titles['spatial']}" for name in ("fig3-I", "fig4-dry")],
        "other": [f"fig4-dry, {titles['exact']}"],
    }


def test_plan_refuses_what_takes_more_work_than_is_allowed(command: Callable[..., Run]) -> None:
    run = command(*SMALL, "--plan", "--max-work", "1000", hierarchy=MODEL_HIERARCHY)
    assert "fig3-I, translational engine: refused before any step" in run.out
    assert "a phase pair may take 1e+03" in run.out
    both = command("synthetic-pair", *SMALL, "--plan", hierarchy=MODEL_HIERARCHY).out
    assert "refused" not in both
    assert "A recorded motion has no phases: one point per model.\n" in both


def test_a_scene_is_told_what_the_spatial_model_lacks(command: Callable[..., Run], tmp_path: Path) -> None:
    lines = scene_text().splitlines()

    def planned(name: str, *left_out: str) -> str:
        (tmp_path / name).write_text("\n".join(line for line in lines if line.split(" ")[0] not in left_out), "utf-8")
        return command(str(tmp_path / name), "--grid", "2", "--plan").out

    told = "no spatial model, as it lacks"
    assert told not in planned("whole.toml")
    assert f"part: {told} isolator.sphere_radius." in planned("part.toml", "sphere_radius")
    assert told not in planned("plain.toml", "sphere_radius", "supports", "ring", "height", "size")


def test_plan_of_many_scenes_fits_a_screen(command: Callable[..., Run], tmp_path: Path) -> None:
    values = ", ".join(str(0.05 + 0.001 * number) for number in range(22))
    family = scene_text("fig3-I", ("friction = 0.1", f"friction = {{values = [{values}]}}"))
    (tmp_path / "many.toml").write_text(family, "utf-8")
    out = command(str(tmp_path / "many.toml"), "--plan", hierarchy=MODEL_HIERARCHY).out.splitlines()
    assert len(out) <= 30
    assert any(f"{22 * 48**2:,}" in line.split() for line in out), "phase pairs of all scenes of the file"
    (line,) = [line for line in out if "adding pi to either phase" in line]
    few = ", ".join(f"many[friction={value}]" for value in ("0.05", "0.051", "0.052", "0.053"))
    why = "each harmonic has its own axis and none is vertical: adding pi to either phase mirrors the motion"
    assert line == f"  mirrored phases, all but 1/4 (all models; {few} and 18 more): {why}"


def test_without_a_word_the_study_is_the_papers_four_cases_on_48_phases(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    usual = parse_options([])
    assert [scene.name for scene in usual.scenes] == ["fig3-I", "fig3-II", "fig4-dry", "fig4-viscous"]
    assert (usual.grid, usual.tolerance, usual.out, usual.jobs) == (48, 1e-3, Path("report"), count_cores())
    assert (usual.budget, usual.max_work, usual.scheduler, usual.models) == (None, None, None, ())
    assert not any((usual.check, usual.plan, usual.fresh, usual.full))
    with pytest.raises(SystemExit):
        parse_options(["--help"])
    text = " ".join(capsys.readouterr().out.split())
    assert "exact, small-resolved, resolved, small-regularised, regularised (default regularised); repeatable" in text
    assert "asked of every mu; the equations are asked for 1e-6 or better (default 0.001)" in text
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)  # as on macOS and Windows
    for count, cores in ((7, 7), (None, 1)):
        monkeypatch.setattr(os, "cpu_count", lambda count=count: count)
        assert parse_options([]).jobs == cores
    words = "--grid 3 --tolerance 1e-4 --out r --jobs 5 --budget 60 --max-work 7 --check --fresh --full --amplitude 2"
    asked = parse_options([*words.split(), "fig3-I"])
    assert (asked.grid, asked.tolerance, asked.out, asked.jobs) == (3, 1e-4, Path("r"), 5)
    assert (asked.budget, asked.max_work, asked.scenes[0].amplitudes.max()) == (60.0, 7.0, pytest.approx(2.0))
    assert (asked.check, asked.plan, asked.fresh, asked.full) == (True, False, True, True)


def test_the_cost_of_a_model_is_that_of_all_its_batches() -> None:
    costs = solved(Study((reference.load_scene("fig3-I"),), 4, 1e-3, fake_hierarchy()))["cost"]
    assert costs.values.ravel() == pytest.approx(0.016), "16 phase pairs of 1 ms each"


def test_rough_costs_grow_with_bodies_knots_and_the_fastest_link() -> None:
    record, small, spatial = reference.load_scene("synthetic-pair"), MODEL_HIERARCHY[0], MODEL_HIERARCHY[-1]
    parts = 4e-4 * record.duration + 3.7e-6 * len(record.record)
    assert estimate_motion_seconds(record, small) == pytest.approx(0.02 + (len(record.bodies) + 1) * parts)
    bodies = [{"mass": mass, "stiffness": stiffness} for mass, stiffness in ((1.0, [3.0, 900.0]), (0.25, [4.0, 5.0]))]
    scene = reference.load_scene("fig3-I").with_values({"bodies": [{"mass": 0.5}, *bodies]})
    radians = scene.duration * np.sqrt(900.0 * (1.0 / 0.5 + 1.0))
    costs = [estimate_motion_seconds(scene, model) for model in MODEL_HIERARCHY[-2:]]
    assert costs == pytest.approx([8e-4 * radians, 1.25e-3 * 3 * radians])
    alone = reference.load_scene("fig3-I").with_values({"bodies": [{"mass": 0.5}], "duration": 3.0})
    assert estimate_motion_seconds(alone, spatial) == pytest.approx(1.25e-3 * 3.0 * 7.0)
    scenes = (reference.load_scene("fig3-I"), reference.load_scene("fig4-viscous"))  # no law of friction in the second
    seconds = [estimate_model_seconds(Study(each, 4, 1e-3), MODEL_HIERARCHY[3]) for each in (scenes, scenes[:1])]
    assert seconds[0] == seconds[1] > 0.0


def test_the_plan_counts_every_motion_of_the_demands() -> None:
    scene = reference.load_scene("fig3-I")
    for grid in (4, 8):
        study = Study((scene,), grid, 1e-3, MODEL_HIERARCHY)
        tasks = DemandSurfaces().tasks(study)
        motions = [(task.argument[1], len(task.argument[3])) for task in tasks]
        expected = sum(count * estimate_motion_seconds(scene, model) for model, count in motions)
        assert DemandSurfaces().estimate_seconds(study) == pytest.approx(expected)


@pytest.mark.parametrize("number", range(6))
def test_check_counts_the_missing_values_of_every_model_of_ours(number: int) -> None:
    study = Study((reference.load_scene("fig3-I"),), 4, 1e-3, fake_hierarchy(gap=5e-5))
    surfaces, model = solved(study), study.hierarchy[number]
    surfaces["mu"].loc[{"model": model.key, "alpha1": 0.0, "alpha2": 0.0}] = np.nan
    excess = f"1 points without an answer ({model.title} 1 of {study.points(model)}), 0 allowed"
    assert [line for limit in limits_of(study, surfaces) for line in limit.broken] == [
        f"fig3-I: acceptance.failed: {excess}"
    ]


@pytest.mark.parametrize("body", [1, 2])
@pytest.mark.parametrize("limit", ["median", "maximum", "ratio"])
def test_the_worst_body_breaks_a_limit_whichever_it_is(limit: str, body: int) -> None:
    scene = reference.load_scene("fig3-I").with_values({"acceptance": {limit: 0.02}})
    study = Study((scene,), 2, 1e-3, fake_hierarchy(gap=0.0))
    surfaces = solved(study)
    surfaces["mu"].loc[{"model": "translational", "body": body}] *= 1.021
    surfaces["mu"].loc[{"model": "translational", "body": body, "alpha1": 0.0, "alpha2": 0.0}] *= 1.01
    found = [limit for limit in limits_of(study, surfaces) if limit.breaches]
    rows = {(row.pair, row.body): getattr(row, limit) for row in difference_rows(study, surfaces)}
    breaches = [(breach.body, breach.found) for each in found for breach in each.breaches]
    assert ([each.key for each in found], breaches) == ([limit], [(body, rows["like-for-like", body])])
    at_it = scene.with_values({"acceptance": {limit: rows["like-for-like", body]}})
    at_limit = limits_of(replace(study, scenes=(at_it,)), surfaces)
    assert [each.breaches for each in at_limit if each.key == limit] == [()], "as large as allowed is allowed"


def test_models_without_a_common_phase_pair_leave_nothing_to_compare() -> None:
    study = Study((reference.load_scene("fig3-I"),), 2, 1e-3, fake_hierarchy())
    surfaces = solved(study)
    for key, alpha1 in (("regularised", 0.0), ("translational", np.pi)):
        surfaces["mu"].loc[{"model": key, "alpha1": alpha1}] = np.nan
    broken = next(limit for limit in limits_of(study, surfaces) if limit.key == "median").breach_texts
    assert [line.split(":")[1] for line in broken] == [" nothing to compare (exact equations, v_reg"]
