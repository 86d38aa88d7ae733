"""What the solver needs to be interpreted, not compiled: structures and rows as Python and NumPy have them."""

from __future__ import annotations

import builtins
import math
import types
from collections.abc import Callable
from typing import Any

import numpy as np


class Row(np.ndarray):
    """A row (reference/solver/rows.py), which no operator changes in place."""

    __iadd__ = np.ndarray.__add__  # type: ignore[assignment]
    __isub__ = np.ndarray.__sub__  # type: ignore[assignment]
    __imul__ = np.ndarray.__mul__  # type: ignore[assignment]


def _also_of_rows(alone: Callable[..., Any], together: Callable[..., Any]) -> Callable[..., Any]:
    def either(*numbers: Any, **named: Any) -> Any:
        return (together if any(isinstance(number, Row) for number in numbers) else alone)(*numbers, **named)

    return either


def prepare() -> None:
    """Before the solver is imported, in a process of its own with NUMBA_DISABLE_JIT=1."""
    np.seterr(all="ignore")
    for name in ("sqrt", "exp", "expm1", "log"):
        setattr(math, name, _also_of_rows(getattr(math, name), getattr(np, name)))
    builtins.max, builtins.min = _also_of_rows(max, np.maximum), _also_of_rows(min, np.minimum)  # type: ignore[assignment]

    from reference.solver import rows
    from reference.solver.collocation import LANES, STAGES
    from reference.solver.compiled import by_reference

    by_reference.by_reference = lambda kind: lambda values: types.SimpleNamespace(**values._asdict())
    by_reference.empty = lambda kind, fields: types.SimpleNamespace

    def put(array: Any, place: Any, values: Any) -> None:
        array[place][:LANES] = values

    rows.row = lambda array, place: array[place][:LANES].copy().view(Row)
    rows.put = put
    rows.as_many = _also_of_rows(
        lambda number, pattern: number, lambda number, pattern: np.full(LANES, number).view(Row)
    )
    rows.where_positive = _also_of_rows(
        lambda number, positive, otherwise: positive if number > 0.0 else otherwise,
        lambda number, positive, otherwise: np.where(number > 0.0, positive, otherwise).view(Row),
    )
    rows.lowest = lambda values: float(values[:STAGES].min())
    rows.highest = lambda values: float(values[:STAGES].max())
    rows.finite = lambda values: bool(np.isfinite(values[:STAGES]).all())
