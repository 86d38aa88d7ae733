"""How a report was made, and the models that it compares."""

from __future__ import annotations

from typing import Any

from comparison.report.results.values import Part, Text


class WorkPart(Part):
    """One kind of work beside the surfaces."""

    tasks: int
    """number of tasks"""
    stored_before: int
    """of these, taken from an earlier run"""
    seconds: float
    """processor time of all of them when they were computed, s"""


class TargetOfModel(Part):
    """What one model met of a target."""

    key: str
    """key of the model"""
    title: str
    """title of the model"""
    tolerance: float
    """relative error that was to be met"""
    asked: float
    """tolerance that the model was given for it"""
    phases_per_axis: int
    """of its grid; 1 in a study without phases"""
    points: int
    """phase pairs of all its surfaces"""
    met: float
    """fraction of them whose error estimates meet the tolerance"""
    error99: float | None
    """relative error estimate that 99 % do not exceed; null if more than 1 % have no value"""


class NextStep(Part):
    """What more time would buy."""

    what: Text
    """a finer grid of a model, or an analysis"""
    seconds: float
    """processor time that it still takes, s"""


class Targets(Part):
    """What --tolerance or --budget chose, and what came of it."""

    tolerance: float | None
    """value of --tolerance"""
    budget: float | None
    """value of --budget, s"""
    predicted_seconds: float
    """compute time expected for the surfaces, s"""
    seconds: float
    """compute time they took, s"""
    left_out: list[Text]
    """models left out, and why"""
    next_steps: list[NextStep]
    """what the budget did not buy, in the order in which it would be computed"""
    models: list[TargetOfModel]
    """what every model met"""


class Run(Part):
    """How the report was made."""

    command: Text
    """the command line"""
    began: str
    """date and time, UTC"""
    wall_seconds: float
    """wall time from the start of the command until the report was written, s"""
    processor_seconds: float
    """processor time of the command and its worker processes until then, s; workers of a cluster are not counted"""
    tiles: int
    """number of batches"""
    tiles_stored_before: int
    """of these, taken from an earlier run"""
    parts: dict[str, WorkPart]
    """work beside the surfaces, by its name"""
    jobs: int
    """worker processes"""
    provenance: dict[str, Text]
    """versions, machine, commit"""
    choice: Targets | None
    """what --tolerance or --budget chose; null without either"""

    @property
    def took(self) -> str:
        """The times of the run in words."""
        workers = f"{self.jobs} worker{'' if self.jobs == 1 else 's'}"
        return (
            f"{self.wall_seconds:.1f} s of wall time with {workers}, {self.processor_seconds:.1f} s of processor time"
        )


class ModelDescription(Part):
    """One model of the hierarchy."""

    key: str
    """its name everywhere in this file"""
    title: str
    """its name for readers"""
    adds: str
    """what it adds to the model before it"""
    effect: str
    """the same in two or three words, as the cause of a difference"""
    settings: dict[str, Any]
    """keyword arguments of its functions"""
