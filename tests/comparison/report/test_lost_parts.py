"""Whatever a library raises in one part of a report costs that part alone, and is one line."""

import errno
import json
import re
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from distinct_models import distinct_hierarchy, distinct_motions
from fake_models import fake_hierarchy
from known_analyses import analyses_are, known_others
from known_results import FILES, MEASURED, SEARCHED, known_assumptions, leave_beside
from places import scene_text
from report_texts import data_of, page_of
from runs import RUN, quick_figures
from studies import solved

import comparison.registry
from comparison.cli.reports import CompleteLevel, ReportWriter
from comparison.json_file import format_json
from comparison.registry import FEATURES, make_report
from comparison.report import page, writing
from comparison.report.results import Results
from comparison.run import main
from comparison.runner.attempts import attempt
from comparison.runner.runner import Runner
from comparison.study.study import Study
from reference.problem import load_scene

FAMILY = "friction = 0.1", "friction = {values = [0.1, 0.2]}"
ERROR = "RuntimeError: no <font> of the two is here"
PAGES = "index.html", "verification.html"
WHOLE = (*PAGES, "junit.xml", "summary.json", "summary.md", "summary.schema.json", "surfaces.nc")


def fail(*words: Any, **more: Any) -> Any:
    """As a library does."""
    raise RuntimeError("no <font>\n of the two is here")


Last = tuple[Path, Callable[[], Results], int]


class Place(NamedTuple):
    """Attribute `name` of `owner` that raises, and what is then said not to be shown."""

    owner: Any
    name: str
    said: str


def places() -> Iterator[Place]:
    """Every call by which a section, a picture or a file gets its content."""
    for feature in (each for each in FEATURES if each.key != "demands"):  # not asked for here
        if feature.analysis:
            yield Place(feature.key, "collect", f"section {feature.key}")
        for field in (*feature.fields, *feature.scene_fields):
            if field.compute:
                yield Place(field, "compute", f"section {field.name}")
        for name, said in {
            "figures": "pictures of {}",
            "packed_data": "{}",
            "page_data": "data of {} on the page",
        }.items():
            if getattr(feature, name):
                yield Place(feature, name, said.format(feature.key))
        if section := feature.section:
            yield Place(section, "context", f"section {section.name}")
            if section.verdict:
                yield Place(section, "verdict", f"verdict of section {section.name}")
            if section.lead:
                yield Place(section, "lead", "sentences of sections")
    for name, said in {"netcdf": "surfaces.nc", "render_summary_text": "summary.md", "junit": "junit.xml",
                       "format_schema": "summary.schema.json"}.items():  # fmt: skip
        yield Place(writing, name, said)
    yield Place(Results, "as_json", "summary.json")
    for name, said in {"word_verdict": "verdict", "_group_alerts": "alerts", "make_common_scale": "summary",
                       "collect_page_data": "surfaces"}.items():  # fmt: skip
        yield Place(page, name, said)


def put(place: Place, value: Any) -> None:
    """Set the attribute, of a frozen dataclass, too."""
    if isinstance(place.owner, type) or place.owner in (page, writing):
        setattr(place.owner, place.name, value)
    else:
        object.__setattr__(place.owner, place.name, value)


@contextmanager
def raising(place: Place) -> Iterator[None]:
    """Let the call raise in the block."""
    if isinstance(place.owner, str):  # known answers are in the place of the analysis itself
        place = place._replace(owner=next(each for each in comparison.registry.ANALYSES if each.key == place.owner))
    before, own = getattr(place.owner, place.name), place.name in vars(place.owner)
    put(place, fail)
    try:
        yield
    finally:
        if own:
            put(place, before)
        else:
            object.__delattr__(place.owner, place.name)


@pytest.fixture(scope="module")
def last_report(tmp_path_factory: pytest.TempPathFactory) -> Last:
    """A report with every section that has known results, and what writes it again."""
    place, calls = tmp_path_factory.mktemp("lost") / "report", []
    leave_beside(place, FILES, "fig3-I")
    write = ReportWriter.write

    def remember(self: ReportWriter, complete: CompleteLevel, runner: Runner) -> Results:
        calls.append(partial(write, self, complete, runner))
        return calls[-1]()

    with pytest.MonkeyPatch.context() as patch:
        quick_figures(patch)
        known = {"motions": distinct_motions, "worst_phases": SEARCHED, "measured": MEASURED}
        known |= {"assumptions": known_assumptions(), **known_others()}
        analyses_are(patch, **known)
        patch.setattr(ReportWriter, "write", remember)
        family = place.with_name("family.toml")
        family.write_text(scene_text("fig3-I", FAMILY), encoding="utf-8")
        words = ["fig3-I", str(family), "--grid", "2", "--out", str(place)]
        assert main(words, distinct_hierarchy(), ThreadPoolExecutor) == 0
        sections = sum(page_of(place, name).count('class="section"') for name in PAGES)
        yield place, calls[-1], sections


