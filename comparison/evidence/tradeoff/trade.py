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

FILE = "tradeoff.json"  # name of the file with the measured error and compute time of every method
SCHEMA: Literal["phase-resonance/tradeoff"] = "phase-resonance/tradeoff"  # states in the file what it is
MEANINGS = {  # descriptions of the variables in the netCDF file of all measured values
    "mu": "amplification factor (5.1)",
    "reference_solution": "the same by the reference solution of the question",
    "error_estimate": "estimated absolute error of mu",
}


@result
class StatedSetting:
    """A method with one value of its varied parameter, before its error and time are measured."""

    question: Annotated[str, "key of the question that it answers"]
    method: Annotated[str, "the curve that it belongs to"]
    parameter: Annotated[str, "what varies along the curve"]
    unit: Annotated[str, "unit of the value; empty for a pure number"]
    value: Annotated[float, "value of the parameter"]
    controlled: Annotated[bool, "whether an error estimate comes with it"]
    model_error: Annotated[bool, "whether its error is that of another model, not of numerics"]

    @property
    def setting(self) -> str:
        """Return the varied parameter's name, value and unit as text."""
        return f"{self.parameter} {self.value:.3g} {self.unit}".strip()


@result
class MeasuredSetting(StatedSetting):
    """A method with one value of its varied parameter, and the errors and processor time measured with it."""

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
    """Measured relative error and processor time of every setting (method and parameter value) for one scene."""

    scene: Annotated[str, "name of the scene"]
    title: Annotated[str, "title of the scene"]
    digest: Annotated[str, "hash of the scene"]
    bodies: Annotated[int, "number of bodies"]
    questions: Annotated[Sequence[SolvedQuestion], "one per panel of the diagram"]
    entries: Annotated[Sequence[MeasuredSetting], "one per setting"]
    run: Annotated[Mapping[str, Any], "command, times, provenance"]

    def __post_init__(self) -> None:
        """Raise an error unless each entry has as many errors as there are bodies, and its question is listed."""
        require(1 <= self.bodies <= MAX_BODIES, f"bodies must be from 1 to {MAX_BODIES}, not {self.bodies}")
        keys = {question.key for question in self.questions}
        for each in self.entries:
            for what, values in (("median", each.median), ("most", each.most), ("error_estimate", each.error_estimate)):
                require_size(what, values, self.bodies)
            require(each.question in keys, f"question {each.question[:40]!r} of an entry is none of the questions")

    def entries_of(self, question: str) -> list[MeasuredSetting]:
        """Return the measured settings for the equations of one question, in the order in which they were listed."""
        return [entry for entry in self.entries if entry.question == question]

    def methods(self, question: str) -> dict[str, list[MeasuredSetting]]:
        """Return the measured settings for the equations of one question, grouped by method."""
        curves: dict[str, list[MeasuredSetting]] = {}
        for entry in self.entries_of(question):
            curves.setdefault(entry.method, []).append(entry)
        return curves


def find_error_quantile(errors: Array, share: float) -> float | None:
    """Return the quantile `share` of the known errors (the higher of two neighbors); None if no error is known."""
    known = errors[np.isfinite(errors)]
    return float(np.quantile(known, share, method="higher")) if len(known) else None


def is_pareto_optimal(mine: tuple[float, float], others: Sequence[tuple[float, float]]) -> bool:
    """Return whether no other pair (time, error) is at least as small as `mine` in both and smaller in one."""
    beaten = any(other != mine and other[0] <= mine[0] and other[1] <= mine[1] for other in others)
    return math.isfinite(sum(mine)) and not beaten


def mark_pareto_fronts(entries: Sequence[MeasuredSetting], bodies: int) -> list[MeasuredSetting]:
    """Return the entries with `pareto_front` set; only settings with a value at every phase pair can be on a front."""
    complete = [entry for entry in entries if entry.complete and not entry.model_error]

    def time_and_error(entry: MeasuredSetting, body: int) -> tuple[float, float]:
        """Return processor time, s, and relative error of a setting for a body; an unknown error is infinite."""
        error = entry.most[body]
        return entry.seconds, math.inf if error is None else error

    def is_on_front(entry: MeasuredSetting, body: int) -> bool:
        """Return whether no setting for the same equations is both faster and more accurate for a body."""
        rivals = [time_and_error(other, body) for other in complete if other.question == entry.question]
        return entry in complete and is_pareto_optimal(time_and_error(entry, body), rivals)

    return [replace(entry, pareto_front=tuple(is_on_front(entry, body) for body in range(bodies))) for entry in entries]


@result
class TradeFile:
    """Content of tradeoff.json: amplification error and compute time of each method and parameter value, by scene."""

    schema: Annotated[Literal["phase-resonance/tradeoff"], "what the file is"]
    trades: Annotated[list[SceneTrade], "one per scene"]


STORED = StoredFile(name=FILE, kind=TradeFile, what="a measured trade", command="phase-resonance tradeoff")


def load_trades(folder: Path) -> list[SceneTrade] | None:
    """Return each scene's errors and compute times in tradeoff.json of a folder; None if there is no such file."""
    content = STORED.load(folder)
    return None if content is None else content.trades


@dataclass(frozen=True)
class MeasuredTrade:
    """Measured error against compute time of one scene, and the values that it was made from."""

    trade: SceneTrade
    values: xr.Dataset  # amplification and its reference by setting, phase pair and body, as of `label_values`


def label_values(
    entries: Sequence[MeasuredSetting], values: Mapping[str, Sequence[Array]], phases: Array
) -> xr.Dataset:
    """
    Return a data set of all computed values by setting, phase pair ("point") and body, NaN where none was computed.

    values: by the names in MEANINGS, an array (phase pairs, bodies) for each setting in `entries`. phases: rad, (phase
    pairs, 2); a setting may have been computed at the first of them only.
    """
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
