"""
What was recorded about the models: cost and reach by tolerance.

The package has a record. `python -m comparison.tradeoff.record` makes one of the machine at hand in the user's cache,
and that one is read in place of the package's.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from reference.problem.user_cache import user_cache
from reference.problem.version import __version__

SHIPPED = Path(__file__).with_name("accuracy_record.json")
SHARE = 0.99  # of the points that must meet a tolerance, by the error estimate and in fact
HARDLY_MORE = 1.05  # times the cheapest cost: a setting that tightens the tolerance for so little is taken
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

    def setting(self, tolerance: float) -> float:
        """
        What to ask of the model so that a tolerance is met.

        Parameters
        ----------
        tolerance : float
            Relative error that 99 % of the points are to meet.

        Returns
        -------
        float
            The cheapest tolerance that was recorded to meet it, or a tighter one that costs hardly more.
        """
        able = [tolerance] + [asked for asked, met in zip(self.tolerances, self.met) if met and asked < tolerance]
        cheapest = min(self.cost(asked) for asked in able)
        return min(asked for asked in able if self.cost(asked) <= HARDLY_MORE * cheapest)


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


def machine_file() -> Path | None:
    """Where the record of this machine is, or would be; None if the user has no place for it."""
    folder = user_cache()
    return None if folder is None else folder / f"accuracy_record-{__version__}.json"


@cache
def recorded() -> RecordedModels:
    """The record of this machine, if there is one for the models of the package's, or else the package's."""
    shipped, file = load_record(SHIPPED), machine_file()
    try:
        here = shipped if file is None else load_record(file)
    except (OSError, ValueError, KeyError, TypeError, AttributeError):  # none, or not whole
        return shipped
    return here if here.accuracy.keys() == shipped.accuracy.keys() else shipped


def load_record(file: Path) -> RecordedModels:
    """A record from its file. Raises OSError, ValueError, KeyError, TypeError or AttributeError if that is none."""
    content: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    accuracy = {
        key: AccuracyRecord(
            tuple(row["tolerance"] for row in model["tolerances"]),
            tuple(row["cost"] for row in model["tolerances"]),
            tuple(_met(row) for row in model["tolerances"]),
        )
        for key, model in content["models"].items()
    }
    return RecordedModels(content["machine"], accuracy, content["seconds"])
