"""
Registry of the features of a study in the order of the pages: they are run, planned, reported and selected by key.

A feature is one folder, whose module `feature` has a `FEATURE`, and one line of `FEATURES`.
"""

from collections.abc import Mapping, Sequence
from functools import partial
from importlib import import_module
from typing import Any

from pydantic import Field, create_model

from comparison.report import surface_sections as core
from comparison.report.building import assemble_report
from comparison.report.feature import Feature
from comparison.report.results import Results
from comparison.report.scene_result import SceneResult
from comparison.runner.analysis import Analysis
from comparison.runner.task import Task
from comparison.study.costs import estimate_model_seconds
from comparison.study.levels import StudyLevel, make_levels
from comparison.study.selection import Selection
from comparison.study.study import Study


def _load_feature(folder: str) -> Feature:
    """Return the feature (analysis and report section) that is defined in a folder below comparison/."""
    feature: Feature = import_module(f"comparison.{folder}.feature").FEATURE
    return feature


FEATURES: tuple[Feature, ...] = (  # all features: each an analysis, a report section or both, in the report's order
    core.AMPLIFICATION_SECTION,
    _load_feature("analyses.records"),
    _load_feature("analyses.motions"),
    _load_feature("analyses.families"),
    _load_feature("analyses.worst_phases"),
    _load_feature("analyses.demands"),
    core.DIFFERENCES,
    core.BUDGET,
    _load_feature("analyses.conditioning"),
    _load_feature("evidence.scaling"),
    _load_feature("evidence.convergence"),
    core.OUTCOMES,
    core.MODELS,
    _load_feature("evidence.claims"),
    _load_feature("analyses.assumptions"),
    _load_feature("analyses.measured"),
    _load_feature("evidence.validation"),
    _load_feature("evidence.benchmarks"),
    _load_feature("evidence.extremes"),
    _load_feature("evidence.tradeoff"),
    _load_feature("evidence.effective"),
    core.VERIFICATION,
    core.PROVENANCE,
    core.COMPLETION,
    core.PICTURES,
)
# Analyses of the features; a feature that only shows a report section has none
ANALYSES: tuple[Analysis[Any], ...] = tuple(feature.analysis for feature in FEATURES if feature.analysis)
# Features that --only, --skip, --also may name: name, rules (only on request, only for the paper's scenes, and others)
SELECTABLE = tuple(feature.selectable_entry for feature in FEATURES if feature.selectable)
EVERYTHING = Selection(SELECTABLE)  # selection without options: for every scene all analyses but those on request


def _make_results_type(features: Sequence[Feature]) -> type[Results]:
    """Return the class of a study's results, with the fields that the features add."""
    of_scenes: dict[str, Any] = {
        field.name: (field.kind, Field(description=field.meaning))
        for feature in features
        for field in feature.scene_fields
    }
    scene = create_model("SceneResult", __base__=SceneResult, __doc__=SceneResult.__doc__, **of_scenes)
    fields: dict[str, Any] = {
        field.name: (field.kind | None, Field(description=field.meaning))
        for feature in features
        for field in feature.fields
    }
    fields["scenes"] = list[scene], Field(description="in the order of the command")  # type: ignore[valid-type]
    results: type[Results] = create_model("Results", __base__=Results, __doc__=Results.__doc__, **fields)
    results.features = tuple(features)
    return results


StudyResults = _make_results_type(FEATURES)  # class of a study's results with the fields of all features
make_report = partial(assemble_report, features=FEATURES, kind=StudyResults)  # function that makes a complete report


def select_analyses(study: Study) -> list[Analysis[Any]]:
    """Return the analyses that are selected for at least one scene of the study."""
    return [analysis for analysis in ANALYSES if study.restrict_to(analysis.key).scenes]


def estimate_stage_seconds(study: Study) -> dict[str, float]:
    """Return the rough processor time of a study's analyses, s, by the stage name under which progress is shown."""
    return {each.stage: each.estimate_seconds(study.restrict_to(each.key)) for each in select_analyses(study)}


def estimate_study_seconds(study: Study, stages: Mapping[str, float]) -> float:
    """Return the rough processor time of a study, s: its models, and its analyses as listed in `stages`."""
    models = sum(estimate_model_seconds(study, model) for model in study.hierarchy)
    return models + sum(stages.values())


def list_first_tasks(study: Study, analyses: Sequence[Analysis[Any]]) -> list[Task]:
    """Return the tasks of the analyses that need no surfaces of the amplification and so can run first."""
    return [
        task
        for analysis in analyses
        if not analysis.needs_surfaces
        for task in analysis.tasks(study.restrict_to(analysis.key))
    ]


def make_study_levels(study: Study) -> list[StudyLevel]:
    """Return the steps in which a study is computed, from a coarse grid of phases to the full one."""
    return make_levels(study, {analysis.key: analysis.level for analysis in select_analyses(study)})
