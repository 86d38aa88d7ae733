"""The files of a report."""

import doctest
import json
import math
import re
import shutil
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from jsonschema import Draft202012Validator
from places import ROOT
from pydantic import TypeAdapter
from report_texts import data_of, summary_of

from comparison.registry import StudyResults
from comparison.report.results import Run
from comparison.report.verification import CHECKS
from comparison.surfaces.waterfall import WaterfallBar

PARTS = {
    *("index.html", "verification.html", "surfaces.nc", "summary.json", "summary.schema.json"),
    *("summary.md", "junit.xml", "figures", "manifest.json"),
}


def test_a_report_is_exactly_its_parts(finished: Path) -> None:
    assert {entry.name for entry in finished.iterdir()} == PARTS
    beside = {entry.name for entry in finished.parent.iterdir()}
    assert beside == {"report", "report.tiles"}, "the store, and no working directory left"
    assert (finished / "index.html").stat().st_size < 1.5e6, "a page that opens quickly"


def test_every_file_says_how_long_the_study_took_and_how_it_was_made(finished: Path) -> None:
    run = summary_of(finished)["run"]
    known = run | {"wall_seconds": 1.5, "processor_seconds": 2.25, "jobs": 1}
    assert Run.model_validate(known).word_run_times == "1.5 s of wall time with 1 worker, 2.2 s of processor time"
    took = Run.model_validate(run).word_run_times
    for name in ("index.html", "summary.md"):
        assert took in (finished / name).read_text(encoding="utf-8")
    with xr.open_dataset(finished / "surfaces.nc", engine="h5netcdf") as surfaces:
        assert surfaces.attrs["command"] == run["command"]
        assert run["command"].startswith("python -m comparison.run fig3-I fig4-viscous --grid 4 --jobs 2")
        assert surfaces.attrs["exudyn"] == run["provenance"]["exudyn"]
        assert surfaces.attrs["tolerance"] == 1e-3


def test_the_page_has_the_processor_time_of_every_part(finished: Path) -> None:
    parts, page = summary_of(finished)["run"]["parts"], (finished / "index.html").read_text(encoding="utf-8")
    said = re.search(r"Beside the surfaces, processor time in s[^:]*:(.*?)\.\s*</p>", page, re.DOTALL)
    assert said
    assert " ".join(said[1].split()) == ", ".join(f"{name} {part['seconds']:.1f}" for name, part in parts.items())
    assert len({part["seconds"] for part in parts.values()}) > 1


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


def test_every_check_the_report_lists_exists() -> None:
    for check in CHECKS:
        assert f"def {check.test}(" in (ROOT / "tests" / check.file).read_text(encoding="utf-8"), check


def test_every_key_of_the_summary_is_as_documented(finished: Path) -> None:
    schema = json.loads((finished / "summary.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(schema)
    for part in (schema, *schema["$defs"].values()):
        if "properties" in part:
            limits_of_engines = {"$ref": "#/$defs/Limits"}  # tables under names that users choose
            assert part["additionalProperties"] in (False, limits_of_engines), "an undocumented key is a fault"
            assert all(key.get("description") for key in part["properties"].values())
    text = (finished / "summary.json").read_text(encoding="utf-8")
    assert json.loads(StudyResults.model_validate_json(text).as_json()) == json.loads(text)


def test_motions_of_the_summary_are_at_the_phases_of_the_page(finished: Path) -> None:
    for listed, drawn in zip(summary_of(finished)["scenes"], data_of(finished)["scenes"]):
        motions = {(motion["why"], *motion["phases"]) for motion in listed["demands"]}
        assert motions == {(place["why"], *place["phases"]) for place in drawn["places"]}
        assert any(first < second for _, first, second in motions), "not as many on either side of the diagonal"


def test_a_missing_number_is_null_in_one_way() -> None:
    form, bar = TypeAdapter(WaterfallBar), WaterfallBar("exact", math.nan, math.inf, resolved=False)
    written = form.dump_python(bar, mode="json")
    assert written == {"model": "exact", "size": None, "error": None, "resolved": False}
    assert math.isnan(form.validate_python(written).size)


@pytest.mark.long
def test_the_script_finds_a_changed_bit_and_a_changed_number(finished: Path, tmp_path: Path) -> None:
    def compare(after: Path) -> tuple[int, list[str]]:
        command = [sys.executable, ROOT / "docs/compare_studies.py", finished, after]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout.splitlines()

    assert compare(tmp_path)[0] == 2, "a folder without a report"
    other = tmp_path / "other"
    shutil.copytree(finished, other)
    summary = summary_of(other)
    summary["run"]["wall_seconds"] += 1.0
    summary["scenes"][0]["models"]["small"]["cost"] += 1.0
    (other / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    code, lines = compare(other)
    assert (code, lines[-1].endswith(": 0 differences.")) == (0, True), lines

    summary["scenes"][0]["differences"][0]["median"] += 1e-15
    (other / "summary.json").write_text(json.dumps(summary), encoding="utf-8")
    surfaces = xr.load_dataset(other / "surfaces.nc")
    mu = surfaces["mu"].values
    mu.flat[0] = np.nextafter(mu.flat[0], np.inf)
    surfaces.to_netcdf(other / "surfaces.nc", engine="h5netcdf")
    code, lines = compare(other)
    places = "surfaces.nc: mu: 1 of", "summary.json: scenes[0].differences[0].median:"
    assert (code, len(lines), [line.startswith(place) for line, place in zip(lines, places)]) == (1, 3, [True] * 2)
