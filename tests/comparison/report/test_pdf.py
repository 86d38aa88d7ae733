"""report.pdf has two to four pages with the sentences of the page, whatever is studied, and its absence is one line."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from fake_models import fake_hierarchy, known_motions, silenced
from report_texts import page_of, text_of
from runs import RUN, Run, quick_figures
from studies import solved

from comparison.registry import report_of
from comparison.report import pdf
from comparison.report.pdf_data import largest_headlines, pdf_data
from comparison.report.section import Report
from comparison.study.models import Model
from comparison.study.study import Study
from comparison.surfaces.alerts import Alert
from comparison.surfaces.unanswered import compared_study
from reference.problem import Scene, load_scene


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Maps are drawn in another test."""
    quick_figures(monkeypatch)


def studied(scenes: list[Scene], hierarchy: tuple[Model, ...]) -> Report:
    study = Study(tuple(scenes), 2, 1e-3, hierarchy)
    surfaces = solved(study)
    study = compared_study(study, surfaces)
    fault = Alert(level="amber", kind="fault", scene="fig3-I", text="engine: it broke", help="")
    return report_of(study, surfaces, {}, [fault], RUN)


def _called(scene: Scene, name: str, title: str) -> Scene:
    return Scene.model_construct(**{**dict(scene), "name": name, "title": title})


@pytest.mark.parametrize("case", ["papers", "one body", "record", "refused", "nothing"])
def test_any_study_has_two_to_four_pages(case: str, tmp_path: Path) -> None:
    scene, hierarchy = load_scene("fig3-I"), fake_hierarchy(gap=0.01)
    if case == "one body":
        scene = Scene.model_validate({**scene.model_dump(exclude_none=True), "bodies": [{"mass": 1000.0}], "name": "b"})
    scenes = [load_scene("synthetic-pair")] if case == "record" else [scene]
    if case == "papers":
        scenes = [load_scene(name) for name in ("fig3-I", "fig3-II", "fig4-dry", "fig4-viscous")]
    if case == "refused":
        hierarchy = silenced("spatial")
    report = studied(scenes, hierarchy)
    if case == "nothing":
        surfaces = report.surfaces.assign(mu=np.nan * report.surfaces["mu"])
        report = report_of(report.study, surfaces, {}, [], RUN)
    pdf.write_pdf(tmp_path / "report.pdf", report)
    pages, text = text_of(tmp_path / "report.pdf")
    assert 2 <= pages <= 4
    assert "nan" not in text.split()


def test_titles_are_text_and_the_bytes_are_reproducible(tmp_path: Path) -> None:
    title = '#panic("x") *b* _i_ $a$ @ref <label> \\ `raw` = // [c] "q" \ud800'
    scene = _called(load_scene("fig3-I"), "#let", title)
    report = studied([scene], fake_hierarchy(gap=0.01))
    for name in ("a.pdf", "b.pdf"):
        pdf.write_pdf(tmp_path / name, report)
    assert (tmp_path / "a.pdf").read_bytes() == (tmp_path / "b.pdf").read_bytes()
    text = text_of(tmp_path / "a.pdf")[1]
    assert '#panic("x") *b* _i_ $a$ @ref <label>' in text.replace("”", '"').replace("“", '"')


def test_without_the_package_one_line_says_how_to_get_it(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pdf, "find_spec", lambda name: None)
    run = command("fig3-I", "--grid", "2")
    assert (run.code, run.err, (run.report / "report.pdf").exists()) == (0, "", False)
    assert run.out.count("pip install typst") == 1
    assert "pip install typst" in page_of(run.report)


def test_what_the_pdf_leaves_out_it_counts() -> None:
    record = load_scene("synthetic-pair")
    scenes = [_called(record, f"{'long-' * 20}{number}", "A record") for number in range(9)]
    scenes += [_called(load_scene("fig3-I"), f"phased{number}", "A long title. " * 20) for number in range(6)]
    report = studied(scenes, fake_hierarchy(gap=0.01))
    found = {"motions": known_motions(report.study, report.surfaces)}
    faults = [
        Alert(level="amber", kind="fault", scene="", text=f"fault {number} {'x' * 600}", help="") for number in range(7)
    ]
    report = report_of(report.study, report.surfaces, found, faults, RUN)
    shown = largest_headlines(report.results)
    data = pdf_data(report.results, shown, [about for about, _ in pdf.map_tasks(report)])
    first, largest = "The {} first {} of {} are shown", "The {} largest differences of 30 are shown"
    for key, words, kept, rows in (
        ("more_alerts", "2 more of these in index.html.", "alerts", 5),
        ("more_scenes", largest.format(10), "", 10),
        ("waterfall_note", largest.format(8), "waterfalls", 8),
        ("maps_note", "The 4 scenes with the largest differences of 6 are shown", "maps", 4),
        ("more_records", first.format(16, "rows", 18), "records", 16),
        ("demands_note", first.format(16, "rows", 30), "demands", 16),
        ("limits_line", first.format(8, "scenes with limits", 15), "limits", 8),
    ):
        assert words in data[key], key
        assert (len(data[kept]) if kept else sum(len(scene["sentences"]) for scene in data["scenes"])) == rows, key
    assert first.format(8, "scenes", 15) in data["provenance"][-1][1]
    name = report.results.scenes[0].name
    assert data["records"][0][0] == data["demands"][0][0] == f"{name[:39]}…"
    assert (len(data["maps"][0]["title"]), len(data["alerts"][0]["line"])) == (110, 501)


def test_the_largest_differences_are_so_by_size_not_by_sign() -> None:
    maxima = [*(0.01 * number for number in range(1, 11)), -0.5, float("nan")]
    every = [SimpleNamespace(scene="mine", body=body, maximum=maximum) for body, maximum in enumerate(maxima)]
    results = SimpleNamespace(scenes=[SimpleNamespace(headlines=every)])
    assert [each.body for each in largest_headlines(results)] == [*range(1, 11)]  # type: ignore[arg-type]
