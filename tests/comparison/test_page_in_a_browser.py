"""The page in a browser without a network: it draws itself, answers the pointer, and asks for nothing."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from fake_models import fake_hierarchy, silenced
from known_analyses import analyses_are
from matplotlib.image import imread
from playwright.sync_api import Browser, Locator, Page, sync_playwright

import comparison.run
from comparison.report.motion_data import ROUNDING

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
FLAGS = ["--no-sandbox", "--enable-unsafe-swiftshader", "--disable-background-networking", "--disable-sync"]
LAPTOP, DESKTOP = (1280, 800), (1920, 1080)
PATIENCE = 60_000  # ms: drawing is done by the processor here, which may be busy

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")


@dataclass
class Visit:
    """An opened page, and all it complained about or asked for."""

    page: Page
    complaints: list[str] = field(default_factory=list)
    requests: list[str] = field(default_factory=list)


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


def _opened(browser: Browser, file: Path, window: tuple[int, int]) -> Visit:
    width, height = window
    page = browser.new_page(viewport={"width": width, "height": height})
    page.set_default_timeout(PATIENCE)
    visit = Visit(page)
    page.on("console", lambda m: visit.complaints.append(m.text) if m.type == "error" else None)
    page.on("pageerror", lambda error_message: visit.complaints.append(str(error_message)))
    page.on("request", lambda r: visit.requests.append(r.url) if not r.url.startswith(("data:", "blob:")) else None)
    page.goto(file.as_uri())
    return visit


@pytest.fixture(scope="module")
def visit(browser: Browser, finished: Path) -> Iterator[Visit]:
    visit = _opened(browser, finished / "index.html", LAPTOP)
    yield visit
    visit.page.close()


def _drawn(page: Page, number: int) -> Locator:
    """The surfaces of the `number`-th body, in view and drawn."""
    box = page.locator(".surfaces").nth(number)
    box.evaluate("box => window.scrollTo(0, box.getBoundingClientRect().top + scrollY - 130)")
    page.wait_for_function("i => document.querySelectorAll('.surfaces')[i].linked", arg=number)
    page.wait_for_timeout(500)  # the frame in which WebGL paints
    return box


def _has_colors(box: Locator) -> list[bool]:
    """Whether a surface covers a part of each of the three panels; axes and words are gray."""
    picture = np.asarray(imread(BytesIO(box.screenshot())))[..., :3]
    return [bool((np.ptp(third, axis=2) > 0.15).mean() > 0.02) for third in np.array_split(picture, 3, axis=1)]


@pytest.mark.parametrize("window", [LAPTOP, DESKTOP], ids=["laptop", "desktop"])
def test_the_first_screen_has_every_verdict_and_every_bar(
    window: tuple[int, int], browser: Browser, finished: Path
) -> None:
    page = _opened(browser, finished / "index.html", window).page
    bottom = page.locator(".bars").evaluate("bars => bars.getBoundingClientRect().bottom + scrollY")
    assert bottom < window[1]
    assert page.locator("ul.verdicts li").count() == 2
    assert page.locator(".bars .row").count() == 4, "two bodies in each of two scenes"
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth"), "nothing is wider than the window"
    tables = "[...document.querySelectorAll('.table')].filter(t => t.scrollWidth > t.clientWidth).length"
    assert page.evaluate(tables) == 0, "no table must be pushed sideways to be read"
    assert all(_has_colors(_drawn(page, 0))), "surfaces are drawn at this size"
    page.close()


def test_every_surface_is_drawn(visit: Visit) -> None:
    assert visit.page.locator(".surfaces").count() == 4
    for number in range(4):
        assert all(_has_colors(_drawn(visit.page, number))), f"box {number}"


def test_a_click_on_a_surface_shows_the_motions_of_the_nearest_stored_phases(visit: Visit) -> None:
    page = visit.page
    box = _drawn(page, 0)
    panel = page.locator(".motions").first
    assert panel.is_hidden()
    at = box.bounding_box()
    assert at is not None
    spot = at["x"] + 0.15 * at["width"], at["y"] + 0.52 * at["height"]
    page.mouse.move(*spot)
    page.mouse.move(spot[0] + 1, spot[1])  # WebGL tells what is under the pointer one movement later
    page.wait_for_function("document.querySelector('.surfaces').under")
    page.mouse.down()
    page.mouse.up()
    page.wait_for_function("document.querySelector('.motions').data?.length > 0")
    assert panel.is_visible()
    shown = page.evaluate("""() => {
        const box = document.querySelector('.surfaces'), plot = document.querySelector('.motions');
        const marks = box.data.find(trace => trace.type === 'scatter3d').marker.size;
        return { chosen: marks.indexOf(Math.max(...marks)),
          index: Number(document.querySelector('.choice select').value),
          names: plot.data.filter(t => t.showlegend !== false).map(t => t.name),
          wide: plot.data.filter(t => t.xaxis === 'x2').map(t => Math.max(...t.x)),
          rest: plot.data.filter(t => t.yaxis === 'y5').map(t => t.x.slice(0, 2)) };
    }""")
    assert shown["chosen"] == shown["index"], "the phase pair whose motions are shown is marked on the surface"
    assert shown["names"][0] == "small equations"
    assert shown["wide"][0] == pytest.approx(10.0, rel=ROUNDING), "the first model goes in circles of 1 cm"
    assert shown["rest"][0] == [2.0, 3.0]


def test_another_phase_pair_and_other_models_are_chosen_without_a_mouse(visit: Visit) -> None:
    page = visit.page
    _drawn(page, 1)
    page.locator(".choice select").nth(1).select_option(index=2)
    page.wait_for_function("document.querySelectorAll('.motions')[1].data?.length > 0")
    page.get_by_role("button", name="like for like").click()
    wanted = "document.querySelectorAll('.motions')[1].data?.[0].name === 'exact equations, v<sub>reg</sub>'"
    page.wait_for_function(wanted)
    page.get_by_role("button", name="total").click()
    page.wait_for_function(wanted.replace("===", "!=="))
    assert page.evaluate("document.querySelectorAll('.motions')[1].data[0].name") == "small equations"


def test_a_click_on_a_heading_sorts_by_it(visit: Visit) -> None:
    heading = visit.page.locator("table.sortable th", has_text="median").first
    column = (
        "() => [...document.querySelector('table.sortable tbody').rows].map(row => Number(row.cells[3].dataset.value))"
    )
    heading.click()
    rising = visit.page.evaluate(column)
    heading.click()
    assert rising == sorted(rising)
    assert visit.page.evaluate(column) == rising[::-1]


def test_the_page_is_small_and_stands_within_three_seconds(visit: Visit, finished: Path) -> None:
    """The time is that of the page itself, before plots; it is a tenth of the limit on an idle machine."""
    assert (finished / "index.html").stat().st_size < 15e6
    assert visit.page.evaluate("performance.getEntriesByType('navigation')[0].domInteractive") < 3000.0


def test_paper_shows_every_figure_and_no_part_that_needs_a_pointer(visit: Visit) -> None:
    page = visit.page
    page.emulate_media(media="print")
    pdf = page.pdf(prefer_css_page_size=True)
    hidden = page.locator(".surfaces:visible, .bar:visible, nav:visible, .motions:visible").count()
    figures = page.locator(".static img.static:visible").count()
    page.emulate_media(media="screen")
    assert pdf.startswith(b"%PDF")
    assert hidden == 0
    assert figures >= 4 * (3 + 1), "three differences and the budget of every body"


def test_nothing_was_asked_of_a_network_and_nothing_complained(visit: Visit, finished: Path) -> None:
    """Last: after all that was done to the page above."""
    assert visit.complaints == []
    assert visit.requests == [(finished / "index.html").as_uri()]


def test_surfaces_without_any_value_are_said_to_have_none(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    analyses_are(monkeypatch, motions=[])
    hierarchy = silenced(*(model.key for model in fake_hierarchy()))
    words = ["fig3-I", "--grid", "2", "--jobs", "2", "--out", str(tmp_path / "report")]
    assert comparison.run.main(words, hierarchy, ThreadPoolExecutor) == 0
    visit = _opened(browser, tmp_path / "report" / "index.html", LAPTOP)
    box = _drawn(visit.page, 0)
    assert box.inner_text().count("no value at any phase pair") == 3
    assert "could not be drawn" not in visit.page.inner_text("body")
    assert visit.complaints == []
    visit.page.close()
