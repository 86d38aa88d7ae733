"""The page in a browser."""

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from axe_playwright_python.sync_playwright import Axe
from browsers import CHROMIUM, DESKTOP, LAPTOP, OVERLAPS, PHONE, Scheme, Visit, opened, unfolded, until
from fake_models import fake_hierarchy, known_motions, silenced
from known_analyses import analyses_are
from places import HELPERS
from playwright.sync_api import Browser
from runs import quick_figures

import comparison.run
from reference.problem import example_scenes

SVG = "{http://www.w3.org/2000/svg}"
PROBES = (HELPERS / "page_probes.js").read_text(encoding="utf-8")
SERIOUS = ("serious", "critical")

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")


@pytest.fixture
def visit(browser: Browser, finished: Path) -> Iterator[Visit]:
    """The page as it opens. Whatever a test does to it, it complains of nothing and asks no network for anything."""
    visit = opened(browser, finished / "index.html", LAPTOP, first=PROBES)
    yield visit
    visit.page.close()
    assert visit.complaints == []
    assert visit.requests == [(finished / "index.html").as_uri()]


def test_ticks_tell_as_many_digits_as_their_distance_asks_for(visit: Visit) -> None:
    for low, high, texts in (
        (6.83e5, 6.89e5, ["6.84·10⁵", "6.86·10⁵", "6.88·10⁵"]),
        (-3e-4, 1e-4, ["−2·10⁻⁴", "0"]),
        (0.0, 100.0, ["0", "50", "100"]),
    ):
        assert [text for _, text in visit.page.evaluate(f"ticksOf({{}}, [{low}, {high}], 3)")] == texts
    assert visit.page.evaluate("probe.ranges()") == [
        [[1.5, 6.0], pytest.approx([2.67, 3.33])], [pytest.approx([4**-0.06, 4**1.06]), pytest.approx([-2.3, 4.3])]
    ]  # fmt: skip


def test_a_plot_with_logarithms_has_marks_bands_and_bars_where_they_belong(visit: Visit) -> None:
    told = visit.page.evaluate("probe.plotWithLogarithms()")
    assert (told["titles"], told["legends"], told["path"].count("M")) == (["p", "s"], 0, 2), "-1 has no logarithm"
    assert told["around"] == told["around"][::-1], "there along the top, and back"
    assert told["shifts"] == ["3", "-3"], "down to the index, and up again"
    assert "NaN" not in told["text"]
    first, last = told["bars"]  # from 1, the lower end of the axis, to 20, and from 20 to 40
    assert first / last == pytest.approx(np.log(20.0) / np.log(2.0), rel=0.02)
    at_supports, of_platform = visit.page.evaluate("probe.contactPaths()")  # from (10, 30) to (20, 40) mm, by 0.2 rad
    expected = [{"x": [-5.0, 190.0], "y": [-15.0, -120.0]}, {"x": [-5.0, 390.0], "y": [-15.0, 280.0]}]
    assert [{axis: pytest.approx(path[axis]) for axis in path} for path in expected] == at_supports
    assert of_platform == [{"x": [-10.0, -20.0], "y": [-30.0, -40.0]}]
    assert visit.page.evaluate("probe.corner()") == pytest.approx([2.0 * np.pi] * 2), "the square is closed"


@pytest.mark.parametrize("width", [PHONE, DESKTOP])
def test_no_two_texts_overlap_and_all_fits_the_window(width: int, browser: Browser, finished: Path) -> None:
    for name, bars in (("index.html", "mean"), ("index.html", "largest"), ("verification.html", "")):
        visit = opened(browser, finished / name, width)
        unfolded(visit.page)
        if bars:
            visit.page.locator(f"button[data-bars={bars}]").click()
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


