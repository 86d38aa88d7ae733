"""Stability at the extremes: in the report."""

from pathlib import Path

from comparison.analyses.extremes.matrix import MEANING, PICTURE, STORED, Matrix, Verdict, describe
from comparison.report.section import Feature, Report, Section


def _draw(figures: Path, report: Report) -> None:
    from comparison.analyses.extremes.figure import draw_extremes  # matplotlib: only a report that draws here needs it

    draw_extremes(figures / PICTURE, report.results.of("extremes"))


FEATURE = Feature(
    "extremes",
    Matrix,
    "every model at the extremes of every quantity; null unless python -m comparison.extremes left it beside the "
    "report",
    load=STORED.load,
    section=Section(
        "Stability at the extremes",
        "python -m comparison.extremes makes it, beside the report; the next run of the study shows it",
        lambda report, figures: {
            "verdicts": [(verdict.value, MEANING[verdict]) for verdict in Verdict],
            "describe": describe,
        },
        draw=_draw,
        verifies=True,
        verdict=lambda results: results.of("extremes").count_line,
    ),
)
