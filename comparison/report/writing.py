"""
Writes the report: index.html and verification.html, which need none of the others; surfaces.nc;
summary.json with its schema and summary.md; junit.xml; figures/.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path

from comparison.analyses.demands.analysis import with_demands
from comparison.report.building import note_lost
from comparison.report.junit import junit
from comparison.report.page import pages
from comparison.report.results import schema_json
from comparison.report.section import Report
from comparison.report.summary_text import summary_text
from comparison.runner.attempts import attempt
from comparison.runner.output import netcdf
from comparison.runner.task import Task


def drawing_tasks(report: Report) -> list[Task]:
    """What workers draw before the report is written."""
    return [task for section in report.sections if section.tasks for task in section.tasks(report)]


def write_report(folder: Path, report: Report) -> None:
    """Write every file of the report into a folder that exists and is empty."""
    results, found = report.results, report.found
    about = {"command": results.run.command, **results.run.provenance}
    lost = [*report.lost]
    contents: dict[str, Callable[[], str | bytes]] = {
        "surfaces.nc": lambda: netcdf(with_demands(report.surfaces, found.get("demands")).assign_attrs(about)),
        "summary.json": results.as_json,
        "summary.schema.json": lambda: schema_json(type(results)),
        "summary.md": lambda: summary_text(results),
        "junit.xml": lambda: junit(results),
    }
    for name, make in contents.items():
        content = attempt(name, make, partial(note_lost, lost))
        if content is not None:
            (folder / name).write_bytes(content.encode() if isinstance(content, str) else content)
    figures = folder / "figures"
    figures.mkdir()
    for name, picture in (found.get("pictures") or {}).items():
        (figures / name).write_bytes(picture)
    for section in report.sections:
        if section.draw and section.present(results):
            attempt(f"pictures of section {section.name}", partial(section.draw, figures, report),
                    partial(note_lost, lost))  # fmt: skip
    for name, text in pages(figures, replace(report, lost=lost)).items():
        (folder / name).write_text(text, encoding="utf-8")
