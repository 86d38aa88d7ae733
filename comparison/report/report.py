"""
Writes the report: index.html, which needs none of the others; report.pdf; surfaces.nc; summary.json with its schema
and summary.md; junit.xml; figures/.
"""

from __future__ import annotations

from pathlib import Path

from comparison.analyses.demands.analysis import with_demands
from comparison.report.drawings import assumption_tasks
from comparison.report.findings import Findings
from comparison.report.junit import junit
from comparison.report.page import SECTIONS, page
from comparison.report.pdf import map_tasks, write_pdf
from comparison.report.results import Results, schema_json
from comparison.report.summary_text import summary_text
from comparison.runner.output import netcdf, on_stderr
from comparison.runner.task import Task


def drawing_tasks(results: Results, findings: Findings) -> list[Task]:
    """What workers draw before the report is written."""
    maps = [] if results.no_pdf else [task for _, task in map_tasks(results, findings)]
    return [*maps, *assumption_tasks(findings)]


def write_report(folder: Path, results: Results, findings: Findings) -> None:
    """
    Write every file of the report.

    Parameters
    ----------
    folder : Path
        Exists and is empty.
    results : Results
        What summary.json, summary.md and junit.xml hold.
    findings : Findings
        Surfaces, motions and pictures, which the page shows beside the results.
    """
    run = findings.run
    stamped = with_demands(findings.surfaces, findings.demands).assign_attrs(
        command=run["command"], **run["provenance"]
    )
    (folder / "surfaces.nc").write_bytes(netcdf(stamped))
    texts = {
        "summary.json": results.as_json(),
        "summary.schema.json": schema_json(),
        "summary.md": summary_text(results),
        "junit.xml": junit(results),
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    figures = folder / "figures"
    figures.mkdir()
    for name, content in findings.pictures.items():
        (figures / name).write_bytes(content)
    for section in SECTIONS:
        if section.draw and section.present(results):
            section.draw(figures, findings)
    if not results.no_pdf:
        try:
            write_pdf(folder / "report.pdf", results, findings)
        except RuntimeError as error:  # what typst raises: the rest of the report does not depend on it
            on_stderr(f"report.pdf: not written: {error}")
    (folder / "index.html").write_text(page(figures, findings, results), encoding="utf-8")
