"""How a report was made, and the models that it compares."""

from __future__ import annotations

from typing import Any

from comparison.result_types import Part, Text


class WorkPart(Part):
    """One kind of work beside the surfaces."""

    tasks: int
    """number of tasks"""
    stored_before: int
    """of these, taken from an earlier run"""
    seconds: float
    """processor time of all of them when they were computed, s"""


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
    level: int
    """level of the study that the report holds"""
    levels: int
    """levels of the study: a report of an earlier one is replaced as the run goes on"""

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
