"""The analyses of a study, listed once: what is run, planned, reported, and can be selected by key."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from comparison.analysis.assumptions.validity import Assumptions
from comparison.analysis.claims.table import Claims
from comparison.analysis.completion import CompletedSurfaces
from comparison.analysis.convergence import Convergence
from comparison.analysis.demand_surfaces import DemandSurfaces
from comparison.analysis.effective import EffectiveValues
from comparison.analysis.errata import Errata
from comparison.analysis.measured import MeasuredPeaks
from comparison.analysis.protocol import Analysis
from comparison.analysis.scaling import Scaling
from comparison.analysis.trajectories import Motions
from comparison.analysis.worst_phases import WorstPhases
from comparison.execution.task import Task
from comparison.report.figures.pictures import Pictures
from comparison.study.levels import Level, levels_of
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
    DemandSurfaces(),
    MeasuredPeaks(),
    CompletedSurfaces(),
    Pictures(),
)


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


def levels(study: Study) -> list[Level]:
    """
    The levels of a study, from coarse to fine.

    Parameters
    ----------
    study : Study

    Returns
    -------
    list of Level
    """
    return levels_of(study, {analysis.key: analysis.level for analysis in chosen_analyses(study)})
