"""The pages on paper, as Chromium prints them: A4, complete, nothing cut, nothing folded."""

from collections.abc import Mapping
from pathlib import Path

import pytest
from browsers import CHROMIUM, LAPTOP, OVERLAPS, opened
from playwright.sync_api import Browser
from printed_pages import A4, BEYOND, CUT, DOT, MARGIN, Printed, as_printed, letters, printed_page
from report_texts import page_of

from comparison.registry import StudyResults
from comparison.surfaces.statements import CELL_WORDINGS

PAGES = {"index.html": range(5, 21), "verification.html": range(2, 9)}  # how many may be printed

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")


@pytest.fixture(scope="module")
def printed(browser: Browser, finished: Path) -> Mapping[str, Printed]:
    """Both pages on paper."""
    return {name: printed_page(browser, finished / name) for name in PAGES}


def test_every_sheet_is_a4_and_no_sheet_is_nearly_empty(printed: Mapping[str, Printed]) -> None:
    for name, counts in PAGES.items():
        assert len(printed[name].sizes) in counts, name
        assert all(size == pytest.approx(A4, abs=0.5) for size in printed[name].sizes)
        assert min(printed[name].filled[:-1]) > 1.0 / 3.0, printed[name].filled


def test_the_first_sheet_has_the_verdict_and_the_whole_table(finished: Path, printed: Mapping[str, Printed]) -> None:
    sheet = printed["index.html"].texts[0]
    results = StudyResults.model_validate_json((finished / "summary.json").read_text(encoding="utf-8"))
    headlines = [line for scene in results.scenes for line in scene.headlines]
    assert len(headlines) == 4
    for line in headlines:
        for word in vars(CELL_WORDINGS).values():
            assert letters(word(line)) in sheet, word.__name__
    verdict = page_of(finished).split('<p class="answer">')[1].split("<")[0]
    assert letters(verdict) in sheet


def test_every_cell_of_every_table_is_printed(printed: Mapping[str, Printed]) -> None:
    """Differences, causes and largest values among them: what the browser has in its tables stands on paper."""
    for name, page in printed.items():
        text = "".join(page.texts)
        cells = {letters(cell) for cell in page.cells}
        assert len(cells) > 100, name
        assert sorted(cell for cell in cells if cell not in text) == [], name


def test_nothing_reaches_beyond_the_paper_or_is_cut(browser: Browser, finished: Path) -> None:
    for name in PAGES:
        page = as_printed(opened(browser, finished / name, LAPTOP).page)
        assert page.evaluate(BEYOND, (A4[0] - 2.0 * MARGIN) / DOT) == []
        assert page.evaluate(CUT) == []
        assert page.evaluate(OVERLAPS)["faults"] == []
        page.close()


def test_paper_is_light_and_unfolded_and_has_every_surface_sharp(browser: Browser, finished: Path) -> None:
    page = opened(browser, finished / "index.html", LAPTOP, "dark").page
    page.evaluate("change({ body: 2, pair: 'like-for-like' })")
    pairs = [["translational", "like-for-like"], ["translational"] * 2]
    told = "study.scenes[{}].pairs.find(pair => pair.key === '{}').sentence"
    sentences = [page.evaluate(told.format(scene, key)) for scene, keys in enumerate(pairs) for key in keys]
    as_printed(page)
    heads = page.locator(".sheet h3").evaluate_all("list => list.map(each => each.textContent)")
    assert all(letters(said) in letters(head) for said, head in zip(sentences, heads, strict=True)), "the pair shown"
    assert page.locator("button:not(.sort):visible, select:visible, nav:visible, input:visible").count() == 0
    assert page.locator("details:not([open])").count() == 0
    surfaces = page.evaluate("""[...document.querySelectorAll('canvas.surface')].filter(each => each.checkVisibility())
        .map(each => [each.width / each.clientWidth, each.height / each.clientHeight])""")
    assert len(surfaces) == 12, "of two scenes and two bodies the three panels"
    assert all(ratio > 3.0 for pair in surfaces for ratio in pair), "dots on each of CSS: 300 to the inch"
    assert all(pair[0] == pytest.approx(pair[1], rel=0.02) for pair in surfaces), "none is drawn out"
    assert page.locator("thead").first.evaluate("head => getComputedStyle(head).display") == "table-header-group"
    page.emulate_media(media="screen")
    page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert page.locator("details.section[open]").count() == 0, "as it was"
    assert page.locator("canvas.surface").count() == 3
    assert page.evaluate("[state.body, state.pair]") == [2, "like-for-like"]
    page.close()