def test_a_button_shows_the_bars_of_the_mean_or_of_the_largest(visit: Visit) -> None:
    visit.page.locator("#effects > summary").click()
    for name, shown, hidden in (("at the largest difference", "largest", "mean"), ("mean over", "mean", "largest")):
        visit.page.get_by_role("button", name=name).click()
        assert visit.page.locator(f"[data-waterfall={shown}]:visible").count() == 4, "two bodies of two scenes"
        assert visit.page.locator(f"[data-waterfall={hidden}]:visible").count() == 0


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
        const far = place => Math.hypot(...place.phases.map((p, k) => Math.acos(Math.cos(p - state.cursor[k]))));
        const { places } = sceneNow(), picked = Number(document.querySelector('[data-part=place]').value);
        return { away: state.away, least: Math.min(...places.map(far)), here: far(places[state.place]),
          picked: picked === state.place };
    }""")
    assert chosen["away"] == pytest.approx(chosen["least"]) == pytest.approx(chosen["here"])
    assert chosen["picked"]
    across = page.evaluate("[[0.1, turn - 0.2], [turn - 0.2, 0.1], [1, 4], [3.5, 3]].map(pair => around(...pair))")
    assert across == pytest.approx([0.3, 0.3, 3.0, 0.5]), "the square is periodic"
    assert "small equations" in page.locator("[data-part=plots] .legend").first.inner_text()


def test_the_second_body_has_its_own_surfaces(visit: Visit) -> None:
    page = visit.page
    told = page.evaluate("probe.surfacesOfSecondBody()")
    assert told["opened"] == ["total", 1, "translational", 0], "the largest difference of the body, by both models"
    assert told["readout"].startswith("(180°, 180°): small equations, as integrated 3, ")
    assert told["readout"].endswith(" 9 (error unknown), difference +200\u00a0% ± 7")
    assert told["name"] == "μ2, translational engine, as integrated"
    points, coarse, apart, completed, surfaces = told["seen"]
    assert points[0]["rows"][0] == pytest.approx([5.0, 5.0 + 1.0, 5.0, 5.0 - 1.0]), "4 + cos alpha1 + sin alpha2"
    assert points[0]["notes"][-1] == "largest over all phases: 8.25 at (90°, 180°)\u00a0▿"
    assert [(point["z"], point["error"]) for point in points[1]["points"]] == [(9, 0.3), (9, 0.4), (9, 0.5), (9, None)]
    assert [points[2]["points"][0][key] for key in ("z", "error")] == pytest.approx([80.0, 7.0])
    assert (len(coarse[0]["points"]), coarse[0]["notes"][0]) == (4, "2 × 2 of 4 × 4 phases")
    assert [[panel["sheet"] for panel in panels] for panels in (points, coarse, apart, completed)] == [
        [True, False, False], [False, False, False], [True, True, False], [True, True, True]
    ]  # fmt: skip
    assert surfaces[2]["lines"] == [[[1, 2], [3, 4]]]
    page.evaluate("state.cursor = [0, 0]")
    page.locator("canvas.surface").first.focus()
    for key in ("ArrowUp", "ArrowLeft"):
        page.keyboard.press(key)
    assert page.evaluate("state.cursor") == pytest.approx([1.5 * np.pi, 0.5 * np.pi])
    box = page.locator("canvas.surface").first.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 100.0, box["y"] + 100.0)
    page.mouse.down()
    page.mouse.move(box["x"] + 130.0, box["y"] + 140.0)
    page.mouse.up()
    assert page.evaluate("[camera.azimuth, camera.elevation]") == pytest.approx([-0.65 - 0.2, 0.5 + 0.2])
    page.locator("button[data-turn='-1']").click()
    page.mouse.move(box["x"] + 100.0, box["y"] + 240.0)
    page.mouse.down()
    page.mouse.move(box["x"] + 100.0, box["y"] + 10.0)
    page.mouse.up()
    assert page.evaluate("[camera.azimuth, camera.elevation]") == pytest.approx([-0.85 - np.pi / 8.0, 0.1])
    notes = page.evaluate("probe.notesOfMotions()")
    assert notes == ["small equations, as integrated ended early: rim reached", "translational engine: it broke"]


def test_the_second_body_has_its_own_motion(visit: Visit) -> None:
    told = visit.page.evaluate("probe.motionOfSecondBody()")
    ends = {each[0]: each[1] for each in told["last"] if len(each) == 2}
    assert {title: ends[title] for title in list(ends)[:5]} == {
        "displacement of the body 2 in x": [1, 13000],
        "displacement of the body 2 in y": [1, -14000],
        "absolute acceleration of the body 2": [1, 5],
        "loop of the isolator in x": [11000, 21],
        "loop of the isolator in y": [12000, 22],
    }
    assert [last[1] for title, last in ends.items() if title.startswith("floor spectrum of the body 2 in")] == [20, 21]
    platform, above, moved, moved_above = told["middles"]
    assert (moved_above - above) / (moved - platform) == pytest.approx(13.0 / 11.0)
    assert told["colors"][0] == told["colors"][1], "that of the second model"
    assert told["said"] == "horizontal: 14000 mm to either side"
    (x, y), (x1, y1) = told["above"]
    assert (y1 - y) / (x1 - x) == pytest.approx(-12.0 / 11.0), "up the canvas is negative"
    assert told["played"] == [["pause", 0.5, 2], ["play", 0.5, 2]], "from the begin, as fast as the motion"
    both, half, none = visit.page.evaluate("probe.demands()")
    assert both == [
        ["largest displacement of the isolator, mm", "200 ± 30", "250 ± 20", "+25\u00a0%, within the errors"],
        ["largest displacement, share of the travel", "none", "0.5", ""],
        ["base shear, N", "4 ± 0.1", "3 ± 0.1", "−25\u00a0%"],
    ]
    assert none == [], "no table without a demand"
    assert [row[1:3] for row in half] == [["none", "250 ± 20"], ["none", "0.5"], ["none", "3 ± 0.1"]]


def test_cells_without_a_number_stand_beside_the_numbers_of_a_sorted_table(visit: Visit) -> None:
    rows = (
        "".join(f"<tr><td>{text}</td></tr>" for text in ("3", "", "-2", "x")) + "<tr><td data-value='10'>ten</td></tr>"
    )
    read = "[...table.tBodies[0].rows].map(row => row.cells[0].textContent)"
    sort = f"""() => {{
        const table = document.createElement("table");
        table.innerHTML = "<thead><tr><th>a</th></tr></thead><tbody>{rows}</tbody>";
        const [heading] = table.tHead.rows[0].cells, seen = [];
        for (const _ of [0, 1]) {{ sortBy(table, heading, 0); seen.push([...{read}, heading.ariaSort]); }}
        return seen;
    }}"""
    assert visit.page.evaluate(sort) == [
        ["", "-2", "3", "ten", "x", "ascending"], ["x", "ten", "3", "-2", "", "descending"]
    ]  # fmt: skip


def test_keys_alone_reach_motions_tips_and_tables(visit: Visit) -> None:
    page = visit.page
    page.locator("canvas.surface").first.focus()
    for key in ("ArrowRight", "ArrowUp", "Enter"):
        page.keyboard.press(key)
    assert "away" in page.locator("[data-part=distance]").inner_text()
    page.mouse.move(0, 0)
    page.locator(".term").first.focus()
    assert page.locator("#tip").is_visible()
    assert page.locator("#tip").inner_text() == page.locator(".term").first.get_attribute("data-tip")
    page.keyboard.press("Escape")
    assert page.locator("#tip").is_hidden()
    page.evaluate("location.hash = 'differences'")
    until(page, "document.getElementById('differences').open")
    mean = page.locator("#differences th", has_text="mean").last
    cells = "[...document.querySelector('#differences tbody').rows].map(row => row.cells[INDEX].dataset.value)"
    column = "() => " + cells.replace("INDEX", str(mean.evaluate("head => head.cellIndex"))) + ".map(Number)"
    mean.locator("button").focus()
    page.keyboard.press("Enter")
    rising = page.evaluate(column)
    page.keyboard.press("Enter")
    assert rising == sorted(rising)
    assert page.evaluate(column) == rising[::-1]


def test_a_table_is_copied_to_the_clipboard_as_csv(visit: Visit) -> None:
    page = visit.page
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.evaluate("document.getElementById('differences').open = true")
    page.locator("#differences button.copy").first.click()
    until(page, "document.querySelector('#differences [role=status]')?.textContent")
    lines = page.evaluate("navigator.clipboard.readText()").strip().split("\n")
    assert lines[0].split(",")[:3] == ["scene", "body", "difference"]
    assert len(lines) == 1 + page.locator("#differences tbody").first.locator("tr").count()
    assert page.locator("#differences [role=status]").first.inner_text() == f"{len(lines) - 1} rows copied"
    texts = page.evaluate("""() => {
        const table = document.createElement("table");
        ["=1+1", "@x", "a = b", 'c, "d"'].forEach(text => { table.insertRow().insertCell().textContent = text; });
        table.createTBody().insertRow().insertCell().dataset.value = "e\\nf";
        document.body.append(table);
        equipTable(table);
        table.nextSibling.querySelector("button.copy").click();
        return csvOf(table);
    }""")
    assert texts == '\'=1+1\n\'@x\na = b\n"c, ""d"""\n"e\nf"\n', "no formula"
    until(page, "document.querySelector('body > p.tools [role=status]').textContent")
    assert page.locator("body > p.tools [role=status]").inner_text() == "5 rows copied"


