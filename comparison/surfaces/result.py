"""The difference of two models: its statistics, its causes, and where it is largest."""

from __future__ import annotations

from comparison.result_types import Number, Part, Text


class Completion(Part):
    """
    One body's surface of a model that is computed on fewer phases than the study has, completed through a finer model.

    It is the finer model plus the interpolated difference of the two. With the confidence stated at most a share of the
    phase pairs that were not computed is off by more than the error. The completed values are the variable `completed`
    of surfaces.nc.
    """

    scene: Text
    """name of the scene"""
    model: str
    """key of the model that is completed"""
    through: str
    """key of the finer model; empty without one"""
    body: int
    """number of the body; 1 is the platform"""
    computed: int
    """phase pairs where both models have a value"""
    held_out: int
    """phase pairs with a value that were chosen at random, computed and not used; 0 where nothing was interpolated"""
    error: Number
    """largest error at the held-out phase pairs, relative to the model's own mu; null where nothing was interpolated"""
    model_error: Number
    """largest error estimate of the model itself at these, relative"""
    share: float
    """at most so many of the phase pairs that were not computed are off by more than the error"""
    confidence: float
    """of this statement"""
    asked: float
    """largest error with which the surface may be drawn: the tolerance asked of the model"""
    difference: Number
    """95 % of the absolute differences of the completed surface from the first model are below this, relative to it"""
    accepted: bool
    """whether the surface may be drawn as completed: the error is at most what was asked"""
    difference_accepted: bool
    """whether its difference from the first model may be drawn as completed: the error is at most a fifth of it"""
    reason: Text
    """why the surface may not be drawn; empty where it may"""
