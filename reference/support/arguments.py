"""Checks of the arguments of public functions: each raises one line that states what is wrong and the rule."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import wraps
from inspect import signature
from numbers import Integral, Real
from types import UnionType
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Rest = ParamSpec("Rest")
Result = TypeVar("Result")
LONGEST = 80  # letters of a value in an error
MISSING = object()  # stands for an argument that is not given


@dataclass(frozen=True)
class Range:
    """Finite numbers from `lowest` to `highest`, both included, in `unit`; inf as well where it is `or_infinite`."""

    lowest: float
    highest: float
    unit: str = ""
    or_infinite: bool = False

    @property
    def text(self) -> str:
        """The range as it stands in a table."""
        return f"{self.lowest:g} to {self.highest:g}{', or inf' if self.or_infinite else ''}"

    @property
    def rule(self) -> str:
        """The range as the end of an error message."""
        unit = f" {self.unit}" if self.unit else ""
        if self.or_infinite:
            return f"must be positive, from {self.lowest:g} to {self.highest:g}{unit}, or inf"
        if self.lowest > 0.0:
            return f"must be finite and positive, from {self.lowest:g} to {self.highest:g}{unit}"
        return f"must be finite, from {self.lowest:g} to {self.highest:g}{unit}"

    def __contains__(self, value: float) -> bool:
        return bool(self.lowest <= value <= self.highest) or (self.or_infinite and value == math.inf)


def takes(kind: type | UnionType, rule: str) -> Callable[[Callable[Rest, Result]], Callable[Rest, Result]]:
    """Have a function raise TypeError, one line that ends with `rule`, if its first argument is not a `kind`."""

    def with_check(function: Callable[Rest, Result]) -> Callable[Rest, Result]:
        name = next(iter(signature(function).parameters))

        @wraps(function)
        def check_and_call(*args: Rest.args, **kwargs: Rest.kwargs) -> Result:
            first = args[0] if args else kwargs.get(name, MISSING)
            if first is not MISSING and not isinstance(first, kind):
                raise TypeError(f"{name} = {brief(first)}: {rule}")
            return function(*args, **kwargs)

        return check_and_call

    return with_check


def as_float(value: Any) -> float:
    """Return a number as a float: inf for one beyond double precision, NaN for what is no number."""
    try:
        return float(value) if isinstance(value, Real) and not isinstance(value, bool) else math.nan
    except OverflowError:
        return math.inf


def check_number(name: str, value: Any, allowed: Range) -> float:
    """Return `value` as a float. Raises ValueError, one line, if it is not a number within the range."""
    number = as_float(value)
    if number not in allowed:
        raise ValueError(f"{name} = {brief(value)}: {allowed.rule}")
    return number


def check_whole_number(name: str, value: Any, allowed: Range) -> int:
    """Return `value` as an int. Raises ValueError, one line, if it is not a whole number within the range."""
    if not isinstance(value, Integral) or isinstance(value, bool) or as_float(value) not in allowed:
        rule = f"must be a whole number from {allowed.lowest:g} to {allowed.highest:g}"
        raise ValueError(f"{name} = {brief(value)}: {rule}")
    return int(value)


def check_choice(name: str, value: Any, allowed: Sequence[str]) -> str:
    """Return `value` if it is one of the texts `allowed`. Raises ValueError, one line."""
    if not (isinstance(value, str) and value in allowed):
        raise ValueError(f"{name} = {brief(value)}: must be one of {', '.join(allowed)}")
    return value


def check_array(name: str, values: Any, rule: str, *, finite: bool = True) -> Array:
    """Return `values` as a contiguous array of numbers, or raise ValueError, one line that ends with `rule`."""
    if _is_masked(values):
        raise ValueError(f"{name}: has masked entries: {rule}")
    try:
        array = np.asarray(values)
    except ValueError:  # uneven rows
        array = np.empty(0, dtype=object)
    except MemoryError:  # what claims to be longer than the memory holds
        raise ValueError(f"{name}: takes more memory than there is: {rule}") from None
    if array.dtype.kind not in "iuf":
        raise ValueError(f"{name} = {brief(values)}: must be numbers: {rule}")
    array = np.ascontiguousarray(array, dtype=float)
    if finite and not np.isfinite(array).all():
        raise ValueError(f"{name}: must be finite: {rule}")
    return array


def _is_masked(values: Any) -> bool:
    """Return True if an array, or one within lists, has masked entries."""
    if isinstance(values, list | tuple):
        return any(map(_is_masked, values))
    return bool(np.ma.is_masked(values))


def name_some(names: Sequence[str], most: int) -> str:
    """Return the first `most` names, and how many more there are."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return f"{', '.join(names[:most])}{more}"


def brief(value: Any) -> str:
    """Return the `repr` of a value in one line of at most LONGEST letters."""
    try:
        text = repr(value[: 2 * LONGEST] if isinstance(value, str) else value)
    except (ValueError, RecursionError):  # an integer of more digits than Python prints, tables thousands deep
        text = f"<{type(value).__name__}>"
    text = " ".join(text.split())
    return text if len(text) <= LONGEST else text[: LONGEST - 3] + "..."
