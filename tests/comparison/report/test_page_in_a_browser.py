"""The page in a browser."""

import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from browsers import CHROMIUM, DESKTOP, FLAGS, LAPTOP, OVERLAPS, PATIENCE, PHONE, Scheme, Visit, opened, unfolded, until
from fake_models import fake_hierarchy, known_spectra, silenced
from known_analyses import analyses_are
from matplotlib.image import imread
from playwright.sync_api import Browser, Locator, sync_playwright
from runs import quick_figures

import comparison.run
from comparison.analyses.motions.page_data import ROUNDING
from reference.problem import load_scene

SERIOUS = ("serious", "critical")
MOST_BYTES = 6e6

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield browser
        browser.close()


@pytest.fixture
def visit(browser: Browser, finished: Path) -> Iterator[Visit]:
    """The page as it opens. Whatever a test does to it, it complains of nothing and asks no network for anything."""
    visit = opened(browser, finished / "index.html", LAPTOP)
    yield visit
    visit.page.close()
    assert visit.complaints == []
    assert visit.requests == [(finished / "index.html").as_uri()]


def _colored(canvas: Locator) -> bool:
    """Whether a surface or its points cover a part of the canvas; axes and words are gray."""
    canvas.scroll_into_view_if_needed()
    picture = np.asarray(imread(BytesIO(canvas.screenshot())))[..., :3]
    return bool((np.ptp(picture, axis=2) > 0.15).mean() > 0.003)


def test_ticks_tell_as_many_digits_as_their_distance_asks_for(visit: Visit) -> None:
    for low, high, texts in (
        (6.83e5, 6.89e5, ["6.84·10⁵", "6.86·10⁵", "6.88·10⁵"]),
        (-3e-4, 1e-4, ["−2·10⁻⁴", "0"]),
        (0.0, 100.0, ["0", "50", "100"]),
    ):
        assert [text for _, text in visit.page.evaluate(f"ticksOf({{}}, [{low}, {high}], 3)")] == texts


@pytest.mark.parametrize("width", [PHONE, DESKTOP])
def test_no_two_texts_overlap_and_all_fits_the_window(width: int, browser: Browser, finished: Path) -> None:
    for name, bars in (("index.html", "mean"), ("index.html", "largest"), ("verification.html", "")):
        visit = opened(browser, finished / name, width)
        if bars:
            visit.page.locator(f"button[data-bars={bars}]").click()
        unfolded(visit.page)
        texts = visit.page.evaluate(OVERLAPS)
        assert texts["count"] > 150
        assert texts["faults"] == []
        assert visit.page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        assert visit.complaints == []
        visit.page.close()


@pytest.mark.parametrize("scheme", ["light", pytest.param("dark", marks=pytest.mark.long)])
def test_axe_finds_nothing_serious(scheme: Scheme, browser: Browser, finished: Path) -> None:
    for name in ("index.html", "verification.html"):
        page = opened(browser, finished / name, LAPTOP, scheme).page
        unfolded(page)
        violations = Axe().run(page).response["violations"]
        assert [(v["id"], v["nodes"][0]["html"][:120]) for v in violations if v["impact"] in SERIOUS] == []
        page.close()


def test_every_body_has_its_sentence_and_its_bars_above_the_surfaces(visit: Visit) -> None:
    """The page here has two scenes: two more of their height would still leave room above 1600 px."""
    page = visit.page
    top = page.evaluate("document.querySelector('canvas.surface').getBoundingClientRect().top + scrollY")
    heights = page.locator("article.scene").evaluate_all("all => all.map(a => a.getBoundingClientRect().height)")
    assert len(heights) == 2
    assert top + sum(heights) < 1600
    assert page.locator(".headline").count() == 4, "two bodies in each of two scenes"
    for name, shown, hidden in (("at the largest difference", "largest", "mean"), ("mean over", "mean", "largest")):
        page.get_by_role("button", name=name).click()
        assert page.locator(f"[data-waterfall={shown}]:visible").count() == 4
        assert page.locator(f"[data-waterfall={hidden}]:visible").count() == 0


def test_every_surface_is_drawn_in_three_dimensions_and_as_a_map(visit: Visit) -> None:
    page = visit.page
    for scene, body in ((0, 1), (0, 2), (1, 1), (1, 2)):
        page.locator("[data-part=scene]").select_option(index=scene)
        page.locator("[data-part=body]").select_option(str(body))
        for view in ("map", "3-D"):
            page.get_by_role("button", name=view).click()
            page.evaluate("() => new Promise(drawn => requestAnimationFrame(() => requestAnimationFrame(drawn)))")
            end = time.monotonic() + PATIENCE / 1000
            while not all(map(_colored, page.locator("canvas.surface").all())):
                assert time.monotonic() < end, (scene, body, view)
                page.wait_for_timeout(20)
    page.locator("[data-part=scene]").select_option(index=0)


