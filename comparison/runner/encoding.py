"""
Results as plain JSON and arrays, and back.

A value is written by what it is and read by what it must be: the type that the function which computes it declares.
What is stored names no type, so that reading it makes nothing but the values, lists, arrays and dataclasses which that
declaration names, and imports nothing.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache
from types import NoneType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import numpy as np

EXACT = 2**53  # whole numbers up to here are exact as floating-point numbers, and may stand where one is declared
NUMBERS = re.compile(r"[<>|][biufc]\d{1,2}")  # types of an array: none that holds objects
ARRAY, BYTES = "array", "bytes"  # keys of what stands beside the JSON


def encoded(value: Any, arrays: list[np.ndarray[Any, Any]]) -> Any:
    """`value` as JSON; what is binary is appended to `arrays` and referred to by its number. Raises TypeError."""
    if isinstance(value, Enum):
        return encoded(value.value, arrays)
    if isinstance(value, np.generic):
        return encoded(value.item(), arrays)
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, bytes):
        arrays.append(np.frombuffer(value, np.uint8))
        return {BYTES: len(arrays) - 1}
    if isinstance(value, np.ndarray) and NUMBERS.fullmatch(value.dtype.str):
        arrays.append(value)
        return {ARRAY: len(arrays) - 1}
    if isinstance(value, list | tuple):
        return [encoded(part, arrays) for part in value]
    if isinstance(value, Mapping) and all(isinstance(key, str) for key in value):
        return {key: encoded(part, arrays) for key, part in value.items()}
    if is_dataclass(value) and not isinstance(value, type):
        return {part.name: encoded(getattr(value, part.name), arrays) for part in fields(value)}
    raise TypeError(f"{type(value).__name__} cannot be stored")


def decoded(data: Any, declared: Any, arrays: Sequence[np.ndarray[Any, Any]]) -> Any:
    """The value of type `declared` that `data` and `arrays` stand for; ValueError or TypeError if they do not."""
    origin, parts = get_origin(declared), get_args(declared)
    if origin in (Union, UnionType):
        return _first_that_fits(data, parts, arrays)
    if origin is Literal:
        return _checked(data, any(data == part and type(data) is type(part) for part in parts), declared)
    if declared in (None, NoneType):
        return _checked(data, data is None, declared)
    if declared is float:
        whole = type(data) is int and abs(data) <= EXACT
        return _checked(data, whole or type(data) is float, declared)
    if declared in (bool, int, str):
        return _checked(data, type(data) is declared, declared)
    if declared is bytes:
        return _array(data, BYTES, np.uint8, arrays).tobytes()
    if origin is np.ndarray:
        return _array(data, ARRAY, get_args(parts[1])[0], arrays)
    if origin in (list, tuple, Sequence):
        return _sequence(data, origin, parts, arrays)
    if origin is not None and issubclass(origin, Mapping):
        _checked(data, isinstance(data, dict), declared)
        return {decoded(key, parts[0], arrays): decoded(part, parts[1], arrays) for key, part in data.items()}
    if isinstance(declared, type) and issubclass(declared, Enum):
        return declared(data)
    if isinstance(declared, type) and is_dataclass(declared):
        hints = _hints(declared)
        names = [part.name for part in fields(declared)]
        _checked(data, isinstance(data, dict) and sorted(data) == sorted(names), declared)
        return declared(**{name: decoded(data[name], hints[name], arrays) for name in names})
    raise TypeError(f"{declared} cannot be read from the store")


@cache
def _hints(declared: type) -> dict[str, Any]:
    return get_type_hints(declared)


def _sequence(data: Any, origin: Any, parts: tuple[Any, ...], arrays: Sequence[np.ndarray[Any, Any]]) -> Any:
    _checked(data, isinstance(data, list), origin)
    if origin is tuple and not (len(parts) == 2 and parts[1] is Ellipsis):
        _checked(data, len(data) == len(parts), parts)
        return tuple(decoded(part, declared, arrays) for part, declared in zip(data, parts))
    made = [decoded(part, parts[0], arrays) for part in data]
    return made if origin is list else tuple(made)


def _first_that_fits(data: Any, choices: Sequence[Any], arrays: Sequence[np.ndarray[Any, Any]]) -> Any:
    for declared in choices:
        try:
            return decoded(data, declared, arrays)
        except (TypeError, ValueError):
            continue
    raise ValueError(f"none of {choices}")


def _array(data: Any, key: str, kind: Any, arrays: Sequence[np.ndarray[Any, Any]]) -> np.ndarray[Any, Any]:
    _checked(data, isinstance(data, dict) and list(data) == [key] and type(data[key]) is int, key)
    _checked(data, 0 <= data[key] < len(arrays), key)
    array: np.ndarray[Any, Any] = arrays[data[key]]
    _checked(data, kind is Any or issubclass(array.dtype.type, kind), kind)
    return array


def _checked(data: Any, right: bool, declared: Any) -> Any:
    if not right:
        raise ValueError(f"not {declared}")
    return data


def array_bytes(array: np.ndarray[Any, Any]) -> bytes:
    """The numbers of an array, the last index running fastest."""
    return np.ascontiguousarray(array).tobytes()


def array_of(kind: Any, shape: Any, content: bytes) -> tuple[np.ndarray[Any, Any], int]:
    """The array that begins `content`, and how many bytes it takes. Raises ValueError unless it is one of numbers."""
    if not (isinstance(kind, str) and NUMBERS.fullmatch(kind)):
        raise ValueError("not a type of numbers")
    if not (isinstance(shape, list) and len(shape) <= 8 and all(type(size) is int and size >= 0 for size in shape)):
        raise ValueError("not a shape")
    dtype, count = np.dtype(kind), math.prod(shape)
    size = count * dtype.itemsize
    if size > len(content):
        raise ValueError("shorter than its shape")
    if dtype.kind == "b" and any(byte > 1 for byte in content[:size]):
        raise ValueError("neither true nor false")
    return np.frombuffer(content, dtype, count).reshape(shape).copy(), size
