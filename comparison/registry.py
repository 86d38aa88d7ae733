"""The analyses of a study, listed once: what is run, planned, reported, and can be selected by key."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from comparison.analysis.assumptions.validity import Assumptions
from comparison.analysis.claims.table import Claims
from comparison.analysis.convergence import Convergence
from comparison.analysis.effective import EffectiveValues
from comparison.analysis.errata import Errata
from comparison.analysis.protocol import Analysis
from comparison.analysis.scaling import Scaling
from comparison.analysis.trajectories import Motions
from comparison.execution.task import Task
from comparison.report.figures.pictures import Pictures
from comparison.study.study import Study

ANALYSES: tuple[Analysis[Any], ...] = (
    EffectiveValues(),
    Errata(),
    Scaling(),
    Convergence(),
    Claims(),
    Assumptions(),
    Motions(),
    Pictures(),
)


def chosen_analyses(with_analyses: bool = True) -> list[Analysis[Any]]:
    """Those of ANALYSES that a study runs; not `with_analyses`: the essential ones only."""
    return [analysis for analysis in ANALYSES if with_analyses or analysis.essential]


def first_tasks(study: Study, analyses: Sequence[Analysis[Any]]) -> list[Task]:
    """What can be computed without knowing the surfaces."""
    return [task for analysis in analyses if not analysis.needs_surfaces for task in analysis.tasks(study)]


def predicted_costs(study: Study, analyses: Sequence[Analysis[Any]]) -> dict[str, tuple[int, float]]:
    """Tasks and s on one core of each analysis, by stage."""
    seconds = {analysis.stage: analysis.predicted_seconds(study) for analysis in analyses}
    return {stage: (len(costs), sum(costs)) for stage, costs in seconds.items()}


def analysis_cost(study: Study, with_analyses: bool) -> float:
    """s on one core of all that is computed beside the surfaces."""
    return sum(seconds for _, seconds in predicted_costs(study, chosen_analyses(with_analyses)).values())