def test_two_surfaces_have_one_scale_of_colors_and_name_the_grid_of_their_largest(visit: Visit) -> None:
    """The smooth fake model: mu_1 = 3 + cos a1 + sin a2 is at most 5, at (0, 90 degrees); nothing was searched."""
    first, second, difference = visit.page.locator("div.scale").all()
    assert first.inner_text() == second.inner_text()
    assert "%" in difference.inner_text()
    notes = visit.page.locator("#viewer figure .notes").first.inner_text()
    assert "largest of 4 × 4 phases: 5 at (0°, 90°) ▾" in notes
    assert "largest over all phases: not searched" in notes


def test_a_spatial_model_on_few_phases_is_drawn_as_points(visit: Visit) -> None:
    visit.page.locator("[data-part=pair]").select_option("total")
    assert visit.page.evaluate("shown.map(panel => panel.sheet)") == [True, False, False]
    assert "too few" in visit.page.locator(".three .notes").nth(1).inner_text()
    visit.page.locator("canvas.surface").nth(1).focus()
    for key in ("ArrowRight", "ArrowLeft"):
        visit.page.keyboard.press(key)
    assert visit.page.locator("[data-part=readout]").inner_text().count("±") == 2, "points have their errors"
    visit.page.locator("[data-part=pair]").select_option("translational")
    assert visit.page.evaluate("shown.map(panel => panel.sheet)") == [True, True, True]
    visit.page.get_by_role("button", name="phases of both").click()
    visit.page.get_by_role("button", name="all phases of the first").click()


def test_a_click_shows_the_nearest_motion_and_its_distance(visit: Visit) -> None:
    page = visit.page
    page.get_by_role("button", name="map").click()
    canvas = page.locator("canvas.surface").nth(2)
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 0.31 * box["height"])
    until(page, "document.querySelector('[data-part=distance]')?.textContent.includes('away')")
    chosen = page.evaluate("""() => {
        const far = place => Math.hypot(...place.phases.map((p, k) => around(p, state.cursor[k])));
        const { places } = sceneNow(), picked = Number(document.querySelector('[data-part=place]').value);
        return { away: state.away, least: Math.min(...places.map(far)), here: far(places[state.place]),
          picked: picked === state.place };
    }""")
    assert chosen["away"] == chosen["least"] == chosen["here"]
    assert chosen["picked"]
    assert "small equations" in page.locator("[data-part=plots] .legend").first.inner_text()


def test_the_motions_plotted_are_those_stored(visit: Visit) -> None:
    """The first model goes in circles of 1 cm, rounded as they are packed, and rests from 2 s to 3 s."""
    wide, path, rest, plots = visit.page.evaluate("""() => {
        const plots = [...document.querySelectorAll('[data-part=plots] .plot')].map(box => box.spec);
        const first = title => plots.find(spec => spec.label.startsWith(title)).series[0];
        return [Math.max(...first('displacement of the platform in x').y), Math.max(...first('path of the contact').x),
          first('rest').x.slice(0, 2), plots.map(spec => spec.label)];
    }""")
    isolator = load_scene("fig3-I").isolator
    assert wide == pytest.approx(10.0, rel=ROUNDING)
    assert path == pytest.approx(10.0 * isolator.sphere_radius / load_scene("fig3-I").radius, rel=2 * ROUNDING)
    assert rest == [2.0, 3.0]
    assert {"loop", "contact", "absolute"} <= {label.split()[0] for label in plots}
    spectra = visit.page.evaluate("""() => [...document.querySelectorAll('[data-part=plots] .plot')]
        .map(box => box.spec).filter(spec => spec.label.includes('spectrum'))
        .map(spec => [spec.label, spec.series[0].x, spec.series[0].y])""")
    values = known_spectra(load_scene("fig3-I")).acceleration[0].tolist()
    assert [(label.split(",")[0][-4:], x, y) for label, x, y in spectra] == [
        (f"in {axis}"[-4:], [0.1, 1.0], row) for axis, row in zip("xy", values)
    ]


def test_the_demands_of_both_models_stand_beside_each_other(visit: Visit) -> None:
    table = visit.page.locator("[data-part=demands] table")
    assert table.locator("thead th").first.inner_text().strip() == "demand"
    rows = {
        row.locator("th").inner_text(): row.locator("td").all_inner_texts() for row in table.locator("tbody tr").all()
    }
    for title, cell in (
        ("largest displacement of the isolator, mm", "150 ± 2"),
        ("base shear, N", "5.2 ± 0.05"),
        ("smallest contact force, N", "17 ± 0.2"),
        ("largest contact force, N", "23 ± 0.2"),
    ):
        assert rows[title][0] == cell, title
    (residual,) = (cells for title, cells in rows.items() if title.startswith("residual"))
    assert residual == ["none: moving at the end: take a longer duration"] * 2 + [""]


