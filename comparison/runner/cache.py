"""
Every finished result of a study on disk, so that a run that was ended goes on where it stopped.

One directory per group of results, named by a hash of all that they depend on in common; in it one file per result. A
file begins with MAGIC and a checksum of its name and of all that follows: what the result depends on in words and the
result as JSON, then its arrays. One that is torn, damaged or of another form is computed again, which also covers a
power cut without waiting for the disk at every result. Nothing is unpickled. Only files that begin with MAGIC are ever
removed, and directories that are empty then.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import time
from collections import Counter
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from comparison.runner.encoding import packed, unpacked
from reference.problem import SceneError
from reference.problem.files import TEMPORARY, read_file, write_atomically

MAGIC = b"phase-resonance result 1\n"
LIMIT = 2**30  # bytes: above this, groups that the present study does not need are dropped, least recently used first
STALE = 3600.0  # s: a temporary file older than this was left by a killed run; a writing takes milliseconds
GROUP = re.compile("[0-9a-f]{24}")


class StoreError(OSError):
    """A result that could not be stored. `str(error)` is one line."""


@dataclass(frozen=True)
class Key:
    """
    What a result is found by. about: all that the results of its group depend on in common, as text; item: what
    distinguishes this one, as a hash; kind: the suffix of its file, which the counts go by.
    """

    about: str
    item: str
    kind: str

    @property
    def group(self) -> str:
        """Name of the directory."""
        return _short_hash(self.about)

    @property
    def name(self) -> str:
        """Name of the file below the folder of the cache."""
        return f"{self.group}/{self.item[:24]}.{self.kind}"


class Cache:
    """The results below `folder`, made with the first of them; `kept`: how many were read or written, by kind."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.kept: Counter[str] = Counter()

    def get(self, key: Key, declared: Any) -> Any | None:
        """The stored result to the last bit, of type `declared`; None if there is none that is whole and fits."""
        try:
            value = _unpacked(read_file(self.folder / key.name, LIMIT), key, declared)
        except Exception:  # whatever is wrong with a file, the result is computed again
            return None
        self.kept[key.kind] += 1
        with suppress(OSError):
            os.utime(self.folder / key.group)  # lately used
        return value

    def holds(self, key: Key) -> bool:
        """Whether there is a file for it, whatever its state."""
        return (self.folder / key.name).exists()

    def put(self, key: Key, value: Any) -> None:
        """Store a result, unless it names a fault. Raises StoreError, and leaves what is stored as it was."""
        if faulty(value):
            return
        place = self.folder / key.name
        try:
            place.parent.mkdir(parents=True, exist_ok=True)
            content = packed(json.loads(key.about), value)
            write_atomically(place, MAGIC + _checksum(key, content) + content)
        except OSError as error:
            raise StoreError(f"{str(self.folder)!r}: a result could not be stored: {error.strerror}") from None
        self.kept[key.kind] += 1

    def remove(self, keys: Iterable[Key]) -> None:
        """Drop these results and no others."""
        wanted = {key.name for key in keys}
        for group in {Path(name).parent.name for name in wanted}:
            with suppress(OSError):
                for entry in os.scandir(self.folder / group):
                    if f"{group}/{entry.name}" in wanted and _is_result(entry):
                        os.unlink(entry.path)

    def trim(self, keys: Iterable[Key], limit: int = LIMIT) -> None:
        """Drop groups other than those of `keys`, least recently used first, while all take more than `limit`."""
        needed = {key.group for key in keys}
        with suppress(OSError):  # a store that cannot be looked through is not worth ending a run for
            groups = [Path(entry.path) for entry in os.scandir(self.folder) if entry.is_dir(follow_symlinks=False)]
            groups.sort(key=lambda group: (group.stat().st_mtime, group.name))
            sizes = {group: _size(group) for group in groups}
            for group in groups:
                if sum(sizes.values()) > limit and group.name not in needed:
                    _drop(group)
                    del sizes[group]


def store_beside(out: Path) -> Path:
    """Where the results of a report are kept."""
    return out.with_name(f"{out.name}.tiles")


def refuse_foreign_store(out: Path) -> None:
    """Raise SceneError, one line, if something that is no folder of results is where that of the report belongs."""

    def refusal(rule: str) -> SceneError:
        return SceneError("command line", "--out", str(out), f"{folder.name!r} beside it {rule}")

    folder = store_beside(out)
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


def faulty(result: Any) -> bool:
    """Whether a result, or a part of it, names a fault."""
    if isinstance(result, tuple | list):
        return any(map(faulty, result))
    return bool(getattr(result, "error_message", ""))


@cache
def _short_hash(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:24]


def _unpacked(file: bytes, key: Key, declared: Any) -> Any:
    """The result in a file. Raises an exception if that is not what it holds."""
    start = len(MAGIC) + 32
    digest, content = file[len(MAGIC) : start], file[start:]
    if not file.startswith(MAGIC) or _checksum(key, content) != digest:
        raise ValueError("damaged, or of another question")
    return unpacked(content, declared)


def _checksum(key: Key, content: bytes) -> bytes:
    return hashlib.sha256(key.name.encode() + b"\0" + content).digest()


def _drop(group: Path) -> None:
    """Remove the results in a directory, and it if nothing else is in it."""
    if group.is_symlink():
        return
    with suppress(OSError):
        for entry in os.scandir(group):
            if _is_result(entry):
                os.unlink(entry.path)
        group.rmdir()


def _is_group(entry: os.DirEntry[str]) -> bool:
    """Whether an entry of a store looks like a directory of results. What is removed is proved file by file."""
    return entry.is_dir(follow_symlinks=False) and GROUP.fullmatch(entry.name) is not None


def _is_result(entry: os.DirEntry[str]) -> bool:
    """Whether a file is a result, or what a killed run left of one: by its first bytes."""
    if not entry.is_file(follow_symlinks=False):
        return False
    with suppress(OSError), open(entry.path, "rb") as stream:
        begin = stream.read(len(MAGIC))
        return begin == MAGIC or (entry.name.startswith(TEMPORARY) and begin == b"")
    return False


def _size(group: Path) -> int:
    """Bytes on disk; what killed runs left is removed on the way."""
    total = 0
    for entry in os.scandir(group):
        state = entry.stat(follow_symlinks=False)
        if entry.name.startswith(TEMPORARY) and time.time() - state.st_mtime > STALE and _is_result(entry):
            with suppress(OSError):
                os.unlink(entry.path)
        else:
            total += max(512 * getattr(state, "st_blocks", 0), state.st_size)
    return total
