"""The analyses of a study, listed once: what is run, planned, reported, and can be selected by key."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from comparison.analysis.assumptions.validity import Assumptions
from comparison.analysis.claims.table import Claims
from comparison.analysis.convergence import Convergence
from comparison.analysis.effective import EffectiveValues
from comparison.analysis.errata import Errata
from comparison.analysis.protocol import Analysis
from comparison.analysis.scaling import Scaling
from comparison.analysis.trajectories import Motions
from comparison.analysis.worst_phases import WorstPhases
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
    WorstPhases(),
    Pictures(),
)


def affordable(study: Study, with_analyses: bool = True) -> Study:
    """
    A study with all that was asked for, or with the essential analyses only.

    Parameters
    ----------
    study : Study
    with_analyses : bool
        Whether all of them fit the budget.

    Returns
    -------
    Study
    """
    expensive = [analysis.key for analysis in ANALYSES if not analysis.essential]
    return study if with_analyses else replace(study, selection=study.selection.without(expensive))


def chosen_analyses(study: Study) -> list[Analysis[Any]]:
    """
    Those of ANALYSES that are made of a scene of the study.

    Parameters
    ----------
    study : Study

    Returns
    -------
    list of Analysis
    """
    return [analysis for analysis in ANALYSES if study.selecting(analysis.key).scenes]


def first_tasks(study: Study, analyses: Sequence[Analysis[Any]]) -> list[Task]:
    """
    What can be computed without knowing the surfaces.

    Parameters
    ----------
    study : Study
    analyses : sequence of Analysis

    Returns
    -------
    list of Task
    """
    return [
        task
        for analysis in analyses
        if not analysis.needs_surfaces
        for task in analysis.tasks(study.selecting(analysis.key))
    ]


def predicted_costs(study: Study, analyses: Sequence[Analysis[Any]]) -> dict[str, tuple[int, float]]:
    """
    What each analysis costs.

    Parameters
    ----------
    study : Study
    analyses : sequence of Analysis

    Returns
    -------
    dict of str to tuple
        By stage: number of tasks, s on one core.
    """
    seconds = {analysis.stage: analysis.predicted_seconds(study.selecting(analysis.key)) for analysis in analyses}
    return {stage: (len(costs), sum(costs)) for stage, costs in seconds.items()}


def analysis_cost(study: Study, with_analyses: bool) -> float:
    """
    What is computed beside the surfaces costs.

    Parameters
    ----------
    study : Study
    with_analyses : bool
        Whether all of them, not only the essential ones.

    Returns
    -------
    float
        s on one core.
    """
    chosen = affordable(study, with_analyses)
    return sum(seconds for _, seconds in predicted_costs(chosen, chosen_analyses(chosen)).values())
