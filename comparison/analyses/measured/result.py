"""Peaks that an experiment measured, beside the models."""

from __future__ import annotations

from comparison.result_types import Number, Part, Phases, Text


class ComputedPeak(Part):
    """A measured peak by one model."""

    model: str
    """key of the model"""
    value: Number
    """in the unit of the quantity; null without an answer"""
    error: Number
    """estimated absolute error"""
    difference: Number
    """computed less measured value"""
    exceeds: bool | None
    """whether its size exceeds the uncertainty and the error together; null where it is not known"""
    status: str
    """how the motion ended, or why it lacks this value"""


class MeasuredPeak(Part):
    """A peak that an experiment measured, beside the models."""

    scene: Text
    """name of the scene"""
    quantity: str
    """mu, or a key in `demands` with the unit stated there"""
    body: int
    """number of the body, 1 is the platform; 0 where the quantity is of the isolator"""
    phases: Phases
    """(alpha1, alpha2), rad; null under a record"""
    value: float
    """measured value"""
    uncertainty: float
    """its absolute uncertainty, as the scene states it"""
    source: Text
    """where it is from, as the scene states it"""
    computed: list[ComputedPeak]
    """one per model that has the quantity"""