def test_every_plot_is_saved_as_svg_that_needs_nothing_else(browser: Browser, finished: Path) -> None:
    names: list[str] = []
    for name, least in (("index.html", 8), ("verification.html", 2)):
        visit = opened(browser, finished / name, LAPTOP, "dark")
        page = visit.page
        unfolded(page)
        plots = page.locator("figure:has(svg.plot-svg)")
        assert plots.count() == page.locator("button.save").count() >= least
        for number in range(plots.count()):
            plot = plots.nth(number)
            page.wait_for_timeout(150)  # a browser saves ten files a second for a page, and no more
            with page.expect_download() as saved:
                plot.locator("button.save").click()
            file = saved.value
            root = ElementTree.fromstring(file.path().read_text(encoding="utf-8"))
            drawn = ["".join(each.itertext()) for each in root.iter(f"{SVG}text")]
            shown = plot.locator("svg.plot-svg text").evaluate_all("list => list.map(each => each.textContent)")
            named = plot.locator(".legend li").evaluate_all("list => list.map(each => each.textContent)")
            caption = plot.locator("figcaption").evaluate("caption => caption.firstChild.textContent")
            assert [text for text in (*shown, *named, caption) if text not in " ".join(drawn)] == []
            assert not any(name in each.attrib for each in root.iter() for name in ("class", "style", "href"))
            lines = [each for each in root.iter(f"{SVG}path") if each.get("stroke") not in (None, "none")]
            assert all(each.get("fill") == "none" and float(each.get("stroke-width", "0px")[:-2]) > 0 for each in lines)
            assert next(root.iter(f"{SVG}rect")).get("fill") == "#fff", "on white, however dark the screen"
            names.append(file.suggested_filename)
        page.close()
        assert (visit.complaints, len(visit.requests)) == ([], 1)
    assert names[0] == "fig3-I-displacement-of-the-platform-in-x.svg"
    assert sorted(names[-2:]) == ["convergence-fig3-I.svg", "scaling-fig3-I.svg"]


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


def test_the_page_shows_tables_and_motions_of_records(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    analyses_are(monkeypatch, motions=known_motions)
    words = [*example_scenes(), "--grid", "4", "--jobs", "1", "--out", str(tmp_path / "report")]
    assert comparison.run.main(words, fake_hierarchy(), ThreadPoolExecutor) == 0
    visit = opened(browser, tmp_path / "report" / "index.html", PHONE)
    page = visit.page
    assert page.locator("canvas.surface:visible").count() == 0
    assert page.locator("[data-record]:visible tbody tr").count() == len(fake_hierarchy()), "one row for each model"
    page.locator("[data-part=pair]").select_option("like-for-like")
    until(page, "document.querySelector('[data-part=plots] .legend')?.textContent.includes('translational')")
    page.locator("[data-part=scene]").select_option(index=1)
    page.locator("[data-part=body]").select_option("2")
    assert page.locator("[data-record='1-2']").is_visible()
    unfolded(page)
    assert page.evaluate(OVERLAPS)["faults"] == []
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert "phases per axis" not in page.inner_text("main")
    assert (visit.complaints, len(visit.requests)) == ([], 1)
    page.close()