def test_the_film_plays_and_pauses(visit: Visit) -> None:
    page = visit.page
    page.locator("[data-part=start]").click()
    until(page, "film.time > 0.05")
    page.locator("[data-part=start]").click()
    stopped = page.evaluate("film.time")
    page.wait_for_timeout(200)
    assert page.evaluate("film.time") == stopped
    assert page.locator("[data-part=start]").inner_text() == "play"


def test_keys_alone_reach_motions_tips_and_tables(visit: Visit) -> None:
    page = visit.page
    page.locator("canvas.surface").first.focus()
    for key in ("ArrowRight", "ArrowUp", "Enter"):
        page.keyboard.press(key)
    assert "away" in page.locator("[data-part=distance]").inner_text()
    page.mouse.move(0, 0)
    page.locator(".term").first.focus()
    assert page.locator("#tip").is_visible()
    assert len(page.locator("#tip").inner_text()) > 20
    page.keyboard.press("Escape")
    assert page.locator("#tip").is_hidden()
    page.evaluate("document.getElementById('differences').open = true")
    mean = page.locator("#differences th", has_text="mean").last
    cells = "[...document.querySelector('#differences tbody').rows].map(row => row.cells[INDEX].dataset.value)"
    column = "() => " + cells.replace("INDEX", str(mean.evaluate("head => head.cellIndex"))) + ".map(Number)"
    mean.locator("button").focus()
    page.keyboard.press("Enter")
    rising = page.evaluate(column)
    page.keyboard.press("Enter")
    assert rising == sorted(rising)
    assert page.evaluate(column) == rising[::-1]


def test_a_table_is_copied_to_the_clipboard_as_csv(browser: Browser, finished: Path) -> None:
    context = browser.new_context(permissions=["clipboard-read", "clipboard-write"])
    page = context.new_page()
    page.goto((finished / "index.html").as_uri())
    page.wait_for_selector("html[data-ready]", state="attached")
    page.evaluate("document.getElementById('differences').open = true")
    page.locator("#differences button.copy").first.click()
    until(page, "document.querySelector('#differences [role=status]')?.textContent")
    lines = page.evaluate("navigator.clipboard.readText()").strip().split("\n")
    assert lines[0].split(",")[:3] == ["scene", "body", "difference"]
    assert len(lines) == 1 + page.locator("#differences tbody").first.locator("tr").count()
    assert page.locator("#differences [role=status]").first.inner_text() == f"{len(lines) - 1} rows copied"
    context.close()


def test_every_folded_plot_is_drawn_when_the_page_goes_to_paper(browser: Browser, finished: Path) -> None:
    page = opened(browser, finished / "verification.html", LAPTOP).page
    drawn = page.evaluate("""() => {
        dispatchEvent(new Event('beforeprint'));
        return [...document.querySelectorAll('[data-plot]')].map(box => Boolean(box.querySelector('svg')));
    }""")
    assert len(drawn) > 1
    assert all(drawn)
    page.close()


def test_paper_shows_plots_and_surfaces_and_no_control(visit: Visit) -> None:
    page = visit.page
    page.emulate_media(media="print")
    pdf = page.pdf(prefer_css_page_size=True)
    controls = page.locator("button:not(.sort):visible, select:visible, nav:visible, input:visible").count()
    surfaces = page.locator("canvas.surface:visible").count()
    page.emulate_media(media="screen")
    assert pdf.startswith(b"%PDF")
    assert controls == 0
    assert surfaces == 3


def test_the_page_is_small_and_soon_usable(browser: Browser, finished: Path) -> None:
    assert (finished / "index.html").stat().st_size < MOST_BYTES / 4, "a study of two scenes on 4 x 4 phases"
    page = browser.new_page(viewport={"width": LAPTOP, "height": 900})
    session = page.context.new_cdp_session(page)
    session.send("Performance.enable", {"timeDomain": "threadTicks"})
    page.goto((finished / "index.html").as_uri())
    page.wait_for_selector("html[data-ready]", state="attached")
    spent = {entry["name"]: entry["value"] for entry in session.send("Performance.getMetrics")["metrics"]}
    assert 0.0 < spent["TaskDuration"] < 1.0  # seen: 0.2 to 0.3
    page.close()


def test_surfaces_without_any_value_are_said_to_have_none(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    analyses_are(monkeypatch, motions=[])
    quick_figures(monkeypatch)
    hierarchy = silenced(*(model.key for model in fake_hierarchy()))
    words = ["fig3-I", "--grid", "2", "--jobs", "2", "--out", str(tmp_path / "report")]
    assert comparison.run.main(words, hierarchy, ThreadPoolExecutor) == 0
    visit = opened(browser, tmp_path / "report" / "index.html", LAPTOP)
    assert visit.page.locator(".three").inner_text().count("no value at any phase pair") == 3
    assert visit.page.locator(".alert.red").count() > 0
    assert visit.complaints == []
    visit.page.close()
