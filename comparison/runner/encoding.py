"""
Results as plain JSON and arrays, and back.

A value is written by what it is and read by what it must be: the type that the function which computes it declares.
What is stored names no type, so that reading it makes nothing but the values, lists, arrays and dataclasses which that
declaration names, and imports nothing.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache
from io import BytesIO
from typing import Any

import numpy as np
from numpy.lib import format as npy
from pydantic import ConfigDict, TypeAdapter

ARRAY, BYTES = "\0array", "\0bytes"  # keys of what stands behind the JSON, by its number


def packed(about: Any, value: Any) -> bytes:
    """A line of JSON, and the arrays that it refers to; about: what the value depends on. Raises TypeError."""
    arrays = BytesIO()
    count = 0

    def beside_json(part: Any) -> Any:
        nonlocal count
        if isinstance(part, bytes | np.ndarray):
            array = np.frombuffer(part, np.uint8) if isinstance(part, bytes) else part
            npy.write_array(arrays, array, allow_pickle=False)
            count += 1
            return {BYTES if isinstance(part, bytes) else ARRAY: count - 1}
        if isinstance(part, np.generic):
            return part.item()
        if isinstance(part, Enum):
            return part.value
        if isinstance(part, Mapping):
            return dict(part)
        if is_dataclass(part):
            return {each.name: getattr(part, each.name) for each in fields(part)}
        raise TypeError(f"{type(part).__name__} cannot be stored")

    text = json.dumps({"about": about, "value": value}, default=beside_json)
    return text.encode() + b"\n" + arrays.getvalue()


def unpacked(content: bytes, declared: Any) -> Any:
    """The value of type `declared` that `packed` has written. Raises an exception for anything else."""
    text, _, rest = content.partition(b"\n")
    arrays, stream = [], BytesIO(rest)
    while stream.tell() < len(rest):
        arrays.append(npy.read_array(stream, allow_pickle=False))

    def with_arrays(part: dict[str, Any]) -> Any:
        if ARRAY in part:
            return arrays[part[ARRAY]]
        return arrays[part[BYTES]].tobytes() if BYTES in part else part

    return _reader(declared).validate_python([json.loads(text, object_hook=with_arrays)["value"]])[0]


@cache
def _reader(declared: Any) -> TypeAdapter[tuple[Any]]:
    return TypeAdapter(tuple[declared], config=ConfigDict(arbitrary_types_allowed=True))  # a dataclass takes no config
