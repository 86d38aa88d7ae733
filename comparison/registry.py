"""The features of a study, in the order of the page: what is run, planned, reported, and selected by key."""

from collections.abc import Sequence
from functools import partial
from typing import Any

from pydantic import Field, create_model

from comparison.analyses.assumptions import feature as assumptions
from comparison.analyses.conditioning import feature as conditioning
from comparison.analyses.demands import feature as demands
from comparison.analyses.ensemble import feature as ensemble
from comparison.analyses.families import feature as families
from comparison.analyses.measured import feature as measured
from comparison.analyses.motions import feature as motions
from comparison.analyses.worst_phases import feature as worst_phases
from comparison.evidence.benchmarks import feature as benchmarks
from comparison.evidence.claims import feature as claims
from comparison.evidence.convergence import feature as convergence
from comparison.evidence.effective import feature as effective_values
from comparison.evidence.extremes import feature as extremes
from comparison.evidence.scaling import feature as scaling
from comparison.evidence.tradeoff import feature as tradeoff
from comparison.evidence.validation import feature as validation
from comparison.report.building import build_report
from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.report.section import Feature
from comparison.report.surface_sections import (
    BUDGET,
    DIFFERENCES,
    MODELS,
    OUTCOMES,
    PROVENANCE,
    SURFACES,
    VERIFICATION,
)
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task
from comparison.study.levels import StudyLevel, levels_of
from comparison.study.study import Study
from comparison.surfaces.completion import CompletedSurfaces
from comparison.surfaces.figures.pictures import Pictures

FEATURES: tuple[Feature, ...] = (
    SURFACES,
    motions.FEATURE,
    families.FEATURE,
    worst_phases.FEATURE,
    demands.FEATURE,
    ensemble.FEATURE,
    DIFFERENCES,
    BUDGET,
    conditioning.FEATURE,
    scaling.FEATURE,
    convergence.FEATURE,
    OUTCOMES,
    MODELS,
    claims.FEATURE,
    assumptions.FEATURE,
    measured.FEATURE,
    validation.FEATURE,
    benchmarks.FEATURE,
    extremes.FEATURE,
    tradeoff.FEATURE,
    tradeoff.GROWTH,
    effective_values.FEATURE,
    VERIFICATION,
    PROVENANCE,
    Feature("completion", analysis=CompletedSurfaces()),
    Feature("pictures", analysis=Pictures()),
)
ANALYSES: tuple[Analysis[Any], ...] = tuple(feature.analysis for feature in FEATURES if feature.analysis)
EARLIER = tuple(feature for feature in FEATURES if feature.load)  # what other commands leave beside a report

_FIELDS: dict[str, Any] = {
    feature.key: (feature.result | None, Field(description=feature.meaning))
    for feature in FEATURES
    if feature.result is not None
}
_OF_SCENES: dict[str, Any] = {
    name: (each.kind, Field(description=each.meaning))
    for feature in FEATURES
    for name, each in feature.scene_fields.items()
}
_Scene = create_model("SceneResult", __base__=SceneResult, __doc__=SceneResult.__doc__, **_OF_SCENES)
_FIELDS["scenes"] = list[_Scene], Field(description="in the order of the command")  # type: ignore[valid-type]
StudyResults: type[Results] = create_model("Results", __base__=Results, __doc__=Results.__doc__, **_FIELDS)


report_of = partial(build_report, features=FEATURES, kind=StudyResults)


def chosen_analyses(study: Study) -> list[Analysis[Any]]:
    """Those of ANALYSES that are made of a scene of the study."""
    return [analysis for analysis in ANALYSES if study.selecting(analysis.key).scenes]


def first_tasks(study: Study, analyses: Sequence[Analysis[Any]]) -> list[Task]:
    """What can be computed without knowing the surfaces."""
    return [
        task
        for analysis in analyses
        if not analysis.needs_surfaces
        for task in analysis.tasks(study.selecting(analysis.key))
    ]


def levels(study: Study) -> list[StudyLevel]:
    """The levels of a study, from coarse to fine."""
    return levels_of(study, {analysis.key: analysis.level for analysis in chosen_analyses(study)})
