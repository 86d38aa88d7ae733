"""What a reader must know before trusting a number."""

from __future__ import annotations

from typing import Literal

from comparison.result_types import Part, Text


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
