"""Scaling test: in the report."""

from comparison.evidence.scaling.analysis import Scaling
from comparison.evidence.trend_panels import trend_panels
from comparison.evidence.trends import Trend, word_trends
from comparison.report.section import Feature, Section

FEATURE = Feature(
    "scaling",
    list[Trend],
    "the step from small to exact equations over a common scale of loading and friction; null if not computed",
    analysis=Scaling(),
    section=Section(
        "Scaling test",
        "python -m comparison.run makes it, of scenes with phases and without heated friction",
        lambda report, figures: {"trend_panels": trend_panels},
        verdict=lambda results: word_trends(results.of("scaling")),
        verifies=True,
    ),
)
