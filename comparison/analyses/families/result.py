"""Families of scenes, as summary.json holds them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from comparison.analyses.families.analysis import (
    FamilyCurve,
    FamilyDemand,
    FamilyStep,
    family_curves,
    family_demands,
    family_demands_over_phases,
    family_steps,
)
from comparison.report.scene_result import SceneResult
from comparison.report.section import Findings
from comparison.result_types import Part, Text
from reference.problem import Family


class FamilyResult(Part):
    """Scenes of one file in which one value runs."""

    name: Text
    """name of the file"""
    key: str
    """key that runs"""
    values: list[Any]
    """its values"""
    scenes: list[Text]
    """names of its scenes, in the order of the values"""
    curves: list[FamilyCurve]
    """one per model and body"""
    steps: list[FamilyStep]
    """one per step of the waterfalls and body, then the total"""
    demands: list[FamilyDemand]
    """one per model, quantity and body of which a motion is stored, or of which all phases were computed"""
    demands_over_phases: bool
    """whether they are of all phases, not of the stored motions"""


def family_results(findings: Findings, scenes: Sequence[SceneResult]) -> list[FamilyResult] | None:
    """Of every family of the study; None without any."""
    families: Sequence[Family] = findings.found.get("families") or []
    return [_family(findings, family, scenes) for family in families] or None


def _family(findings: Findings, family: Family, scenes: Sequence[SceneResult]) -> FamilyResult:
    statistics = {scene.name: scene.of("demand_statistics") for scene in scenes}
    of_phases = any(statistics[scene.name] for scene in family.scenes)
    motions = findings.found.get("motions") or []
    demands = family_demands_over_phases(family, statistics) if of_phases else family_demands(family, motions)
    return FamilyResult(
        name=family.name,
        key=family.key,
        values=list(family.values),
        scenes=[scene.name for scene in family.scenes],
        curves=family_curves(findings.study, findings.surfaces, family),
        steps=family_steps(family, {scene.name: scene.waterfalls for scene in scenes}),
        demands=demands,
        demands_over_phases=of_phases,
    )
