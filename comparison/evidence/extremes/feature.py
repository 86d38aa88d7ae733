"""Stability at the extremes: in the report."""

from comparison.evidence.extremes.matrix import MEANING, STORED, Matrix, Verdict, describe
from comparison.report.feature import Feature, ResultField
from comparison.report.section import Section

FOUND = ResultField(
    "extremes",
    Matrix,
    "every model at the extremes of every quantity; null unless phase-resonance extremes left it beside the report",
    load=STORED.load,
)
FEATURE = Feature(
    "extremes",
    (FOUND,),
    section=Section(
        "Stability at the extremes",
        "phase-resonance extremes makes it, beside the report; the next run of the study shows it",
        lambda report: {
            "verdicts": [(verdict.value, MEANING[verdict]) for verdict in Verdict],
            "describe": describe,
        },
        verifies=True,
        verdict=lambda results: FOUND.of(results).count_line,
    ),
)
