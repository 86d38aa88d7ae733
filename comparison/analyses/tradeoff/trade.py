"""What was measured, as data: errors and compute time of every setting, the fronts, and the files they are kept in."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from comparison.json_file import StoredFile
from comparison.result_types import result

Array = NDArray[np.float64]

FILE = "tradeoff.json"
SCHEMA: Literal["phase-resonance/tradeoff"] = "phase-resonance/tradeoff"


@result
class Entry:
    """One setting of a method, measured."""

    question: str
    """key of the question that it answers"""
    method: str
    """the curve that it belongs to"""
    parameter: str
    """what varies along the curve"""
    unit: str
    """unit of the value; empty for a pure number"""
    value: float
    """value of the parameter"""
    controlled: bool
    """whether an error estimate comes with it"""
    model_error: bool
    """whether its error is that of another model, not of numerics"""
    points: int
    """phase pairs asked for"""
    answered: int
    """phase pairs with a value"""
    seconds: float
    """processor time per point, s"""
    median: Sequence[float | None]
    """median relative error of each mu against the reference solution; null without a value"""
    most: Sequence[float | None]
    """relative error of each mu that 95 % of the points meet; null without a value"""
    error_estimate: Sequence[float | None]
    """relative error estimate of each mu that 95 % of the points meet; null without estimates"""
    step: float | None = None
    """mean step, s; null where the method does not tell it"""
    pareto_front: Sequence[bool] = ()
    """for each mu, whether no other method is as accurate (95 %) in less time"""
    error_message: str = ""
    """what went wrong, or empty"""


@result
class Answered:
    """One question with its reference solution."""

    key: str
    """key of the question"""
    title: str
    """equations and law of friction"""
    points: int
    """phase pairs of the sample"""
    reference_solution: str
    """what the errors are against"""
    error: float
    """largest relative error estimate of the reference solution"""
    checks: Sequence[str]
    """how the reference solution was checked"""


@result
class Trade:
    """The measured trade of one scene."""

    scene: str
    """name of the scene"""
    title: str
    """title of the scene"""
    digest: str
    """hash of the scene"""
    bodies: int
    """number of bodies"""
    questions: Sequence[Answered]
    """one per panel of the diagram"""
    entries: Sequence[Entry]
    """one per setting"""
    run: Mapping[str, Any]
    """command, times, provenance"""

    def of(self, question: str) -> list[Entry]:
        """The entries of one question, in the order in which they were listed."""
        return [entry for entry in self.entries if entry.question == question]

    def methods(self, question: str) -> dict[str, list[Entry]]:
        """The curves of one question, from the cheapest value to the dearest."""
        curves: dict[str, list[Entry]] = {}
        for entry in self.of(question):
            curves.setdefault(entry.method, []).append(entry)
        return curves


def quantile(errors: Array, share: float) -> float | None:
    """
    The error that a share of the points does not exceed: one that occurred; None if no error is known.

    >>> quantile(np.array([1.0, 2.0, 3.0, np.nan]), 0.5)
    2.0
    """
    known = errors[np.isfinite(errors)]
    return float(np.quantile(known, share, method="higher")) if len(known) else None


def on_pareto_front(cost: Sequence[float], error: Sequence[float]) -> list[bool]:
    """
    Which pairs are not beaten: no other is at least as good in both and better in one.

    >>> on_pareto_front([1.0, 2.0, 3.0], [1e-2, 1e-3, 1e-2])
    [True, True, False]
    """
    pairs = list(zip(cost, error))
    return [
        math.isfinite(mine[0] + mine[1])
        and not any(all(a <= b for a, b in zip(other, mine)) and other != mine for other in pairs)
        for mine in pairs
    ]


def with_pareto_fronts(entries: Sequence[Entry], bodies: int) -> list[Entry]:
    """The entries with `pareto_front` filled in, compared with those that answer their question at every point."""
    marks: dict[int, list[bool]] = {place: [False] * bodies for place in range(len(entries))}
    for question in {entry.question for entry in entries}:
        complete = [
            place
            for place, entry in enumerate(entries)
            if entry.question == question and not entry.model_error and entry.answered == entry.points
        ]
        for body in range(bodies):
            errors = [entries[place].most[body] for place in complete]
            known = [math.inf if error is None else error for error in errors]
            for place, mark in zip(complete, on_pareto_front([entries[place].seconds for place in complete], known)):
                marks[place][body] = mark
    return [Entry(**{**vars(entry), "pareto_front": tuple(marks[place])}) for place, entry in enumerate(entries)]


@result
class TradeFile:
    """Content of the file."""

    schema: Literal["phase-resonance/tradeoff"]
    """what the file is"""
    trades: list[Trade]
    """one per scene"""


STORED = StoredFile(FILE, TradeFile, "a measured trade", "python -m comparison.tradeoff")


def load(folder: Path) -> list[Trade] | None:
    """The trades that a command left in a folder, as `StoredFile.load`."""
    content = STORED.load(folder)
    return None if content is None else content.trades


def labeled(
    entries: Sequence[Entry], mu: Sequence[Array], reference_solution: Sequence[Array], error_estimate: Sequence[Array],
    phases: Array,
) -> xr.Dataset:  # fmt: skip
    """Every value (P, N) by setting, point and body; a question with fewer points leaves the rest NaN."""
    count, bodies = len(phases), mu[0].shape[1]

    def padded(values: Sequence[Array]) -> Array:
        filled = np.full((len(values), count, bodies), np.nan)
        for row, value in zip(filled, values):
            row[: len(value)] = value
        return filled

    axes = ("setting", "point", "body")
    return xr.Dataset(
        {
            **{
                name: (axes, padded(values), {"long_name": meaning, "units": "1"})
                for name, values, meaning in (
                    ("mu", mu, "amplification factor (5.1)"),
                    ("reference_solution", reference_solution, "the same by the reference solution of the question"),
                    ("error_estimate", error_estimate, "estimated absolute error of mu"),
                )
            },
            "seconds": ("setting", [entry.seconds for entry in entries], {"units": "s", "long_name": "per point"}),
            "value": ("setting", [entry.value for entry in entries]),
            **{
                name: ("setting", [getattr(entry, name) for entry in entries])
                for name in ("question", "method", "parameter", "unit")
            },
        },
        {
            "body": np.arange(1, bodies + 1),
            "alpha1": ("point", phases[:, 0], {"units": "rad"}),
            "alpha2": ("point", phases[:, 1], {"units": "rad"}),
        },
    )  # fmt: skip