def test_a_report_of_which_every_part_raises_is_written(last_report: Last, capsys: pytest.CaptureFixture[str]) -> None:
    folder, write, _ = last_report
    with ExitStack() as stack:
        for place in places():
            if place.said not in WHOLE:
                stack.enter_context(raising(place))
        write()
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) > 30
    assert all(line.endswith(f" could not be shown: {ERROR}") for line in lines)
    assert {file.name for file in folder.iterdir()} >= set(WHOLE)
    shown = page_of(folder, "index.html")
    assert all(f"{part} could not be shown" in shown for part in ("verdict", "alerts", "summary", "section claims"))
    assert not re.search(r"\bNone\b", shown), "nothing stands in their place"


@pytest.fixture(scope="module")
def shown(last_report: Last) -> dict[str, str]:
    """Both pages of the report, whole, by name."""
    folder, write, _ = last_report
    write()
    return {name: page_of(folder, name) for name in PAGES}


def test_every_link_leads_to_a_part_of_the_page_that_it_names(shown: dict[str, str]) -> None:
    links = [(name, *link) for name in PAGES for link in re.findall(r'href="([\w.-]*)#([\w-]+)"', shown[name])]
    assert len(links) > 20
    assert [link for link in links if f'id="{link[2]}"' not in shown[link[1] or link[0]]] == []
    assert ("index.html", "verification.html", "claims") in links
    assert ("index.html", "", "conditioning") in links


def test_every_bar_has_the_name_of_its_effect(shown: dict[str, str]) -> None:
    first = shown["index.html"].split('<table class="waterfall')[1].split("</table>")[0]
    names = [re.sub("<.*?>", "", name) for name in re.findall(r'<th scope="row">(.*?)</th>', first)]
    effects = ["geometry", "regularized friction", "elastic contact", "turning of the bodies"]
    assert names == [*effects, "= total"]


@pytest.mark.long
@pytest.mark.parametrize("place", [*places()], ids=lambda place: f"{place.said} {place.name}".replace(" ", "-"))
def test_what_raises_in_a_part_costs_that_part_alone(
    last_report: Last, place: Place, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, write, sections = last_report
    with raising(place):
        write()
    line = f"{place.said} could not be shown: {ERROR}"
    assert capsys.readouterr().err.splitlines() == [line]
    there = {file.name for file in folder.iterdir()}
    assert set(WHOLE) - there == {place.said} & set(WHOLE), "every other file is there"
    shown = "".join(page_of(folder, name) for name in PAGES)
    if place.said not in WHOLE:
        assert line.replace("<font>", "&lt;font&gt;") in shown
    assert shown.count('class="section"') >= sections - 1
    for name in {"summary.json", "summary.schema.json"} & there:
        json.loads((folder / name).read_text(encoding="utf-8"))


@pytest.mark.parametrize("act", [fail, lambda report, scene: {"worst": {"exact": [float("inf")]}}])
def test_data_of_a_feature_that_fail_cost_neither_the_surfaces_nor_those_of_others(
    last_report: Last, capsys: pytest.CaptureFixture[str], act: Callable[..., Any]
) -> None:
    folder, write, _ = last_report
    (feature,) = (each for each in FEATURES if each.key == "worst_phases")
    write()
    before = data_of(folder)["scenes"]
    with raising(Place(feature, "page_data", "")):
        put(Place(feature, "page_data", ""), act)
        write()
    assert "data of worst_phases on the page could not be shown" in capsys.readouterr().err
    after = data_of(folder)["scenes"]
    assert all("worst" in scene for scene in before)
    assert after == [{name: part for name, part in scene.items() if name != "worst"} for scene in before]
    assert all(scene["places"] and scene["models"] for scene in after[:1])


def test_what_json_cannot_hold_is_null() -> None:
    assert json.loads(format_json({"a": float("nan"), "b": [1.5, (float("inf"), {"c": -float("inf")})]})) == {
        "a": None, "b": [1.5, [None, {"c": None}]],
    }  # fmt: skip


def test_a_disk_that_takes_no_file_ends_the_command_and_a_file_of_others_costs_a_part() -> None:
    lines: list[str] = []

    def fail(number: int) -> None:
        raise OSError(number, "no")

    for number in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EROFS, errno.EIO):
        with pytest.raises(OSError, match="no"):
            attempt("a picture", partial(fail, number), lines.append)
    assert attempt("a picture", partial(fail, errno.EACCES), lines.append) is None
    assert lines == ["a picture could not be shown: PermissionError: [Errno 13] no"]


def test_a_part_that_is_lost_is_told_on_the_page_that_lacks_it() -> None:
    """A value that fails is in the report's list; what only one page lacks is not told on the other."""
    study = Study((load_scene("fig3-I"),), 2, 1e-3, fake_hierarchy())
    surfaces = solved(study)
    place = next(each for each in places() if each.name == "compute")
    with raising(place):
        report = make_report(study, surfaces, {}, [], RUN, families=(), lost=["before"])
    assert [line.partition(" could")[0] for line in report.lost] == ["before", place.said]
    report = make_report(study, surfaces, {}, [], RUN, families=())
    with raising(Place(page, "_group_alerts", "alerts")):
        pages = page.render_pages(report)
    assert ["alerts could not be shown" in text for text in pages.values()] == [True, False]
