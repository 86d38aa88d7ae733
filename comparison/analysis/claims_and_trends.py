"""What a study finds beside its surfaces: the paper's claims, the scaling test, and what the steps tend to."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from comparison.analysis.claims.table import ClaimTable, claims_tested
from comparison.analysis.convergence import convergence_trends
from comparison.analysis.scaling import scaling_trends
from comparison.analysis.tasks import paper_complete
from comparison.analysis.trends import Trend
from comparison.execution.executors import Pool
from comparison.study.selection import EVERYTHING, Selection
from comparison.study.study import Study


def claims_and_trends(study: Study, jobs: int, executor: Pool, selection: Selection = EVERYTHING) -> dict[str, Any]:
    """Fields of `Findings`: claims (None unless the study has every scene of the paper), scaling, convergence."""
    scaled, limited = selection.study(study, "scaling"), selection.study(study, "convergence")
    claims = claims_tested(jobs, executor) if paper_complete(selection.study(study, "claims")) else None
    scaling = scaling_trends(scaled, jobs, executor) if scaled.phased else None
    convergence = convergence_trends(limited, jobs, executor) if limited.phased else None
    return {"claims": claims, "scaling": scaling, "convergence": convergence}


def claims_summary(table: ClaimTable | None) -> dict[str, Any] | None:
    """The table of claims for summary.json: readings, verdicts in their order, the best, and what none reproduces."""
    if table is None:
        return None
    return {
        "grid": table.grid,
        "readings": [reading.name for reading in table.readings],
        "reproduced": [table.held(column) for column in range(len(table.readings))],
        "best": [reading.name for reading in table.best],
        "never": [f"{claim.figure}: {claim.says}" for claim in table.never],
        "claims": [
            {
                "figure": claim.figure,
                "says": claim.says,
                "rule": claim.rule,
                "weaker": claim.weaker,
                "verdicts": [{"finding": str(verdict.finding), "found": verdict.found} for verdict in row],
            }
            for claim, row in zip(table.claims, table.verdicts)
        ],
    }


def trends_summary(trends: Sequence[Trend] | None) -> list[dict[str, Any]] | None:
    """Trends for summary.json; numbers that are NaN are for the caller to replace."""
    if trends is None:
        return None
    return [
        {
            "scene": trend.scene,
            "body": trend.body,
            "what": trend.what,
            "parameter": list(trend.parameter),
            "medians": trend.medians,
            "exponent": trend.slope.exponent,
            "uncertainty": trend.slope.uncertainty,
            "points": trend.slope.points,
            "expected": trend.expected,
            "verdict": trend.verdict,
        }
        for trend in trends
    ]
