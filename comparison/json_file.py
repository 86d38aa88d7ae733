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

MAX_FILE_BYTES = 2**26  # size in bytes above which a stored file is refused

T = TypeVar("T")  # type of the content of a stored file


def finite_or_none(value: float) -> float | None:
    """Return the number, or None for NaN and infinity, which JSON cannot hold."""
    return value if math.isfinite(value) else None


def format_json(content: Mapping[str, Any] | Sequence[Any]) -> str:
    """Return the content as JSON text, a line for every value; NaN and infinity, which JSON lacks, are null."""
    return json.dumps(replace_unstorable(content), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def replace_unstorable(content: Any) -> Any:
    """Return the content with None instead of every NaN and infinity, which JSON cannot hold."""
    if isinstance(content, float):
        return finite_or_none(content)
    if isinstance(content, Mapping):
        return {key: replace_unstorable(value) for key, value in content.items()}
    if isinstance(content, list | tuple):
        return [replace_unstorable(value) for value in content]
    return content


@cache
def _make_type_adapter(kind: Any) -> TypeAdapter[Any]:
    """Return the pydantic object that reads and checks data of a type, made once for each type."""
    return TypeAdapter(kind)  # Making it takes a hundred times as long as reading a small file.


def word_how_to_make(command: str) -> str:
    """Return a sentence for a report section that is missing: which command makes its content."""
    return f"{command} makes it, next to the report; the next run of the study shows it"


@dataclass(frozen=True)
class StoredFile(Generic[T]):
    """JSON file of results that one command writes into the folder of a report, which then shows them."""

    name: str  # name of the file
    kind: type[T]  # type of the results
    what: str  # what it holds, in words for messages, as "a table of benchmarks"
    command: str  # command that writes it

    def word_field(self, meaning: str) -> str:
        """Return the description of the results field that holds this file's content, in words."""
        return f"{meaning}; null unless {self.command} left it next to the report"

    def word_how_to_make(self, argument: str = "") -> str:
        """Return a sentence that names the command that writes this file; argument: what follows the command."""
        return word_how_to_make(f"{self.command}{argument}")

    def as_json(self, results: T) -> bytes:
        """Return results as the bytes of the JSON file, in the form that `load` reads."""
        return format_json(asdict(results)).encode()  # type: ignore[call-overload]

    def read(self, content: bytes) -> T:
        """Return the results in the bytes of a file. Raises ValidationError if it holds anything else."""
        results: T = _make_type_adapter(self.kind).validate_json(content)  # type: ignore[arg-type]
        return results

    def load(self, folder: Path) -> T | None:
        """
        Return the results that the command left in a folder, None if the file is not there.

        Raises ValueError, with a message of one line, if the file cannot be read or holds anything else.
        """
        file = folder / self.name
        if not os.path.exists(file):  # also False, without an error, for a path that the system does not allow
            return None
        try:
            return self.read(read_file(file, MAX_FILE_BYTES))
        except OSError as error:
            raise ValueError(f"{file}: {error.strerror}: must be {self.what}: run {self.command}") from None
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            place = ".".join(map(str, first["loc"]))
            # The message does not quote the content of the file, which may be private.
            reason = f"{place}: {first['msg']}" if place else first["msg"]
            raise ValueError(f"{file}: not {self.what}: {reason}: run {self.command}") from None
