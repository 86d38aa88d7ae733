"""What was recorded about the models (`python -m comparison.tradeoff.record`): cost and reach by tolerance."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

FILE = Path(__file__).with_name("accuracy_record.json")
SHARE = 0.99  # of the points that must meet a tolerance, by the error estimate and in fact
TIGHTER = 9.9  # times, at least, is the reference solution tighter: 100 but where the model takes no such tolerance


@dataclass(frozen=True)
class AccuracyRecord:
    """
    One model. tolerances: recorded ones, the loosest first. costs: of a point beside one at the usual tolerance. met:
    whether a tolerance was met at SHARE of the points.
    """

    tolerances: tuple[float, ...]
    costs: tuple[float, ...]
    met: tuple[bool, ...]

    @property
    def tightest(self) -> float:
        """The tightest tolerance that was met."""
        return min(tolerance for tolerance, met in zip(self.tolerances, self.met) if met)

    def cost(self, tolerance: float) -> float:
        """Cost of a point beside one at the usual tolerance; between two recorded ones by interpolation."""
        place = -np.log(np.array(self.tolerances))
        return float(np.exp(np.interp(-np.log(tolerance), place, np.log(self.costs))))


@dataclass(frozen=True)
class RecordedModels:
    """
    machine: where it was recorded. accuracy: by the key of the model. seconds: processor time of a point at the usual
    tolerance, by the digest of the scene and the key of the model.
    """

    machine: str
    accuracy: Mapping[str, AccuracyRecord]
    seconds: Mapping[str, Mapping[str, float]]


def _met(row: Mapping[str, float]) -> bool:
    return min(row["met"], row["met_by_estimate"]) >= SHARE and TIGHTER * row["reference_tolerance"] <= row["tolerance"]


@cache
def recorded() -> RecordedModels:
    """The record that is part of the package."""
    content: dict[str, Any] = json.loads(FILE.read_text(encoding="utf-8"))
    accuracy = {
        key: AccuracyRecord(
            tuple(row["tolerance"] for row in model["tolerances"]),
            tuple(row["cost"] for row in model["tolerances"]),
            tuple(_met(row) for row in model["tolerances"]),
        )
        for key, model in content["models"].items()
    }
    return RecordedModels(content["machine"], accuracy, content["seconds"])
