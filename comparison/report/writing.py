"""
Writes the report: index.html and verification.html, which need none of the others; surfaces.nc;
summary.json with its schema and summary.md; junit.xml; figures/.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from comparison.report.junit import format_limits_as_junit
from comparison.report.page import render_pages
from comparison.report.results import format_schema
from comparison.report.section import Report
from comparison.report.summary_text import render_summary_text
from comparison.runner.attempts import LostParts
from comparison.runner.output import encode_netcdf


def write_report(folder: Path, report: Report) -> None:
    """Write the files of the report into an existing empty folder; leave out a file whose making raises an error."""
    results, lost = report.results, LostParts(report.lost)
    contents: dict[str, Callable[[], str | bytes]] = {
        "surfaces.nc": partial(encode_surfaces, report),
        "summary.json": results.as_json,
        "summary.schema.json": lambda: format_schema(type(results)),
        "summary.md": lambda: render_summary_text(results),
        "junit.xml": lambda: format_limits_as_junit(results),
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


def encode_surfaces(report: Report) -> bytes:
    """Return the bytes of surfaces.nc, the netCDF file of the amplification surfaces and what features add."""
    surfaces = report.surfaces
    for feature in report.features:
        if feature.dataset:
            surfaces = feature.dataset(surfaces, report.found.get(feature.key))
    run = report.results.run
    return encode_netcdf(surfaces.assign_attrs({"command": run.command, **run.provenance}))
