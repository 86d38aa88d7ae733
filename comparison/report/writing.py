"""
Writes the report: index.html and verification.html, which need none of the others; surfaces.nc;
summary.json with its schema and summary.md; junit.xml; figures/.
"""

from pathlib import Path

from comparison.analyses.demands.analysis import with_demands
from comparison.report.junit import junit
from comparison.report.page import pages
from comparison.report.results import schema_json
from comparison.report.section import Report
from comparison.report.summary_text import summary_text
from comparison.runner.output import netcdf
from comparison.runner.task import Task


def drawing_tasks(report: Report) -> list[Task]:
    """What workers draw before the report is written."""
    return [task for section in report.sections if section.tasks for task in section.tasks(report)]


def write_report(folder: Path, report: Report) -> None:
    """Write every file of the report into a folder that exists and is empty."""
    results, found = report.results, report.found
    about = {"command": results.run.command, **results.run.provenance}
    surfaces = with_demands(report.surfaces, found.get("demands")).assign_attrs(about)
    (folder / "surfaces.nc").write_bytes(netcdf(surfaces))
    texts = {
        "summary.json": results.as_json(),
        "summary.schema.json": schema_json(type(results)),
        "summary.md": summary_text(results),
        "junit.xml": junit(results),
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    figures = folder / "figures"
    figures.mkdir()
    for name, content in (found.get("pictures") or {}).items():
        (figures / name).write_bytes(content)
    for section in report.sections:
        if section.draw and section.present(results):
            section.draw(figures, report)
    for name, text in pages(figures, report).items():
        (folder / name).write_text(text, encoding="utf-8")
