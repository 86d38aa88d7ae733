"""JSON files of results: written by one command, and read by another that finds them beside the report."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ConfigDict, TypeAdapter, ValidationError

# of dataclasses that are read from files: unknown keys are refused; the text below a field is its meaning
FILE_FORMAT = ConfigDict(extra="forbid", use_attribute_docstrings=True)

T = TypeVar("T")


def finite_or_none(value: float) -> float | None:
    """A number as JSON can hold it: None for NaN and infinity."""
    return value if math.isfinite(value) else None


def json_text(content: Mapping[str, Any] | Sequence[Any]) -> str:
    """Content of a JSON file, a line for every value. Raises ValueError for NaN, which JSON does not have."""
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def load_file(file: Path, kind: type[T], what: str, command: str) -> T | None:
    """
    The content of a JSON file as the dataclass `kind`.

    Parameters
    ----------
    file : Path
        File to read.
    kind : type
        Dataclass that states its keys.
    what : str
        What the file should be, for the message.
    command : str
        Command that writes it, for the message.

    Returns
    -------
    kind or None
        None if there is no such file.

    Raises
    ------
    ValueError
        In one line, if the file is anything else.
    """
    if not file.exists():
        return None
    try:
        return TypeAdapter(kind).validate_json(file.read_bytes())
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join(map(str, first["loc"]))
        given = "" if first["type"] in ("missing", "json_invalid") else f" = {_short(first['input'])}"
        reason = f"{place}{given}: {first['msg']}" if place else first["msg"]
        raise ValueError(f"{file}: not {what}: {reason}: run {command}") from None


def _short(value: object, length: int = 60) -> str:
    shown = repr(value)
    return shown if len(shown) <= length else f"{shown[:length]}…"
