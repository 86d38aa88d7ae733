"""Measured trade-off as data: errors and compute time of every setting, the Pareto fronts, and the files."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import xarray as xr

from comparison.json_file import StoredFile
from comparison.result_types import Array, require, require_size, result
from reference.problem.scene import MAX_BODIES

FILE = "tradeoff.json"
SCHEMA: Literal["phase-resonance/tradeoff"] = "phase-resonance/tradeoff"
MEANINGS = {  # meaning of each variable of the netCDF file
    "mu": "amplification factor (5.1)",
    "reference_solution": "the same by the reference solution of the question",
    "error_estimate": "estimated absolute error of mu",
}


@result
class StatedSetting:
    """Setting of a method (its varied parameter at one value), before its error and time are measured."""

    question: Annotated[str, "key of the question that it answers"]
    method: Annotated[str, "the curve that it belongs to"]
    parameter: Annotated[str, "what varies along the curve"]
    unit: Annotated[str, "unit of the value; empty for a pure number"]
    value: Annotated[float, "value of the parameter"]
    controlled: Annotated[bool, "whether an error estimate comes with it"]
    model_error: Annotated[bool, "whether its error is that of another model, not of numerics"]

    @property
    def setting(self) -> str:
        """Return parameter, value and unit."""
        return f"{self.parameter} {self.value:.3g} {self.unit}".strip()


@result
class MeasuredSetting(StatedSetting):
    """Setting of a method (its varied parameter at one value) with its measured errors and processor time."""

    points: Annotated[int, "phase pairs at which the reference solution has a value"]
    answered: Annotated[int, "of these, phase pairs with a value"]
    seconds: Annotated[float, "processor time per point, s"]
    median: Annotated[Sequence[float | None], "median relative error of each mu; null without a value"]
    most: Annotated[Sequence[float | None], "relative error of each mu that 95 % of the points meet; null without"]
    error_estimate: Annotated[Sequence[float | None], "estimate of it that 95 % of the points meet; null without"]
    step: Annotated[float | None, "mean step, s; null where the method does not tell it"] = None
    pareto_front: Annotated[Sequence[bool], "by mu: whether no other method is as accurate (95 %) in less time"] = ()
    error_message: Annotated[str, "what went wrong, or empty"] = ""

    @property
    def complete(self) -> bool:
        """Return whether the setting gives a value at every phase pair of the reference solution."""
        return 0 < self.answered == self.points


@result
class SolvedQuestion:
    """One question (equations to solve) with its reference solution and the checks of this solution."""

    key: Annotated[str, "key of the question"]
    title: Annotated[str, "equations and law of friction"]
    points: Annotated[int, "phase pairs of the sample"]
    reference_solution: Annotated[str, "what the errors are against"]
    error: Annotated[float | None, "largest relative error estimate of the reference solution; null without an answer"]
    checks: Annotated[Sequence[str], "how the reference solution was checked"]


@result
class SceneTrade:
    """Relative error against processor time of every setting for one scene, as measured."""

    scene: Annotated[str, "name of the scene"]
    title: Annotated[str, "title of the scene"]
    digest: Annotated[str, "hash of the scene"]
    bodies: Annotated[int, "number of bodies"]
    questions: Annotated[Sequence[SolvedQuestion], "one per panel of the diagram"]
    entries: Annotated[Sequence[MeasuredSetting], "one per setting"]
    run: Annotated[Mapping[str, Any], "command, times, provenance"]

    def __post_init__(self) -> None:
        """Refuse entries that do not fit the bodies or the questions."""
        require(1 <= self.bodies <= MAX_BODIES, f"bodies must be from 1 to {MAX_BODIES}, not {self.bodies}")
        keys = {question.key for question in self.questions}
        for each in self.entries:
            for what, values in (("median", each.median), ("most", each.most), ("error_estimate", each.error_estimate)):
                require_size(what, values, self.bodies)
            require(each.question in keys, f"question {each.question[:40]!r} of an entry is none of the questions")

    def entries_of(self, question: str) -> list[MeasuredSetting]:
        """Return the entries of one question in the order in which they were listed."""
        return [entry for entry in self.entries if entry.question == question]

    def methods(self, question: str) -> dict[str, list[MeasuredSetting]]:
        """Return the entries of one question by method; those of a method run from cheap to expensive."""
        curves: dict[str, list[MeasuredSetting]] = {}
        for entry in self.entries_of(question):
            curves.setdefault(entry.method, []).append(entry)
        return curves


def find_error_quantile(errors: Array, share: float) -> float | None:
    """Return the smallest of the errors that a share of the points does not exceed; None if no error is known."""
    known = errors[np.isfinite(errors)]
    return float(np.quantile(known, share, method="higher")) if len(known) else None


def is_pareto_optimal(mine: tuple[float, float], others: Sequence[tuple[float, float]]) -> bool:
    """Return whether no other setting is at least as good in cost and error and better in one of them."""
    beaten = any(other != mine and other[0] <= mine[0] and other[1] <= mine[1] for other in others)
    return math.isfinite(sum(mine)) and not beaten


def mark_pareto_fronts(entries: Sequence[MeasuredSetting], bodies: int) -> list[MeasuredSetting]:
    """Return the entries with `pareto_front` set, among those that answer their question at every point."""
    complete = [entry for entry in entries if entry.complete and not entry.model_error]

    def time_and_error(entry: MeasuredSetting, body: int) -> tuple[float, float]:
        """Return cost, s, and error of a setting for a body; the error is infinite where it is not known."""
        error = entry.most[body]
        return entry.seconds, math.inf if error is None else error

    def is_on_front(entry: MeasuredSetting, body: int) -> bool:
        """Return whether no other setting for the same question is better in cost and error, `is_pareto_optimal`."""
        rivals = [time_and_error(other, body) for other in complete if other.question == entry.question]
        return entry in complete and is_pareto_optimal(time_and_error(entry, body), rivals)

    return [replace(entry, pareto_front=tuple(is_on_front(entry, body) for body in range(bodies))) for entry in entries]


@result
class TradeFile:
    """Content of tradeoff.json: error against compute time of every setting, for each scene."""

    schema: Annotated[Literal["phase-resonance/tradeoff"], "what the file is"]
    trades: Annotated[list[SceneTrade], "one per scene"]


STORED = StoredFile(FILE, TradeFile, "a measured trade", "phase-resonance tradeoff")


def load_trades(folder: Path) -> list[SceneTrade] | None:
    """Return the trade-offs that a command left in a folder, as `StoredFile.load` does."""
    content = STORED.load(folder)
    return None if content is None else content.trades


@dataclass(frozen=True)
class MeasuredTrade:
    """Measured trade-off of one scene with every value behind it by setting, point and body."""

    trade: SceneTrade
    values: xr.Dataset


def label_values(
    entries: Sequence[MeasuredSetting], values: Mapping[str, Sequence[Array]], phases: Array
) -> xr.Dataset:
    """Return every value (P, N) by setting, point and body; a question with fewer points leaves the rest NaN."""
    axes = ("setting", "point", "body")
    variables: dict[str, Any] = {}
    for name, rows in values.items():
        filled = np.full((len(rows), len(phases), rows[0].shape[1]), np.nan)
        for row, value in zip(filled, rows):
            row[: len(value)] = value
        variables[name] = axes, filled, {"long_name": MEANINGS[name], "units": "1"}
    variables["seconds"] = "setting", [entry.seconds for entry in entries], {"units": "s", "long_name": "per point"}
    for name in ("value", "question", "method", "parameter", "unit"):
        variables[name] = "setting", [getattr(entry, name) for entry in entries]
    alpha1, alpha2 = (("point", phases[:, axis], {"units": "rad"}) for axis in (0, 1))
    return xr.Dataset(variables, {"body": np.arange(1, filled.shape[2] + 1), "alpha1": alpha1, "alpha2": alpha2})
