"""The pages on paper, as Chromium prints them: A4, complete, nothing cut, nothing folded."""

import math
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import pytest
from browsers import CHROMIUM, LAPTOP, OVERLAPS, Scheme, chromium, opened, until
from playwright.sync_api import Browser, Page
from pypdf import PageObject, PdfReader
from report_texts import page_of

from comparison.registry import StudyResults
from comparison.surfaces.statements import CELLS

A4 = 210.0, 297.0  # mm
MARGIN = 12.0  # mm, as report.css says
DOT, POINT = 25.4 / 96.0, 25.4 / 72.0  # mm of a CSS pixel and of a point
PAGES = {"index.html": range(5, 21), "verification.html": range(2, 9)}  # how many may be printed

BEYOND = """right => [...document.querySelectorAll('main *, header *')]
  .filter(each => each.checkVisibility() && !each.closest('svg') && each.getBoundingClientRect().right > right + 1)
  .map(each => `${each.tagName} ${each.className} of ${each.closest('[id]')?.id}: ${each.textContent.slice(0, 40)}`)"""
CUT = """() => [...document.querySelectorAll('main td, main th, main p, main li')]
  .filter(each => each.checkVisibility() && getComputedStyle(each).display !== 'inline')
  .filter(each => each.scrollWidth > each.clientWidth + 1).map(each => each.textContent)"""

# small charts hide some of their ticks
CELLS_OF_TABLES = """[...document.querySelectorAll('main td, main th')]
  .filter(cell => !cell.querySelector('svg text')).map(cell => cell.innerText)"""

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")


@dataclass(frozen=True)
class Printed:
    """A printed page: its size and the letters of every sheet, where the lowest of them stands, cells and canvases."""

    sizes: list[tuple[float, float]]
    texts: list[str]
    filled: list[float]
    cells: list[str]


def letters(text: str) -> str:
    """The letters and signs alone: a reader of the file may add or lose a space, and keeps ligatures."""
    return "".join(unicodedata.normalize("NFKC", text).split())


def as_printed(page: Page) -> Page:
    """The page as wide as the paper, as it is prepared for print."""
    width, height = ((side - 2.0 * MARGIN) / DOT for side in A4)
    page.set_viewport_size({"width": math.floor(width), "height": math.floor(height)})
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert page.evaluate("variable('--ink')") == "#1b1f24", "drawn in what the paper has, before the paper is there"
    page.emulate_media(media="print")
    until(page, "[...document.querySelectorAll('[data-plot]')].every(box => box.querySelector('svg'))")
    return page


def lowest_text(sheet: PageObject) -> float:
    """Height of the lowest text of a sheet above its lower edge, points."""
    heights = [math.inf]

    def see(text: str, of_all: list[float], of_text: list[float], *rest: object) -> None:
        if text.strip():
            heights.append(of_all[5] + of_all[3] * of_text[5])

    sheet.extract_text(visitor_text=see)
    return min(heights)


def printed_page(browser: Browser, file: Path) -> Printed:
    """Print a page through Chromium and read it back."""
    page = opened(browser, file, LAPTOP).page
    pdf = file.parent.parent / f"{file.stem}.pdf"
    page.pdf(path=pdf, prefer_css_page_size=True)
    sheets = PdfReader(pdf).pages
    sizes = [(float(sheet.mediabox.width) * POINT, float(sheet.mediabox.height) * POINT) for sheet in sheets]
    texts = [letters(sheet.extract_text()) for sheet in sheets]
    filled = [1.0 - lowest_text(sheet) / float(sheet.mediabox.height) for sheet in sheets]
    cells = as_printed(page).evaluate(CELLS_OF_TABLES)
    page.close()
    return Printed(sizes, texts, filled, cells)


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with chromium() as browser:
        yield browser


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
        for word in vars(CELLS).values():
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


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_paper_is_light_and_unfolded_and_has_every_surface_sharp(
    browser: Browser, finished: Path, scheme: Scheme
) -> None:
    page = as_printed(opened(browser, finished / "index.html", LAPTOP, scheme).page)
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
    assert page.locator("canvas.surface:visible").count() == 3
    page.close()
