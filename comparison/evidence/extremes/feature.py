"""Stability at the extremes: in the report."""

from comparison.evidence.extremes.matrix import MEANING, STORED, Matrix, Verdict, describe
from comparison.report.section import Feature, Section

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
        verifies=True,
        verdict=lambda results: results.of("extremes").count_line,
    ),
)
