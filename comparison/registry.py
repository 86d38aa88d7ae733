"""The analyses of a study, listed once: what is run, planned, reported, and can be selected by key."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from comparison.analyses.assumptions.validity import Assumptions
from comparison.analyses.claims.table import Claims
from comparison.analyses.convergence.analysis import Convergence
from comparison.analyses.demands.analysis import DemandSurfaces
from comparison.analyses.effective_values.analysis import EffectiveValues
from comparison.analyses.errata.analysis import Errata
from comparison.analyses.measured.analysis import MeasuredPeaks
from comparison.analyses.motions.analysis import Motions
from comparison.analyses.scaling.analysis import Scaling
from comparison.analyses.worst_phases.analysis import WorstPhases
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task
from comparison.study.levels import Level, levels_of
from comparison.study.study import Study
from comparison.surfaces.completion import CompletedSurfaces
from comparison.surfaces.figures.pictures import Pictures

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
