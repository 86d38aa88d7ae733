"""Analyses are selected on the command line and in a scene; what was not asked for is absent and not computed."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from fake_models import fake_hierarchy
from places import scene_text
from report_texts import both_pages, schema_errors, summary_of
from runs import Run

from comparison.cli.options import _parser, parse_options
from comparison.registry import (
    EVERYTHING,
    FEATURES,
    SELECTABLE,
    estimate_stage_seconds,
    list_first_tasks,
    select_analyses,
)
from comparison.runner.cache import CacheKey
from comparison.runner.task import Task
from comparison.study.selection import Selection, make_selection, select_names
from comparison.study.study import Study
from comparison.surfaces.figures.pictures import Pictures
from comparison.surfaces.surfaces import label_surfaces
from reference.problem import load_scene

GRID = ("--grid", "4")
STAGES = {"effective": "effective values", "scaling": "scaling test"}  # of an analysis' tasks


def sections(page: str) -> set[str]:
    """Names of the sections of a page."""
    return set(re.findall(r'<(?:section|details class="section") id="(\w+)">', page)) - {"absent", "summary"}


def scene_file(folder: Path, analyses: str, name: str = "mine") -> str:
    (folder / f"{name}.toml").write_text(f"{scene_text()}\n[analyses]\n{analyses}\n", encoding="utf-8")
    return str(folder / f"{name}.toml")


def test_a_selected_analysis_has_its_tasks_and_pictures_and_no_others() -> None:
    study = Study((load_scene("fig3-I"),), 4, 1e-3)

    def tasks(only: list[str] | None, skip: list[str] | None) -> tuple[list[Task], set[CacheKey]]:
        part = replace(study, selection=make_selection(SELECTABLE, study.scenes, only, skip))
        pictures = Pictures().tasks(part, label_surfaces(study, [], []))
        return list_first_tasks(part, select_analyses(part)), {task.key for task in pictures}

    every, all_pictures = tasks(None, None)
    for analysis, stage in STAGES.items():
        assert stage in {task.stage for task in every}
        kept, _ = tasks(None, [analysis])
        assert [task.key for task in kept] == [task.key for task in every if task.stage != stage]
    both = replace(study, scenes=(*study.scenes, load_scene("fig4-dry")))
    one = replace(both, selection=Selection(SELECTABLE, {"fig3-I": ("effective",), "fig4-dry": ("budget",)}))
    alone = replace(one, scenes=study.scenes)
    (kept, seconds), (expected, own) = (
        (list_first_tasks(each, select_analyses(each)), estimate_stage_seconds(each)) for each in (one, alone)
    )
    stages = {task.stage for task in expected if task.stage == STAGES["effective"]}
    assert [task.key for task in kept if task.stage in stages] == [
        task.key for task in expected if task.stage in stages
    ]
    assert seconds[STAGES["effective"]] == own[STAGES["effective"]] > 0.0, "of the scenes that ask for it"
    first, pictures = tasks(["surfaces"], None)
    assert (first, len(pictures)) == ([], 1 + 2), "that in the manner of the paper, and the total of both bodies"
    assert tasks(["budget"], None)[1] == set(), "its bars are drawn on the page"
    assert pictures <= all_pictures, "a selection changes the key of no picture"


def test_only_leaves_the_sections_asked_for(command: Callable[..., Run]) -> None:
    run = command("fig3-I", *GRID, "--only", "surfaces,budget")
    assert (run.code, run.err) == (0, "")
    page, summary = both_pages(run.report), summary_of(run.report)
    selectable = {feature.key for feature in FEATURES if feature.section} & set(EVERYTHING.names)
    assert sections(page) & selectable == {"surfaces", "budget"}
    assert sections(page) - selectable == {"outcomes", "models", "verification", "provenance"}
    missing = "".join(part.split("</ul>")[0] for part in page.split('id="absent">')[1:])
    reasons = re.findall(r"<li>.*?: (.*?)</li>", missing)
    assert (reasons.count("not asked for"), all(reasons)) == (len(selectable) - 2, True)
    assert "Relative differences" not in run.out
    assert "### Differences" not in (run.report / "summary.md").read_text(encoding="utf-8")
    assert (summary["scaling"], {*summary["absent"].values()}) == (None, {"not asked for"})
    assert schema_errors(run.report) == []


def test_skipped_surfaces_leave_no_picture_and_no_link_to_them(command: Callable[..., Run]) -> None:
    run = command("fig3-I", *GRID, "--skip", "surfaces,budget")
    page = both_pages(run.report)
    assert (run.code, {"surfaces", "budget"} & sections(page)) == (0, set())
    assert all(f'id="{anchor}"' in page for anchor in re.findall(r'href="#([\w-]+)"', page))
    assert not (run.report / "figures").exists()
    assert (run.report / "surfaces.nc").exists()


def test_the_command_line_selects_before_the_scene(command: Callable[..., Run], tmp_path: Path) -> None:
    mine = scene_file(tmp_path, 'skip = ["differences", "surfaces"]')
    page = both_pages(command(mine, "fig4-viscous", *GRID).report)
    table = page.split('id="differences">')[1].split("</table>")[0]
    assert [f"<td>{name}</td>" in table for name in ("fig4-viscous", "mine")] == [True, False]
    assert [f'<option value="{number}">' in page for number in (1, 0)] == [True, False]
    options = parse_options([mine, "--only", "budget", "--out", str(tmp_path / "other")])
    assert options.selection.by_scene == {"mine": ("budget",)}


@pytest.mark.parametrize(
    ("words", "analyses", "line"),
    [
        (["--only", "surfaces,bugdet"], "", "--only = 'surfaces,bugdet': 'bugdet' is no analysis; did you mean budg"),
        (["--skip", ""], "", "--skip = '': '' is no analysis; the analyses are surfaces, motions, "),
        (["--also", "demand"], "", "--also = 'demand': 'demand' is no analysis; did you mean demands?"),
        (
            ["--also", "demands,tradeoff"],
            "",
            "--also = 'demands,tradeoff': phase-resonance tradeoff makes it, next to the",
        ),
        ([], 'also = ["extremes"]', "analyses.also = ['extremes']: phase-resonance extremes makes it, next to the re"),
        (["--only", "budget", "--skip", "claims"], "", "--skip = 'claims': names what --only leaves out anyway"),
        ([], 'only = ["bugdet"]', "analyses.only = ['bugdet']: 'bugdet' is no analysis; did you mean budget?"),
        ([], 'onyl = ["budget"]', "analyses.onyl = ['budget']: unknown key; did you mean only?"),
        ([], 'only = ["budget"]\nskip = ["claims"]', "analyses = {'only': ['budget'], 'skip': ['claims']}: give only "),
    ],
)
def test_a_wrong_selection_is_one_line(
    command: Callable[..., Run], tmp_path: Path, words: list[str], analyses: str, line: str
) -> None:
    run = command(scene_file(tmp_path, analyses), *words, hierarchy=fake_hierarchy("forbidden"))
    assert (run.code, run.out, run.err.count("\n")) == (2, "", 1)
    assert f"{'command line' if words else 'mine'}: {line}" in run.err.replace(".toml", "")


def test_motions_bring_the_surfaces_below_which_they_are_shown() -> None:
    assert set(select_names(SELECTABLE, ["motions"], None)) == {"motions", "surfaces"}
    assert {"motions", "surfaces"}.isdisjoint(select_names(SELECTABLE, None, ["surfaces"]))


def test_claims_are_of_the_papers_scenes(command: Callable[..., Run], tmp_path: Path) -> None:
    files = scene_file(tmp_path, ""), scene_file(tmp_path, 'only = ["claims", "surfaces"]', "named")
    mine, named, paper = map(load_scene, (*files, "fig3-I"))
    selection = make_selection(SELECTABLE, [mine, named, paper], None, None)
    assert [selection.has("claims", scene.name) for scene in (mine, named, paper)] == [False, True, True]
    assert make_selection(SELECTABLE, [mine], ["claims"], None).has("claims", "mine")
    assert make_selection(SELECTABLE, [mine], None, None, ["claims"]).has("claims", "mine")
    assert make_selection(SELECTABLE, [mine], ["budget"], None).explain_absence("claims") == "not asked for"
    skipped = make_selection(SELECTABLE, [mine], None, ["claims", "demands"])
    assert not skipped.has("claims", "mine")
    assert [skipped.explain_absence(key) for key in ("claims", "demands")] == ["not asked for"] * 2
    assert summary_of(command(files[0], *GRID).report)["absent"] == {
        "claims": "of the paper's scenes; --only claims makes it of others",
        "demands": "on request; --also demands makes it",
    }


def test_demands_of_every_phase_are_computed_on_request(command: Callable[..., Run], tmp_path: Path) -> None:
    scene, asking = load_scene("fig3-I"), load_scene(scene_file(tmp_path, 'also = ["demands"]'))
    for of, asked, made in (
        (scene, (None, None), False),
        (scene, (None, None, ["demands"]), True),
        (scene, (["demands"], None), True),
        (scene, (None, ["demands"]), False),
        (asking, (None, None), True),
        (asking, (None, None, []), False),
    ):
        study = Study((of,), 4, 1e-3, selection=make_selection(SELECTABLE, (of,), *asked))
        assert ("demands" in {analysis.key for analysis in select_analyses(study)}) == made
    plans = (command("fig3-I", *GRID, *words, "--plan").out for words in ((), ("--also", "demands")))
    usual, also = (" ".join(plan.split()) for plan in plans)
    assert (", demands (" in usual, ", demands (" in also) == (False, True)
    assert "effective values (5)" in usual
    assert "on request; --also demands makes it" in usual
    spaced = parse_options(["fig3-I", "--only", "surfaces, budget", "--out", str(tmp_path / "spaced")]).selection
    assert [name for name in ("surfaces", "budget", "claims") if spaced.has(name, "fig3-I")] == ["surfaces", "budget"]
    named = _parser().format_help().split("these analyses, too: ")[1]
    assert named.split("--")[0].split() == ["demands"], "in the help, those on request alone"
