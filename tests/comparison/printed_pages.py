"""Pages on paper, as Chromium prints them, read back."""

import math
import unicodedata
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

from browsers import LAPTOP, opened, until
from playwright.sync_api import Browser, Page
from pypdf import PageObject, PdfReader

A4 = 210.0, 297.0  # mm
MARGIN = 12.0  # mm, as report.css says
DOT, POINT = 25.4 / 96.0, 25.4 / 72.0  # mm of a CSS pixel and of a point

BEYOND = """right => [...document.querySelectorAll('main *, header *')]
  .filter(each => each.checkVisibility() && !each.closest('svg') && each.getBoundingClientRect().right > right + 1)
  .map(each => `${each.tagName} ${each.className} of ${each.closest('[id]')?.id}: ${each.textContent.slice(0, 40)}`)"""
CUT = """() => [...document.querySelectorAll('main td, main th, main p, main li')]
  .filter(each => each.checkVisibility() && getComputedStyle(each).display !== 'inline')
  .filter(each => each.scrollWidth > each.clientWidth + 1).map(each => each.textContent)"""

# small charts hide some of their ticks
CELLS_OF_TABLES = """[...document.querySelectorAll('main td, main th')]
  .filter(cell => !cell.querySelector('svg text')).map(cell => cell.innerText)"""


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


def read_sheet(sheet: PageObject) -> tuple[str, float]:
    """The letters of a sheet, and the height of the lowest text but the number of the page above its lower edge."""
    heights = [math.inf]

    def see(text: str, of_all: list[float], of_text: list[float], *rest: object) -> None:
        height = of_all[5] + of_all[3] * of_text[5]
        if text.strip() and height > MARGIN / POINT:
            heights.append(height)

    return letters(sheet.extract_text(visitor_text=see)), min(heights)


def printed_page(browser: Browser, file: Path) -> Printed:
    """Print a page through Chromium and read it back."""
    page = opened(browser, file, LAPTOP).page
    sheets = PdfReader(BytesIO(page.pdf(prefer_css_page_size=True))).pages
    sizes = [(float(sheet.mediabox.width) * POINT, float(sheet.mediabox.height) * POINT) for sheet in sheets]
    texts, lowest = zip(*map(read_sheet, sheets))
    filled = [1.0 - height / float(sheet.mediabox.height) for sheet, height in zip(sheets, lowest)]
    cells = as_printed(page).evaluate(CELLS_OF_TABLES)
    page.close()
    return Printed(sizes, [*texts], filled, cells)
