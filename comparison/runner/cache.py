"""
Cache of every finished result of a study on disk, from which an interrupted run continues.

One directory per group of results, named by a hash of all that they depend on in common; in it one file per result. A
file begins with FILE_SIGNATURE and a checksum of its name and of all that follows: what the result depends on in words
and the result as JSON, then its arrays. One that is torn, damaged or of another form is computed again, which also
covers a power cut without waiting for the disk at every result. A value is written by what it is, and read as the type
that the function declares which computes it: nothing is unpickled or imported. Only files that begin with
FILE_SIGNATURE are ever removed, and directories that are empty then.
"""

import hashlib
import json
import os
import re
import time
from collections import Counter
from collections.abc import Iterable, Mapping
from contextlib import suppress
from dataclasses import dataclass, fields, is_dataclass
from enum import Enum
from functools import cache, cached_property
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy
from pydantic import ConfigDict, TypeAdapter

from reference.problem import SceneError
from reference.support.files import TEMPORARY_PREFIX, read_file, write_atomically

FILE_SIGNATURE = b"phase-resonance result 1\n"  # first bytes of every file in the cache
CHECKSUM_BYTES = 32  # length of a checksum (SHA-256) in bytes
# Size of the cache in bytes above which unneeded groups of results are deleted, least recently used first
MAX_CACHE_BYTES = 2**30
STALE_FILE_AGE = 3600.0  # s, age above which a temporary file is of a killed run: writing one takes milliseconds
GROUP_NAME_PATTERN = re.compile("[0-9a-f]{24}")  # matches the name of a directory with results: 24 digits of a hash
ARRAY_KEY, BYTES_KEY = "\0array", "\0bytes"  # JSON keys that refer by number to an array or bytes stored after the JSON


class StoreError(OSError):
    """Error: a result could not be written into the cache; `str(error)` is one line."""


@dataclass(frozen=True)
class CacheKey:
    """
    Key of a result in the cache, from which its directory and file name follow.

    about: JSON text of all that a group of results depends on in common. item: hash of what distinguishes this result.
    kind: suffix of its file; results are counted by kind.
    """

    about: str
    item: str
    kind: str

    @cached_property
    def group(self) -> str:
        """Return the name of the directory with this group of results: a hash of what they have in common."""
        return hashlib.sha256(self.about.encode()).hexdigest()[:24]

    @property
    def name(self) -> str:
        """Return the path of the result's file, relative to the folder of the cache."""
        return f"{self.group}/{self.item[:24]}.{self.kind}"


class Cache:
    """
    Store of results on disk, in subfolders of `folder`.

    kept: number of results read or written through this object, by kind of result.
    """

    def __init__(self, folder: Path) -> None:
        """Use this folder for the files; it need not exist yet."""
        self.folder = folder
        self.kept: Counter[str] = Counter()

    def get(self, key: CacheKey, declared: Any) -> Any | None:
        """Return the stored result, bit for bit, of type `declared`; None if there is none or its file is damaged."""
        try:
            file = read_file(self.folder / key.name, MAX_CACHE_BYTES)
            digest, content = (
                file[len(FILE_SIGNATURE) : len(FILE_SIGNATURE) + CHECKSUM_BYTES],
                file[len(FILE_SIGNATURE) + CHECKSUM_BYTES :],
            )
            if not file.startswith(FILE_SIGNATURE) or _checksum(key, content) != digest:
                return None  # The file is damaged, or holds the result of another key.
            value = _unpack_value(content, declared)
        except Exception:  # Whatever is wrong with the file, the result is computed again.
            return None
        self.kept[key.kind] += 1
        with suppress(OSError):
            os.utime(self.folder / key.group)  # marks the group as recently used
        return value

    def holds(self, key: CacheKey) -> bool:
        """Return whether the cache has a file for the key, which may be damaged."""
        return (self.folder / key.name).exists()

    def put(self, key: CacheKey, value: Any) -> None:
        """Store a result unless it has an error message. Raises StoreError; earlier results then stay as they were."""
        if has_error_message(value):
            return
        place = self.folder / key.name
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            content = _pack_value(json.loads(key.about), value)
            write_atomically(place, FILE_SIGNATURE + _checksum(key, content) + content)
        except OSError as error:
            raise StoreError(f"{str(self.folder)!r}: a result could not be stored: {error.strerror}") from None
        self.kept[key.kind] += 1

    def remove(self, keys: Iterable[CacheKey]) -> None:
        """Delete the stored results of these keys."""
        wanted = {key.name for key in keys}
        for group in {Path(name).parent.name for name in wanted}:
            with suppress(OSError):
                for entry in os.scandir(self.folder / group):
                    if f"{group}/{entry.name}" in wanted and _is_result(entry):
                        os.unlink(entry.path)

    def trim(self, keys: Iterable[CacheKey]) -> None:
        """Delete groups of results not needed for `keys`, least recently used first, while size > MAX_CACHE_BYTES."""
        needed = {key.group for key in keys}
        with suppress(OSError):  # A run goes on even if the files of the cache cannot be listed.
            groups = [Path(entry.path) for entry in os.scandir(self.folder) if entry.is_dir(follow_symlinks=False)]
            groups.sort(key=lambda group: (group.stat().st_mtime, group.name))
            sizes = {group: _measure_group(group) for group in groups}
            for group in groups:
                if sum(sizes.values()) > MAX_CACHE_BYTES and group.name not in needed:
                    _remove_group(group)
                    del sizes[group]


