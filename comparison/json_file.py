"""JSON files of results, written by one command and read by another that finds them next to the report."""

import json
import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any, Generic, TypeVar

from pydantic import TypeAdapter, ValidationError

from reference.support.files import read_file

MAX_FILE_BYTES = 2**26  # bytes of the largest file that is read

T = TypeVar("T")


def finite_or_none(value: float) -> float | None:
    """Return a number as JSON can hold it: None for NaN and infinity."""
    return value if math.isfinite(value) else None


def format_json(content: Mapping[str, Any] | Sequence[Any]) -> str:
    """Return the content as JSON text, a line for every value; NaN and infinity, which JSON lacks, are null."""
    return json.dumps(replace_unstorable(content), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def replace_unstorable(content: Any) -> Any:
    """Return the content with None for every number that JSON cannot hold."""
    if isinstance(content, float):
        return finite_or_none(content)
    if isinstance(content, Mapping):
        return {key: replace_unstorable(value) for key, value in content.items()}
    if isinstance(content, list | tuple):
        return [replace_unstorable(value) for value in content]
    return content


@cache
def _make_type_adapter(kind: Any) -> TypeAdapter[Any]:
    """Return pydantic's reader of a type, made once for each type."""
    return TypeAdapter(kind)  # Made once: making it takes a hundred times as long as reading a small file.


def word_how_to_make(command: str) -> str:
    """Return a sentence that a command, and no study, makes what a report would show."""
    return f"{command} makes it, next to the report; the next run of the study shows it"


@dataclass(frozen=True)
class StoredFile(Generic[T]):
    """JSON file of results that one command writes and the next report in the folder shows; what: its name in words."""

    name: str
    kind: type[T]
    what: str
    command: str

    def word_field(self, meaning: str) -> str:
        """Return the description of the results field that holds this file, with the command that writes the file."""
        return f"{meaning}; null unless {self.command} left it next to the report"

    def word_how_to_make(self, argument: str = "") -> str:
        """Return a sentence with the command that writes this file; argument: argument of the command, in words."""
        return word_how_to_make(f"{self.command}{argument}")

    def as_json(self, results: T) -> bytes:
        """Return results as the JSON content of the file, which `load` reads."""
        return format_json(asdict(results)).encode()  # type: ignore[call-overload]

    def read(self, content: bytes) -> T:
        """Return the results in the content of a file. Raises ValidationError."""
        results: T = _make_type_adapter(self.kind).validate_json(content)  # type: ignore[arg-type]
        return results

    def load(self, folder: Path) -> T | None:
        """
        Return the results that the command left in a folder, None without a file.

        Raises ValueError, one line, for anything else.
        """
        file = folder / self.name
        if not os.path.exists(file):  # False, too, where the system refuses the name
            return None
        try:
            return self.read(read_file(file, MAX_FILE_BYTES))
        except OSError as error:
            raise ValueError(f"{file}: {error.strerror}: must be {self.what}: run {self.command}") from None
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            place = ".".join(map(str, first["loc"]))
            # The reason leaves out the content of the file, which may be somebody else's.
            reason = f"{place}: {first['msg']}" if place else first["msg"]
            raise ValueError(f"{file}: not {self.what}: {reason}: run {self.command}") from None
