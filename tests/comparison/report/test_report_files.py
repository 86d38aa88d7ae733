"""The files of a report."""

import doctest
import json
import math
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from html import unescape
from html.parser import HTMLParser
from importlib import import_module
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
import xarray as xr
from jsonschema import Draft202012Validator
from places import ROOT
from pydantic import TypeAdapter
from report_texts import Tables, both_pages, page_of, summary_of

from comparison.registry import StudyResults
from comparison.report.pdf_data import _limits, _model
from comparison.report.verification import CHECKS, Check
from comparison.study.models import MODEL_HIERARCHY
from comparison.surfaces.waterfall import WaterfallBar
from reference.problem import load_scene

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


LIMITS = ("median", "maximum", "ratio", "closure", "failed")


def test_the_summary_names_every_broken_limit_and_every_verdict(finished: Path) -> None:
    text = (finished / "summary.md").read_text(encoding="utf-8")
    assert "12 acceptance limits broken" in text
    assert r"- fig3-I: body 1: acceptance.median: 0.01 found, 0.0001 allowed" in text
    assert "- **fig3-I** (Fig. 3a, b" in text
    assert "Cause: elastic contact, not geometry" in text, "the only model of the hierarchy that differs"
    assert "No building has been compared, and this study has no measured peaks" in text


def test_junit_fails_the_broken_limits_of_every_scene(finished: Path) -> None:
    suites = ElementTree.parse(finished / "junit.xml").getroot()
    assert [suite.get("name") for suite in suites] == ["fig3-I", "fig4-viscous"]
    for suite in suites:
        acceptance = load_scene(str(suite.get("name"))).acceptance
        cases = suite.findall("testcase")
        assert [case.get("name") for case in cases] == [f"acceptance.{k} = {getattr(acceptance, k):g}" for k in LIMITS]
        failed = [case for case in cases if case.find("failure") is not None]
        assert [str(case.get("name")).split()[0] for case in failed] == [
            "acceptance.median",
            "acceptance.maximum",
            "acceptance.ratio",
        ]
        assert suite.get("failures") == "3"
        text = str(failed[0].findtext("failure"))
        assert [line.split(": ")[1] for line in text.splitlines()] == ["body 1", "body 2"], "both bodies break it"


def test_the_pdf_counts_broken_limits_and_adds_the_costs_of_all_scenes(finished: Path) -> None:
    summary = summary_of(finished)
    for scene, cost in zip(summary["scenes"], (10.0, 20.0), strict=True):
        scene["models"]["small"]["cost"] = cost
    results = StudyResults.model_validate(summary)
    assert _model(results, results.models[0])["seconds"] == "30.0"
    assert _limits(results)["limits_line"].strip() == "6 of 10 acceptance limits are broken."


def test_every_assumption_is_one_row_of_the_models(finished: Path) -> None:
    [table] = [table for table in Tables(page_of(finished)).tables if table[0][:2] == ["model", "small equations"]]
    names = [row[0] for row in table]
    assert len(names) == len(set(names)) > 3


def test_the_contact_force_of_the_scene_is_the_weight(finished: Path) -> None:
    rows = Tables(both_pages(finished)).headed("contact force, N", "total mass, kg")
    weights = [
        (float(row["contact force, N"]), float(row["total mass, kg"])) for row in rows if row["model"] == "as stated"
    ]
    assert [force for force, _ in weights] == pytest.approx([9.81 * mass for _, mass in weights], rel=2e-3)
    assert weights


def _objects(schema: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Every schema inside a schema."""
    yield schema
    inner = [*schema.get("properties", {}).values(), *schema.get("$defs", {}).values()]
    inner += [schema.get("items"), schema.get("additionalProperties"), *schema.get("anyOf", [])]
    for part in inner:
        if isinstance(part, dict):
            yield from _objects(part)


def test_every_key_of_the_summary_is_as_documented(finished: Path) -> None:
    schema = json.loads((finished / "summary.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(schema)
    summary = summary_of(finished)
    assert [error_message.message for error_message in Draft202012Validator(schema).iter_errors(summary)] == []
    for part in _objects(schema):
        if "properties" in part:
            limits_of_engines = {"$ref": "#/$defs/Limits"}  # tables under names that users choose
            assert part["additionalProperties"] in (False, limits_of_engines), "an undocumented key is a fault"
            assert all(key.get("description") for key in part["properties"].values())


def test_the_summary_read_back_is_the_results(finished: Path) -> None:
    text = (finished / "summary.json").read_text(encoding="utf-8")
    assert json.loads(StudyResults.model_validate_json(text).as_json()) == json.loads(text)


def test_a_missing_number_is_null_in_one_way() -> None:
    form, bar = TypeAdapter(WaterfallBar), WaterfallBar("exact", math.nan, math.inf)
    written = form.dump_python(bar, mode="json")
    assert written == {"model": "exact", "size": None, "error": None, "real": False}
    assert math.isnan(form.validate_python(written).size)


SCRIPT = ROOT / "docs/compare_studies.py"


def compare(before: Path, after: Path) -> tuple[int, str]:
    """Exit code and output of the script."""
    done = subprocess.run([sys.executable, SCRIPT, before, after], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout


@pytest.mark.long
def test_a_changed_bit_and_a_changed_number_are_found(finished: Path, tmp_path: Path) -> None:
    other = tmp_path / "other"
    shutil.copytree(finished, other)
    summary = summary_of(other)
    summary["run"]["wall_seconds"] += 1.0
    for model in summary["scenes"][0]["models"].values():
        model["cost"] += 1.0
    (other / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    code, out = compare(finished, other)
    assert (code, out.splitlines()[-1].endswith(": 0 differences.")) == (0, True), out

    summary["scenes"][0]["differences"][0]["median"] += 1e-15
    (other / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    surfaces = xr.load_dataset(other / "surfaces.nc")
    mu = surfaces["mu"].values
    mu.flat[0] = np.nextafter(mu.flat[0], np.inf)
    surfaces.to_netcdf(other / "surfaces.nc", engine="h5netcdf")
    code, out = compare(finished, other)
    assert code == 1
    lines = out.splitlines()
    assert lines[0].startswith("surfaces.nc: mu: 1 of "), out
    assert lines[1].startswith("summary.json: scenes[0].differences[0].median: "), out
    assert len(lines) == 3, out


@pytest.mark.long
def test_a_folder_without_a_report_is_refused(finished: Path, tmp_path: Path) -> None:
    assert compare(finished, tmp_path)[0] == 2
