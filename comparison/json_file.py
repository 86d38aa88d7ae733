"""JSON files of results: written by one command, and read by another that finds them next to the report."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from pathlib import Path
from typing import Any, Generic, TypeVar

from pydantic import TypeAdapter, ValidationError

from reference.support.files import read_file

LARGEST = 2**26  # bytes of the largest file that is read

T = TypeVar("T")


def finite_or_none(value: float) -> float | None:
    """A number as JSON can hold it: None for NaN and infinity."""
    return value if math.isfinite(value) else None


def json_text(content: Mapping[str, Any] | Sequence[Any]) -> str:
    """Return the content of a JSON file, a line for every value; NaN and infinity, which JSON lacks, are null."""
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
def _type_adapter(kind: Any) -> TypeAdapter[Any]:
    return TypeAdapter(kind)  # made once: it takes a hundred times as long as a small file


@dataclass(frozen=True)
class StoredFile(Generic[T]):
    """A JSON file of results, which one command writes and the next report in the same folder shows; what: in words."""

    name: str
    kind: type[T]
    what: str
    command: str

    def word_field(self, meaning: str) -> str:
        """Return the meaning of the field of the results that shows the file."""
        return f"{meaning}; null unless {self.command} left it next to the report"

    def word_how_to_make(self, argument: str = "") -> str:
        """Return what makes the section that shows the file; argument: what the command is given, in words."""
        return f"{self.command}{argument} makes it, next to the report; the next run of the study shows it"

    def as_json(self, results: T) -> bytes:
        """The content of the file, which `load` reads."""
        return json_text(asdict(results)).encode()  # type: ignore[call-overload]

    def read(self, content: bytes) -> T:
        """Return the results in the content of a file. Raises ValidationError."""
        results: T = _type_adapter(self.kind).validate_json(content)  # type: ignore[arg-type]
        return results

    def load(self, folder: Path) -> T | None:
        """
        Return what the command left in a folder, None without a file.

        Raises ValueError, one line, for anything else.
        """
        file = folder / self.name
        if not file.exists():
            return None
        try:
            return self.read(read_file(file, LARGEST))
        except OSError as error:
            raise ValueError(f"{file}: {error.strerror}: must be {self.what}: run {self.command}") from None
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            place = ".".join(map(str, first["loc"]))
            reason = f"{place}: {first['msg']}" if place else first["msg"]  # not what it holds: it may be of anybody
            raise ValueError(f"{file}: not {self.what}: {reason}: run {self.command}") from None
