"""Conversion of Python values to those of a scene file, and to those that can be hashed."""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any

import numpy as np


def as_plain_values(value: Any) -> Any:
    """
    Return lists and numbers of Python in place of arrays, tuples and numbers of NumPy, at any depth of lists.

    >>> as_plain_values((np.float64(0.5), np.arange(2)))
    [0.5, [0, 1]]
    """
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return [as_plain_values(part) for part in value] if isinstance(value, list | tuple) else value


def as_hashable(value: Any) -> Hashable:
    """
    Return tuples and frozen sets in place of lists and tables, at any depth; equal values give equal ones.

    >>> hash(as_hashable({"a": [1.0]})) == hash(as_hashable({"a": [1]}))
    True
    """
    if isinstance(value, dict):
        return frozenset((key, as_hashable(part)) for key, part in value.items())
    return tuple(map(as_hashable, value)) if isinstance(value, list) else value
