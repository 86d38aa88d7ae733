"""Checks of the arguments of public functions, which raise one line that states what is wrong and the rule."""

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
Parameters = ParamSpec("Parameters")  # types of the parameters of a decorated function
Result = TypeVar("Result")  # type of the result of a decorated function
MAX_QUOTED_LETTERS = 80  # largest number of letters of a value that an error message quotes
MAX_LENGTH = 10**8  # largest number of entries accepted of an object that is not an array
MISSING = object()  # stands for an argument that the caller has not given


@dataclass(frozen=True)
class Range:
    """
    Finite numbers from `lowest` to `highest`, both included, in `unit`; with `or_infinite` also inf.

    hint: words at the end of an error message on what to write in place of a number outside the range.
    """

    lowest: float
    highest: float
    unit: str = ""
    or_infinite: bool = False
    hint: str = ""

    @property
    def text(self) -> str:
        """The range as text for a table, such as "1 to 5"."""
        return f"{self.lowest:g} to {self.highest:g}{', or inf' if self.or_infinite else ''}"

    @property
    def rule(self) -> str:
        """The range as a rule in an error message, such as "must be finite and positive, from 1 to 5 s"."""
        unit = f" {self.unit}" if self.unit else ""
        if self.or_infinite:
            return f"must be positive, from {self.lowest:g} to {self.highest:g}{unit}, or inf"
        if self.lowest > 0.0:
            return f"must be finite and positive, from {self.lowest:g} to {self.highest:g}{unit}"
        hint = f": {self.hint}" if self.hint else ""
        return f"must be finite, from {self.lowest:g} to {self.highest:g}{unit}{hint}"

    def __contains__(self, value: float) -> bool:
        """Return True if a number is within the range."""
        return bool(self.lowest <= value <= self.highest) or (self.or_infinite and value == math.inf)


def require_type(
    kind: type | UnionType, rule: str
) -> Callable[[Callable[Parameters, Result]], Callable[Parameters, Result]]:
    """Return a decorator that raises TypeError, a line that ends with `rule`, if the first argument is not a `kind`."""

    def with_check(function: Callable[Parameters, Result]) -> Callable[Parameters, Result]:
        """Return the function with a check of its first argument's type before each call."""
        name = next(iter(signature(function).parameters))

        @wraps(function)
        def check_and_call(*args: Parameters.args, **kwargs: Parameters.kwargs) -> Result:
            """Call the function if its first argument has the required type. Raises TypeError."""
            first = args[0] if args else kwargs.get(name, MISSING)
            if first is not MISSING and not isinstance(first, kind):
                raise TypeError(f"{name} = {quote(first)}: {rule}")
            return function(*args, **kwargs)

        return check_and_call

    return with_check


def as_float(value: Any) -> float:
    """Return a number as a float: inf if it is too large for a float, NaN for anything that is not a number."""
    try:
        return float(value) if isinstance(value, Real) and not isinstance(value, bool) else math.nan
    except OverflowError:
        return math.inf


def check_number(name: str, value: Any, allowed: Range) -> float:
    """Return an argument's `value` as a float. Raises ValueError if it is not a number within the range `allowed`."""
    number = as_float(value)
    if number not in allowed:
        raise ValueError(f"{name} = {quote(value)}: {allowed.rule}")
    return number


def check_whole_number(name: str, value: Any, allowed: Range) -> int:
    """Return an argument's `value` as an int. Raises ValueError if it is no whole number within the range `allowed`."""
    if not isinstance(value, Integral) or as_float(value) not in allowed:
        rule = f"must be a whole number from {allowed.lowest:g} to {allowed.highest:g}"
        raise ValueError(f"{name} = {quote(value)}: {rule}")
    return int(value)


def check_choice(name: str, value: Any, allowed: Sequence[str]) -> str:
    """Return an argument's `value` if it is one of the texts `allowed`. Raises ValueError if it is not."""
    if not (isinstance(value, str) and value in allowed):
        raise ValueError(f"{name} = {quote(value)}: must be one of {', '.join(allowed)}")
    return value


def check_array(name: str, values: Any, rule: str, *, finite: bool = True) -> Array:
    """Return an argument's `values` as a contiguous float array. Raises ValueError, ending with `rule`, if invalid."""
    try:
        if _claims_too_many(values):
            raise MemoryError
        masked = _is_masked(values)
        array = np.empty(0) if masked else np.asarray(values)
    except MemoryError:  # the object says that it has more entries than memory holds
        raise ValueError(f"{name}: takes more memory than there is: {rule}") from None
    except Exception:  # the rows have different lengths, a list contains itself, or an object is no array
        masked, array = False, np.empty(0, dtype=object)
    if masked:
        raise ValueError(f"{name}: has masked entries: {rule}")
    if array.dtype.kind not in "iuf":
        raise ValueError(f"{name} = {quote(values)}: must be numbers: {rule}")
    array = np.ascontiguousarray(array, dtype=float)
    if finite and not np.isfinite(array).all():
        raise ValueError(f"{name}: must be finite: {rule}")
    return array


def _claims_too_many(values: Any) -> bool:
    """Return True if an object that is not an array says that it has more than MAX_LENGTH entries."""
    counted = hasattr(values, "__len__") and not hasattr(values, "__array__")
    return counted and len(values) > MAX_LENGTH


def _is_masked(values: Any) -> bool:
    """Return True if an array, or any array within nested lists, is masked (numpy.ma) and has masked entries."""
    if isinstance(values, list | tuple):
        return any(map(_is_masked, values))
    return bool(np.ma.is_masked(values))


def name_some(names: Sequence[str], most: int) -> str:
    """Return text that lists the first `most` names, and tells how many more there are."""
    more = f" and {len(names) - most} more" if len(names) > most else ""
    return f"{', '.join(names[:most])}{more}"


def quote(value: Any) -> str:
    """Return a value as Python writes it (`repr`), in one line of at most MAX_QUOTED_LETTERS letters."""
    try:
        text = repr(value[: 2 * MAX_QUOTED_LETTERS] if isinstance(value, str) else value)
    # An integer has more digits than Python prints, tables are nested thousands deep, or an object cannot be shown
    except Exception:
        text = f"<{type(value).__name__}>"
    text = " ".join(text.split())
    return text if len(text) <= MAX_QUOTED_LETTERS else text[: MAX_QUOTED_LETTERS - 3] + "..."
