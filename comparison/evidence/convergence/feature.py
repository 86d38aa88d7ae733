"""Convergence of friction law and contact: in the report."""

from comparison.evidence.convergence.analysis import Convergence
from comparison.evidence.trend_panels import trend_panels
from comparison.evidence.trends import Trend, word_trends
from comparison.report.feature import Feature, ResultField
from comparison.report.section import Section

FOUND = ResultField(
    Convergence.key,
    list[Trend],
    "what the steps of friction law and contact tend to; null if not computed",
)
FEATURE = Feature(
    Convergence.key,
    (FOUND,),
    analysis=Convergence(),
    section=Section(
        "Convergence of friction law and contact",
        "phase-resonance run makes it, of scenes with phases",
        lambda report: {"trend_panels": trend_panels},
        verdict=lambda results: word_trends(FOUND.of(results)),
        verifies=True,
    ),
)
