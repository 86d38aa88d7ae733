"""What the phases make of mu and of the demands: distributions, statistics, largest values."""

from __future__ import annotations

from comparison.result_types import Number, Part, Phases


class Mean(Part):
    """A mean with its error."""

    value: Number
    """mean"""
    error: Number
    """estimated absolute error, sampling included; null where it is not known"""


class Fractile(Part):
    """The value that mu stays below with a probability."""

    probability: float
    """probability"""
    value: Number
    """fractile of mu"""
    error: Number
    """estimated absolute error, sampling included; null where it is not known"""


class Distribution(Part):
    """mu of one model and body over phases that are independent and uniform."""

    model: str
    """key of the model"""
    body: int
    """number of the body; 1 is the platform"""
    points: int
    """phase pairs that it was taken from"""
    unknown: float
    """share of them without an answer"""
    mean: Mean
    """mean over all phases"""
    fractiles: list[Fractile]
    """by rising probability"""
    curve: list[Number]
    """mu at 50 probabilities from 0.01 to 0.99"""


class PhaseExtreme(Part):
    """The largest or smallest value on the phases that were computed."""

    value: Number
    """largest or smallest value, in the unit of the demand; null without an answer"""
    error: Number
    """estimated absolute error; null where it is not known"""
    phases: Phases
    """(alpha1, alpha2), rad; null under a record"""


class DemandStatistics(Part):
    """One demand of one model over phases that are independent and uniform; under a record its one value."""

    model: str
    """key of the model"""
    quantity: str
    """key in `demands`, with the unit stated there"""
    body: int
    """number of the body; 0 where the demand is of the isolator"""
    points: int
    """phase pairs that it was taken from"""
    unknown: float
    """share of them without an answer"""
    mean: Mean
    """mean over all phases"""
    fractiles: list[Fractile]
    """by rising probability"""
    lowest: PhaseExtreme
    """smallest value"""
    highest: PhaseExtreme
    """largest value"""
    curve: list[Number]
    """the demand at 50 probabilities from 0.01 to 0.99"""


class RecordValue(Part):
    """mu of one model and body under a recorded motion."""

    model: str
    """key of the model"""
    body: int
    """number of the body; 1 is the platform"""
    mu: Number
    """value; null without an answer"""
    error: Number
    """estimated absolute error of it"""
    status: str
    """named outcome"""
