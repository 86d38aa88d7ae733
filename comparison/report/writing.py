"""
Writes the report: index.html and verification.html, which need none of the others; surfaces.nc;
summary.json with its schema and summary.md; junit.xml; figures/.
"""

from pathlib import Path

from comparison.report.junit import junit
from comparison.report.page import pages
from comparison.report.results import schema_json
from comparison.report.section import Report
from comparison.report.summary_text import summary_text
from comparison.runner.output import netcdf


def write_report(folder: Path, report: Report) -> None:
    """Write every file of the report into a folder that exists and is empty."""
    results, surfaces = report.results, report.surfaces
    for feature in report.features:
        if feature.dataset:
            surfaces = feature.dataset(surfaces, report.found.get(feature.key))
    about = {"command": results.run.command, **results.run.provenance}
    (folder / "surfaces.nc").write_bytes(netcdf(surfaces.assign_attrs(about)))
    texts = {
        "summary.json": results.as_json(),
        "summary.schema.json": schema_json(type(results)),
        "summary.md": summary_text(results),
        "junit.xml": junit(results),
        **pages(report),
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    figures = folder / "figures"
    figures.mkdir()
    for feature in report.features:
        for name, content in feature.figures(report).items() if feature.figures else ():
            (figures / name).write_bytes(content)
