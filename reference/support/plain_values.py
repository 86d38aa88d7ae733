"""Conversion of Python values to those of a scene file, and to those that can be hashed."""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any

import numpy as np


def as_plain_values(value: Any) -> Any:
    """
    Replace NumPy arrays and numbers, and tuples, by Python's lists and numbers, at any depth of nested lists.

    >>> as_plain_values((np.float64(0.5), np.arange(2)))
    [0.5, [0, 1]]
    """
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    return [as_plain_values(part) for part in value] if isinstance(value, list | tuple) else value


def as_hashable(value: Any) -> Hashable:
    """
    Replace lists by tuples and tables (dicts) by frozen sets, at any depth, for hashing; equal values stay equal.

    >>> hash(as_hashable({"a": [1.0]})) == hash(as_hashable({"a": [1]}))
    True
    """
    if isinstance(value, dict):
        return frozenset((key, as_hashable(part)) for key, part in value.items())
    return tuple(map(as_hashable, value)) if isinstance(value, list) else value
