"""What a reader must know before trusting a number."""

from __future__ import annotations

from typing import Literal

from comparison.result_types import Part, Text


class OutcomeNote(Part):
    """One outcome of a model that is not ok."""

    outcome: str
    """name of the outcome"""
    count: int
    """phase pairs that ended so"""
    advice: Text
    """what it means and what to try"""


class Unanswered(Part):
    """A model without a usable value at some or all phase pairs of a scene."""

    scene: Text
    """name of the scene"""
    model: str
    """key of the model"""
    title: str
    """title of the model"""
    points: int
    """phase pairs without a value"""
    unusable: int
    """further phase pairs, with a value that is not known to half of itself"""
    asked: int
    """phase pairs that the model was asked for"""
    used: bool
    """whether comparisons use the values that it has"""
    outcomes: list[OutcomeNote]
    """its outcomes that are not ok"""
    why: Text
    """these outcomes in words"""
    sentence: Text
    """all that in words"""


class Alert(Part):
    """What a reader must know before trusting a number."""

    level: Literal["red", "amber"]
    """red: a model refused or a limit is broken; amber: a number is missing or to be read with care"""
    kind: Literal["refused", "limit", "lacking", "fault", "swing", "travel"]
    """model without any value, broken acceptance limit, phase pairs without a value, error message of a solver, wide
    swing of the platform"""
    scene: Text
    """name of the scene"""
    text: Text
    """what is the matter"""
    help: Text
    """what helps; empty where nothing is known to"""

    @property
    def line(self) -> str:
        """All that in one line."""
        return ". ".join(f"{part[0].upper()}{part[1:]}" if number else part for number, part in enumerate(self._parts))

    @property
    def _parts(self) -> list[str]:
        return [f"{self.scene}: {self.text}", *([self.help] if self.help else [])]
