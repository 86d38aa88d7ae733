"""Scaling test: in the report."""

from fractions import Fraction

from comparison.evidence.scaling.analysis import SCALES, Scaling
from comparison.evidence.trend_panels import trend_panels
from comparison.evidence.trends import Trend, word_trends
from comparison.report.feature import Feature, ResultField
from comparison.report.section import Section

FOUND = ResultField(
    Scaling.key,
    list[Trend],
    "the step from small to exact equations over a common scale of loading and friction; null if not computed",
)
FEATURE = Feature(
    Scaling.key,
    (FOUND,),
    analysis=Scaling(),
    section=Section(
        "Scaling test",
        "phase-resonance run makes it, of scenes with phases and without heated friction",
        lambda report: {"trend_panels": trend_panels, "scales": list(map(Fraction, SCALES))},
        verdict=lambda results: word_trends(FOUND.of(results)),
        verifies=True,
    ),
)
