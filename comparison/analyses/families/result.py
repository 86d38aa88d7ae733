"""Families of scenes, as summary.json holds them."""

from __future__ import annotations

from typing import Any

from comparison.analyses.families.analysis import FamilyCurve, FamilyDemand, FamilyStep
from comparison.result_types import Part, Text


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