def locate_store(out: Path) -> Path:
    """Return the folder of stored results that belongs to the report folder `out`."""
    return out.with_name(f"{out.name}.tiles")


def refuse_foreign_store(out: Path) -> None:
    """Raise SceneError if the folder for stored results holds anything else, or cannot be used."""

    def refusal(rule: str) -> SceneError:
        """Return the error that names the folder and the broken rule."""
        return SceneError("command line", "--out", str(out), f"{folder.name!r} next to it {rule}")

    folder = locate_store(out)
    try:
        if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
            raise refusal("is not the folder that keeps results of this study: move it away")
        foreign_files = [entry.name for entry in os.scandir(folder) if not _is_group(entry)] if folder.exists() else []
        if foreign_files:
            raise refusal(f"is not a store of results of this study, it holds {min(foreign_files)!r}: move it away")
        if folder.exists() and not os.access(folder, os.W_OK | os.X_OK):
            raise refusal("cannot be written")
    except OSError as error:
        raise refusal(f"cannot be used: {error.strerror}") from None


def has_error_message(result: Any) -> bool:
    """Return whether a result, or any part of it, has an error message; it is not stored then."""
    if isinstance(result, tuple | list):
        return any(map(has_error_message, result))
    return bool(getattr(result, "error_message", ""))


def _checksum(key: CacheKey, content: bytes) -> bytes:
    """Return a checksum of key and content, so that a file that was renamed is not taken for another result."""
    return hashlib.sha256(key.name.encode() + b"\0" + content).digest()


def _remove_group(group: Path) -> None:
    """Delete the stored results in a directory, and then the directory if it is empty."""
    if group.is_symlink():
        return
    with suppress(OSError):
        for entry in os.scandir(group):
            if _is_result(entry):
                os.unlink(entry.path)
        group.rmdir()


def _is_group(entry: os.DirEntry[str]) -> bool:
    """Return whether a directory entry is a directory named like a group of results."""
    return entry.is_dir(follow_symlinks=False) and GROUP_NAME_PATTERN.fullmatch(entry.name) is not None


def _is_result(entry: os.DirEntry[str]) -> bool:
    """Return whether a file, by its first bytes, is a stored result, or an empty one left by a killed run."""
    if not entry.is_file(follow_symlinks=False):
        return False
    with suppress(OSError), open(entry.path, "rb") as stream:
        begin = stream.read(len(FILE_SIGNATURE))
        return begin == FILE_SIGNATURE or (entry.name.startswith(TEMPORARY_PREFIX) and begin == b"")
    return False


def _measure_group(group: Path) -> int:
    """Return the bytes that a directory of results takes on disk; delete files left there by killed runs."""
    total = 0
    for entry in os.scandir(group):
        state = entry.stat(follow_symlinks=False)
        if (
            entry.name.startswith(TEMPORARY_PREFIX)
            and time.time() - state.st_mtime > STALE_FILE_AGE
            and _is_result(entry)
        ):
            with suppress(OSError):
                os.unlink(entry.path)
        else:
            total += max(512 * getattr(state, "st_blocks", 0), state.st_size)
    return total


def _pack_value(about: Any, value: Any) -> bytes:
    """
    Return a result as bytes: a line of JSON, then its arrays. Raises TypeError for a value that cannot be stored.

    about: what the result depends on, for readers of the file.
    """
    arrays = BytesIO()
    count = 0

    def convert_to_json(part: Any) -> Any:
        """Return a value in a form that JSON can hold; write an array or bytes to `arrays` and return a reference."""
        nonlocal count
        if isinstance(part, bytes | np.ndarray):
            array = np.frombuffer(part, np.uint8) if isinstance(part, bytes) else part
            npy.write_array(arrays, array, allow_pickle=False)
            count += 1
            return {BYTES_KEY if isinstance(part, bytes) else ARRAY_KEY: count - 1}
        if isinstance(part, np.generic):
            return part.item()
        if isinstance(part, Enum):
            return part.value
        if isinstance(part, Mapping):
            return dict(part)
        if is_dataclass(part):
            return {each.name: getattr(part, each.name) for each in fields(part)}
        raise TypeError(f"{type(part).__name__} cannot be stored")

    text = json.dumps({"about": about, "value": value}, default=convert_to_json)
    return text.encode() + b"\n" + arrays.getvalue()


def _unpack_value(content: bytes, declared: Any) -> Any:
    """Return the value of type `declared` from the bytes that `_pack_value` made. Raises an error for others."""
    text, _, rest = content.partition(b"\n")
    arrays, stream = [], BytesIO(rest)
    while stream.tell() < len(rest):
        arrays.append(npy.read_array(stream, allow_pickle=False))

    def with_arrays(part: dict[str, Any]) -> Any:
        """Return the array or bytes to which a JSON object refers; any other object unchanged."""
        if ARRAY_KEY in part:
            return arrays[part[ARRAY_KEY]]
        return arrays[part[BYTES_KEY]].tobytes() if BYTES_KEY in part else part

    return _make_type_adapter(declared).validate_python([json.loads(text, object_hook=with_arrays)["value"]])[0]


@cache
def _make_type_adapter(declared: Any) -> TypeAdapter[tuple[Any]]:
    """Return the pydantic object that checks and converts a tuple with one value of type `declared`."""
    # A tuple, because pydantic allows this configuration for a tuple but not for a dataclass
    return TypeAdapter(tuple[declared], config=ConfigDict(arbitrary_types_allowed=True))
