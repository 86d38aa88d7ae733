"""report.pdf has two to four pages with the sentences of the page, whatever is studied, and its absence is one line."""

from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from fake_models import fake_hierarchy, known_motions, silenced
from report_texts import flat, page_of, text_of
from runs import RUN, Run, quick_figures
from studies import solved

from comparison.analyses.demands.feature import HEADINGS, demand_rows
from comparison.registry import report_of
from comparison.report import pdf
from comparison.report.section import Report
from comparison.study.models import Model
from comparison.study.study import Study
from comparison.surfaces.alerts import Alert
from comparison.surfaces.unanswered import compared_study
from reference.problem import Scene, load_scene

SCENES = ("fig3-I", "fig3-II", "fig4-dry", "fig4-viscous")


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Maps are drawn in another test."""
    quick_figures(monkeypatch)


def studied(scenes: list[Scene], hierarchy: tuple[Model, ...], grid: int = 4) -> Report:
    study = Study(tuple(scenes), grid, 1e-3, hierarchy)
    surfaces = solved(study)
    study = compared_study(study, surfaces)
    fault = Alert(level="amber", kind="fault", scene="fig3-I", text="engine: it broke", help="")
    return report_of(study, surfaces, {}, [fault], RUN)


def _called(scene: Scene, name: str, title: str) -> Scene:
    return Scene.model_construct(**{**dict(scene), "name": name, "title": title})


@pytest.mark.long
def test_the_papers_scenes_fit_four_pages_with_every_sentence(tmp_path: Path) -> None:
    report = studied([load_scene(name) for name in SCENES], fake_hierarchy(gap=0.01), grid=24)
    pdf.write_pdf(tmp_path / "report.pdf", report)
    pages, text = text_of(tmp_path / "report.pdf")
    assert 2 <= pages <= 4
    for scene in report.results.scenes:
        for headline in scene.headlines:
            assert flat(headline.sentence.removeprefix(f"{scene.name}, ")) in flat(text)
    for words in ("Provenance", "acceptance limits are broken", "cross-verified", "translational engine", "it broke"):
        assert flat(words) in flat(text)


@pytest.mark.parametrize(
    "case", ["one body", "record", "refused", pytest.param("many", marks=pytest.mark.long), "nothing"]
)
def test_any_study_has_two_to_four_pages(case: str, tmp_path: Path) -> None:
    scene, hierarchy = load_scene("fig3-I"), fake_hierarchy(gap=0.01)
    if case == "one body":
        scene = Scene.model_validate({**scene.model_dump(exclude_none=True), "bodies": [{"mass": 1000.0}], "name": "b"})
    scenes = [load_scene("synthetic-pair")] if case == "record" else [scene]
    if case == "refused":
        hierarchy = silenced("spatial")
    if case == "many":
        title = "A long title of a scene of a user. " * 20
        scenes = [_called(scene, f"scene{number}", title) for number in range(30)]
    report = studied(scenes, hierarchy, 2)
    if case == "nothing":
        surfaces = report.surfaces.assign(mu=np.nan * report.surfaces["mu"])
        report = report_of(report.study, surfaces, {}, [], RUN)
    pdf.write_pdf(tmp_path / "report.pdf", report)
    pages, text = text_of(tmp_path / "report.pdf")
    assert 2 <= pages <= 4
    assert "nan" not in text.split()
    if case == "many":
        assert flat("10 largest differences of 60 are shown") in flat(text)


def test_titles_are_text_and_the_bytes_are_reproducible(tmp_path: Path) -> None:
    title = '#panic("x") *b* _i_ $a$ @ref <label> \\ `raw` = // [c] "q" \ud800'
    scene = _called(load_scene("fig3-I"), "#let", title)
    report = studied([scene], fake_hierarchy(gap=0.01), 2)
    for name in ("a.pdf", "b.pdf"):
        pdf.write_pdf(tmp_path / name, report)
    assert (tmp_path / "a.pdf").read_bytes() == (tmp_path / "b.pdf").read_bytes()
    text = text_of(tmp_path / "a.pdf")[1]
    assert '#panic("x") *b* _i_ $a$ @ref <label>' in text.replace("”", '"').replace("“", '"')


def test_without_the_package_one_line_says_how_to_get_it(
    command: Callable[..., Run], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pdf, "find_spec", lambda name: None)
    run = command("fig3-I", "--grid", "2", hierarchy=fake_hierarchy())
    assert run.code == 0
    assert not (run.report / "report.pdf").exists()
    line = "pip install typst"
    assert run.out.count(line) == 1
    assert "pip install typst" in page_of(run.report)
    assert run.err == ""


def test_the_demands_of_the_stored_motions_are_in_a_table(tmp_path: Path) -> None:
    report = studied([load_scene("fig3-I")], fake_hierarchy(), 4)
    motions = known_motions(report.study, report.surfaces)
    report = report_of(report.study, report.surfaces, {"motions": motions}, [], RUN)
    at = [(0.5 * np.pi * motion.place.row, 0.5 * np.pi * motion.place.column) for motion in motions]
    assert any(alpha1 != alpha2 for alpha1, alpha2 in at)
    np.testing.assert_allclose([motion.phases for motion in report.results.scenes[0].demands], at)
    numbers = ["150", "", "5.2", "2.1", "2.31", "37", "17"]  # lengths in mm; the residual is not known
    rows = demand_rows(report.results)
    assert [row[2:] for row in rows] == [numbers, numbers]
    assert [row[1] for row in rows] == ["small equations", "spatial engine"]
    pdf.write_pdf(tmp_path / "report.pdf", report)
    pages, text = text_of(tmp_path / "report.pdf")
    assert 2 <= pages <= 4
    assert flat("Largest values over the stored motions") in flat(text)
    assert "base shear, N" in text


@pytest.mark.long
def test_what_the_pdf_leaves_out_it_counts(tmp_path: Path) -> None:
    record = load_scene("synthetic-pair")
    scenes = [_called(record, f"{'long-' * 20}{number}", "A record") for number in range(9)]
    scenes += [_called(load_scene("fig3-I"), f"phased{number}", "Phases") for number in range(6)]
    report = studied(scenes, fake_hierarchy(gap=0.01), 2)
    motions = known_motions(report.study, report.surfaces)
    report = report_of(report.study, report.surfaces, {"motions": motions}, [], RUN)
    pdf.write_pdf(tmp_path / "report.pdf", report)
    text = flat(text_of(tmp_path / "report.pdf")[1])
    for words in (
        "The 16 first rows of 18 are shown; the others are in index.html.",  # values under the records
        "The 16 first rows of 30 are shown",  # demands, of two models each
        "The 4 scenes with the largest differences of 6 are shown",  # maps
        "The 10 largest differences of 30 are shown",  # sentences
        "The 8 largest differences of 30 are shown",  # bars
        "The 8 first scenes with limits of",
        "The 8 first scenes of 15 are shown",  # provenance
    ):
        assert flat(words) in text, words
    name = report.results.scenes[0].name
    data = pdf.pdf_data(report.results, [], [])
    assert data["records"][0][0] == f"{name[:39]}…"
    assert data["demands"][0][0] == f"{name[:39]}…"


def test_demands_over_phases_have_their_columns_and_units() -> None:
    values = {("displacement", 0): 0.12, ("residual", 0): 0.034, ("base_shear", 0): 5.6, ("acceleration", 1): 7.8,
              ("acceleration", 2): 9.1, ("drift", 2): 0.023, ("contact_force_min", 0): 45.0}  # fmt: skip
    rows = [
        SimpleNamespace(
            model="small", quantity=quantity, body=body,
            highest=SimpleNamespace(value=value, error=0.002), lowest=SimpleNamespace(value=0.5 * value, error=0.002),
        )
        for (quantity, body), value in values.items()
    ]  # fmt: skip
    scene = SimpleNamespace(name="mine", of={"demand_statistics": rows, "demands": []}.get, bodies=2)
    models = [SimpleNamespace(key="small", title="small equations")]
    [cells] = demand_rows(SimpleNamespace(scenes=[scene], models=models))  # type: ignore[arg-type]
    assert dict(zip(HEADINGS, cells, strict=True)) == {
        "scene": "mine", "model": "small equations", "isolator, mm": "120", "residual, mm": "34 ± 2",
        "base shear, N": "5.6", "platform, m/s²": "7.8", "top, m/s²": "9.1", "drift, mm": "23",
        "contact force, N": "22.5",
    }  # fmt: skip
