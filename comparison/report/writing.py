"""
Writes the report: index.html and verification.html, which need none of the others; surfaces.nc;
summary.json with its schema and summary.md; junit.xml; figures/.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from comparison.report.junit import junit_xml
from comparison.report.page import render_pages
from comparison.report.results import schema_json
from comparison.report.section import Report
from comparison.report.summary_text import summary_text
from comparison.runner.attempts import LostParts
from comparison.runner.output import netcdf_content


def write_report(folder: Path, report: Report) -> None:
    """Write every file of the report that can be made into a folder that exists and is empty."""
    results, lost = report.results, LostParts(report.lost)
    contents: dict[str, Callable[[], str | bytes]] = {
        "surfaces.nc": partial(surfaces_file, report),
        "summary.json": results.as_json,
        "summary.schema.json": lambda: schema_json(type(results)),
        "summary.md": lambda: summary_text(results),
        "junit.xml": lambda: junit_xml(results),
    }
    for name, make in contents.items():
        content = lost.attempt(name, make)
        if content is not None:
            (folder / name).write_bytes(content.encode() if isinstance(content, str) else content)
    figures = folder / "figures"
    figures.mkdir()
    for feature in report.features:
        pictures = feature.figures and lost.attempt(f"pictures of {feature.key}", partial(feature.figures, report))
        for name, picture in (pictures or {}).items():
            (figures / name).write_bytes(picture)
    for name, text in render_pages(replace(report, lost=lost.lines)).items():
        (folder / name).write_text(text, encoding="utf-8")


def surfaces_file(report: Report) -> bytes:
    """Return the content of surfaces.nc."""
    surfaces = report.surfaces
    for feature in report.features:
        if feature.dataset:
            surfaces = feature.dataset(surfaces, report.found.get(feature.key))
    run = report.results.run
    return netcdf_content(surfaces.assign_attrs({"command": run.command, **run.provenance}))
