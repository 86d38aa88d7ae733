"""How differences and demands change with a value that runs."""

from __future__ import annotations

from typing import Any

from comparison.result_types import Number, Part, Text


class Trend(Part):
    """How a difference falls with what causes it."""

    scene: Text
    """name of the scene"""
    body: int
    """number of the body; 1 is the platform"""
    what: str
    """the two things that differ"""
    parameter: list[float]
    """values of the parameter, falling"""
    medians: list[Number]
    """median absolute relative difference over the phase pairs, for every value"""
    exponent: Number
    """exponent of the power law fitted to the differences above their errors; null without enough of them"""
    uncertainty: Number
    """of the exponent"""
    points: int
    """differences in the fit"""
    pairs: int
    """phase pairs that they are of"""
    expected: float | None
    """exponent that theory gives, or null"""
    verdict: Text
    """what the fit allows to say"""


class FamilyCurve(Part):
    """mu of one model and body over the value that runs; null where it has no value."""

    model: str
    """key of the model"""
    body: int
    """number of the body; 1 is the platform"""
    mean: list[Number]
    """mean over the phase pairs that have a value, or the value under the record, one for each scene"""
    lowest: list[Number]
    """smallest over the phase pairs"""
    highest: list[Number]
    """largest over the phase pairs"""
    error: list[Number]
    """mean of the estimated absolute errors"""


class FamilyStep(Part):
    """A bar of the waterfalls of one body over the value that runs; relative to mu of the first model."""

    model: str
    """key of the model that the step leads to, or total"""
    body: int
    """number of the body; 1 is the platform"""
    size: list[Number]
    """signed size, one for each scene"""
    error: list[Number]
    """error estimate of it"""
    real: list[bool]
    """whether the size exceeds five times its error estimate"""


class FamilyDemand(Part):
    """One demand of the motions of a model over the value that runs, with its band."""

    model: str
    """key of the model"""
    quantity: str
    """key in `demands` of a scene, with the unit stated there"""
    body: int
    """number of the body; 0 where the demand is of the isolator"""
    median: list[Number]
    """median over the motions that have the demand, one for each scene; null without any"""
    lowest: list[Number]
    """smallest of them"""
    highest: list[Number]
    """largest of them"""
    motions: list[int]
    """how many motions have the demand"""


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
