"""The files of a report."""

import doctest
import re
from html import unescape
from html.parser import HTMLParser
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from places import ROOT
from report_texts import page_of, summary_of

from comparison.report.verification import CHECKS, Check
from comparison.study.models import MODEL_HIERARCHY

GRID = 4
PARTS = {
    "index.html",
    "verification.html",
    "report.pdf",
    "surfaces.nc",
    "summary.json",
    "summary.schema.json",
    "summary.md",
    "junit.xml",
    "figures",
    "manifest.json",
}


@pytest.fixture(scope="module")
def surfaces(finished: Path) -> xr.Dataset:
    with xr.open_dataset(finished / "surfaces.nc", engine="h5netcdf") as data:
        return data.load()


def test_a_report_is_exactly_its_parts(finished: Path) -> None:
    assert {entry.name for entry in finished.iterdir()} == PARTS
    beside = {entry.name for entry in finished.parent.iterdir()}
    assert beside == {"report", "report.tiles"}, "the store, and no working directory left"


def test_surfaces_are_labeled_by_scene_model_body_and_phases(surfaces: xr.Dataset) -> None:
    assert surfaces["mu"].dims == ("scene", "model", "body", "alpha1", "alpha2")
    assert surfaces["error"].dims == surfaces["mu"].dims
    assert surfaces["status"].dims == ("scene", "model", "alpha1", "alpha2")
    assert list(surfaces["scene"].values) == ["fig3-I", "fig4-viscous"]
    assert list(surfaces["model"].values) == [model.key for model in MODEL_HIERARCHY]
    assert list(surfaces["body"].values) == [1, 2]
    for name in ("alpha1", "alpha2"):
        np.testing.assert_allclose(surfaces[name], 2.0 * np.pi * np.arange(GRID) / GRID, rtol=1e-15)
        assert surfaces[name].attrs["units"] == "rad"


def test_a_model_that_does_not_apply_is_nan_and_says_so(surfaces: xr.Dataset) -> None:
    regularized = surfaces.sel(scene="fig4-viscous", model="regularised")
    assert np.isnan(regularized["mu"]).all()
    assert (regularized["status"] == "not applicable").all()


def test_the_file_carries_its_own_provenance(surfaces: xr.Dataset) -> None:
    assert surfaces.attrs["command"].startswith("python -m comparison.run fig3-I fig4-viscous --grid 4")
    assert surfaces.attrs["exudyn"].startswith("1.")
    assert surfaces.attrs["tolerance"] == 1e-3


def test_differences_are_the_planted_one_percent(finished: Path) -> None:
    summary = summary_of(finished)
    rows = [row for scene in summary["scenes"] for row in scene["differences"]]
    assert len(rows) == 2 * 2 * 3, "scenes x bodies x pairs"
    for row in rows:
        for key in ("median", "percentile95", "maximum"):
            assert row[key] == pytest.approx(0.01, rel=1e-12)  # rounding of a quotient near 1
        assert row["beyond_error"] == 1.0, "1 % is well above the 0.1 % both sides claim"
        assert (row["not_ok"], row["unanswered"]) == (0, 0)
    dry = {row["pair"]: (row["first"], row["second"]) for row in summary["scenes"][0]["differences"]}
    wet = {row["pair"]: (row["first"], row["second"]) for row in summary["scenes"][1]["differences"]}
    both = {"total": ("small", "spatial"), "translational": ("small", "translational")}
    assert dry == {**both, "like-for-like": ("regularised", "translational")}
    assert wet == {**both, "like-for-like": ("exact", "translational")}


def test_every_body_of_every_scene_has_its_figures(finished: Path) -> None:
    shown = ("total", "translational", "like-for-like", "budget")
    names = {f"body{body}-{pair}.png" for body in (1, 2) for pair in shown}
    names |= {f"{kind}.{ending}" for kind in ("paper", "assumptions") for ending in ("png", "pdf")}
    expected = {f"{scene}-{name}" for scene in ("fig3-I", "fig4-viscous") for name in names}
    assert {entry.name for entry in (finished / "figures").iterdir()} == expected


class _Requests(HTMLParser):
    """Every address a browser would load by itself."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name in {"src", "href", "data", "poster", "srcset", "action"} and value:
                self.found.append(value)


def test_the_page_needs_no_other_file_and_no_network(finished: Path) -> None:
    page = page_of(finished)
    parser = _Requests()
    parser.feed(page)
    assert parser.found, "the figures are there"
    assert [value[:40] for value in parser.found if not value.startswith(("data:", "#"))] == ["verification.html"]
    policy = unescape(page.split('http-equiv="Content-Security-Policy" content="', 1)[1].split('"', 1)[0])
    assert "default-src 'none'" in policy, "the browser itself refuses whatever a library might ask for"
    style = page.split("<style>", 1)[1].split("</style>", 1)[0]
    assert re.findall(r"@import|url\(", style) == []


MODULES = [
    ".".join(file.relative_to(ROOT).with_suffix("").parts)
    for file in sorted((ROOT / "comparison").rglob("*.py"))
    if ">>> " in file.read_text(encoding="utf-8")
]


@pytest.mark.parametrize("name", MODULES)
def test_an_example_gives_what_it_shows(name: str) -> None:
    result = doctest.testmod(import_module(name))
    assert result.attempted > 0
    assert result.failed == 0


TESTS = ROOT / "tests"


@pytest.mark.parametrize("check", CHECKS, ids=lambda check: check.test)
def test_every_check_the_report_lists_exists(check: Check) -> None:
    assert f"def {check.test}(" in (TESTS / check.file).read_text(encoding="utf-8")


def test_the_report_lists_them(finished: Path) -> None:
    page = page_of(finished, "verification.html")
    for check in CHECKS:
        assert check.test in page
