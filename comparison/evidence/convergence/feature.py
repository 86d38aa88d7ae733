"""Convergence of friction law and contact: in the report."""

from comparison.evidence.convergence.analysis import Convergence
from comparison.evidence.trend_panels import trend_panels
from comparison.evidence.trends import Trend, word_trends
from comparison.report.section import Feature, Section

FEATURE = Feature(
    "convergence",
    list[Trend],
    "what the steps of friction law and contact tend to; null if not computed",
    analysis=Convergence(),
    section=Section(
        "Convergence of friction law and contact",
        "python -m comparison.run makes it, of scenes with phases",
        lambda report, figures: {"trend_panels": trend_panels},
        verdict=lambda results: word_trends(results.of("convergence")),
        verifies=True,
    ),
)
