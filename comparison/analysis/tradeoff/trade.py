"""What was measured, as data: errors and compute time of every setting, the fronts, and the files they are kept in."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

Array = NDArray[np.float64]

FILE, SCHEMA = "tradeoff.json", "phase-resonance/tradeoff"


@dataclass(frozen=True)
class Entry:
    """
    One setting. points, answered: phase pairs asked for, and with a value. seconds: of processor time per point.
    median, most: relative error of each mu against the reference solution, at half and at 95 % of the points; None
    without a value. error_estimate: 95 % of the relative error estimates, None where the method has none. pareto_front:
    for each mu, whether no other method here is as accurate (95 %) in less time. Other fields as in `settings.Setting`.
    """

    question: str
    method: str
    parameter: str
    unit: str
    value: float
    controlled: bool
    model_error: bool
    points: int
    answered: int
    seconds: float
    median: Sequence[float | None]
    most: Sequence[float | None]
    error_estimate: Sequence[float | None]
    step: float | None = None  # s, mean step, where the method tells it
    pareto_front: Sequence[bool] = ()
    error_message: str = ""


@dataclass(frozen=True)
class Answered:
    """
    One question: its title, its reference solution in words, the reference solution's relative error estimate, and how
    it was checked.
    """

    key: str
    title: str
    points: int
    reference_solution: str
    error: float
    checks: Sequence[str]


@dataclass(frozen=True)
class Trade:
    """The measured trade of one scene. run: command, times, machine."""

    scene: str
    title: str
    digest: str
    bodies: int
    questions: Sequence[Answered]
    entries: Sequence[Entry]
    run: Mapping[str, Any]

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
    """The error that a share of the points does not exceed; a value that was met, never one between two."""
    known = errors[np.isfinite(errors)]
    return float(np.quantile(known, share, method="higher")) if len(known) else None


def on_pareto_front(cost: Sequence[float], error: Sequence[float]) -> list[bool]:
    """Which of the pairs are not beaten: no other is at least as good in both and better in one."""
    pairs = list(zip(cost, error))
    return [
        math.isfinite(mine[0] + mine[1])
        and not any(all(a <= b for a, b in zip(other, mine)) and other != mine for other in pairs)
        for mine in pairs
    ]


def with_pareto_fronts(entries: Sequence[Entry], bodies: int) -> list[Entry]:
    """The entries with `pareto_front` filled in: within each question, among those that answer it at every point."""
    marks: dict[int, list[bool]] = {place: [False] * bodies for place in range(len(entries))}
    for question in {entry.question for entry in entries}:
        own = [
            place
            for place, entry in enumerate(entries)
            if entry.question == question and not entry.model_error and entry.answered == entry.points
        ]
        for body in range(bodies):
            errors = [entries[place].most[body] for place in own]
            known = [math.inf if error is None else error for error in errors]
            for place, mark in zip(own, on_pareto_front([entries[place].seconds for place in own], known)):
                marks[place][body] = mark
    return [Entry(**{**vars(entry), "pareto_front": tuple(marks[place])}) for place, entry in enumerate(entries)]


def as_json(found: Sequence[Trade]) -> bytes:
    """The content of the file."""
    content = {"schema": SCHEMA, "trades": [asdict(trade) for trade in found]}
    return (json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n").encode()


def load(folder: Path) -> list[Trade] | None:
    """The trades that `as_json` left in the folder, None if there are none. Raises ValueError for another file."""
    file = folder / FILE
    if not file.exists():
        return None
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
        if content["schema"] != SCHEMA:
            raise ValueError(f"its schema is {content['schema']!r}")
        return [
            Trade(
                **{
                    **trade,
                    "questions": [Answered(**part) for part in trade["questions"]],
                    "entries": [Entry(**part) for part in trade["entries"]],
                }
            )
            for trade in content["trades"]
        ]
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(f"{file}: not a measured trade: {error}: run python -m comparison.tradeoff") from None


def labeled(
    entries: Sequence[Entry], mu: Sequence[Array], reference_solution: Sequence[Array], error_estimate: Sequence[Array],
    phases: Array, run: Mapping[str, Any],
) -> xr.Dataset:  # fmt: skip
    """Every value by setting, point and body; a question with fewer points leaves the rest NaN."""
    count, bodies = len(phases), mu[0].shape[1]

    def padded(parts: Sequence[Array]) -> Array:
        whole = np.full((len(parts), count, bodies), np.nan)
        for place, part in enumerate(parts):
            whole[place, : len(part)] = part
        return whole

    axes = ("setting", "point", "body")
    data = xr.Dataset(
        {
            "mu": (axes, padded(mu), {"long_name": "amplification factor (5.1)", "units": "1"}),
            "reference_solution": (
                axes,
                padded(reference_solution),
                {"long_name": "the same by the reference solution of the question", "units": "1"},
            ),
            "error_estimate": (
                axes,
                padded(error_estimate),
                {"long_name": "estimated absolute error of mu", "units": "1"},
            ),
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
    return data.assign_attrs(command=run["command"], **run["provenance"])
