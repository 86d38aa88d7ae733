"""Report features made of trends: how a difference falls with a parameter (convergence and scaling)."""

import math
from collections.abc import Mapping, Sequence
from itertools import groupby
from typing import Any

from comparison.evidence.trends import Trend, word_trends
from comparison.report.feature import Feature, ResultField
from comparison.report.panels import MAX_CURVES, Panel, make_panel, replace_nan
from comparison.report.section import Report, Section
from comparison.runner.mapped_analysis import MappedAnalysis


def make_trend_feature(
    analysis: MappedAnalysis[list[Trend]], title: str, scenes: str, meaning: str, column: str, parameter: str = "",
    **texts: Any,
) -> Feature:  # fmt: skip
    """
    Return the result field and report section of an analysis that fits power laws to differences of amplification.

    title: title of the section. scenes: the scenes for which there is a trend, in words. meaning: description of the
    result field. column: title of the table column with the median differences. parameter: axis title of the plots if
    all trends have the same parameter. texts: further variables of the section's template.
    """
    found = ResultField(name=analysis.key, kind=list[Trend], meaning=f"{meaning}; null if not computed")

    def make_context(report: Report) -> Mapping[str, Any]:
        """Return the variables of the section's template."""
        trends = found.read_from(report.results)
        panels = make_trend_panels(trends, parameter)
        return {"key": analysis.key, "trends": trends, "panels": panels, "column": column, **texts}

    section = Section(
        title,
        absent=f"phase-resonance run makes it, of {scenes}",
        context=make_context,
        verdict=lambda results: word_trends(found.read_from(results)),
        verifies=True,
    )
    return Feature(analysis.key, fields=(found,), analysis=analysis, section=section)


def make_trend_panels(trends: Sequence[Trend], parameter: str) -> list[Panel]:
    """
    Return log-log plots of median differences against the parameter, with the fitted slopes in the legend.

    Trends of one scene over the same parameter values share a plot.
    """
    panels = []
    ordered = sorted(trends, key=lambda trend: (trend.scene, trend.parameter[-1]))
    for (scene, values), group in groupby(ordered, key=lambda trend: (trend.scene, tuple(trend.parameter))):
        rows = list(group)
        series: list[dict[str, Any]] = []
        for number, trend in enumerate(rows[:MAX_CURVES]):
            slope = f"{trend.exponent:.2f} ± {trend.uncertainty:.2f}" if math.isfinite(trend.exponent) else "none"
            points = {"x": list(values), "y": replace_nan(trend.medians), "color": number, "marks": True}
            series.append({"name": f"μ_{trend.body}, {trend.what}: slope {slope}", **points})
        axis = parameter or ("penetration, ρ" if "contact" in rows[0].what else "v_reg, m/s")
        label = f"{scene}: median relative difference over {axis}; " + "; ".join(line["name"] for line in series)
        axes = {"title": axis, "log": True}, {"title": "median relative difference", "log": True}
        cut = f", {MAX_CURVES} of {len(rows)} differences: the table has all" if len(rows) > MAX_CURVES else ""
        panels.append(make_panel(f"{scene}{cut}", label, *axes, series))
    return panels
