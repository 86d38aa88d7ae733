"""
Writing of files and directories whole or not at all, without replacing what somebody else wrote, and safe reading.

A file is written under a temporary name in the folder of its final path and then renamed. A directory is written in a
staging directory in that folder. The staging directory has a file that names the final path (the mark), and a lock that
ends with the process, however that ends. A marked directory without a lock therefore belongs to no living process.
Where the system has no locks (Windows), no directory is taken for abandoned.
"""

from __future__ import annotations

import errno
import json
import os
import secrets
import shutil
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

try:
    import fcntl
except ImportError:
    fcntl = None  # type: ignore[assignment]

# Prefix of temporary files and staging directories (a user's may have it too: only MARK_FILE proves a directory ours)
TEMPORARY_PREFIX = ".phase-resonance-"
MARK_FILE = "staging.json"  # file in a staging directory that names the program and the path for which it was made
CHUNK_BYTES = 2**20  # number of bytes of a file that are read at once
NEW_FILES_FOLDER = "new"  # name of the folder, in a staging directory, for the files being written


def read_file(file: str | Path, largest: int) -> bytes:
    """Return the content of a regular file of at most `largest` bytes. Raises OSError; ValueError if it is no path."""
    flags = (getattr(os, name, 0) for name in ("O_NONBLOCK", "O_NOCTTY", "O_CLOEXEC", "O_BINARY"))
    handle = os.open(file, os.O_RDONLY | sum(flags))
    try:
        status = os.fstat(handle)
        if stat.S_ISDIR(status.st_mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(file))
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "not a regular file", str(file))
        content = bytearray()
        size = status.st_size
        while size <= largest and (part := os.read(handle, CHUNK_BYTES)):  # the file may grow while it is read
            content += part
            size = len(content)
        if size > largest:
            raise OSError(errno.EFBIG, f"larger than {largest / 2**20:g} MiB", str(file))
        return bytes(content)
    finally:
        os.close(handle)


def write_atomically(file: Path, content: bytes) -> None:
    """Write a file of this program in place of an old one: if it fails, the old one remains. Raises OSError."""
    part = _write_part(file, content)
    try:
        os.replace(part, file)
    except BaseException:
        _remove_file(part)
        raise


def write_new(file: Path, content: bytes) -> Path:
    """Write a new file under this name, or the next free one such as `run-2.gif`; return its path. Raises OSError."""
    part = _write_part(file, content)
    try:
        for place in iterate_names(file):
            with suppress(FileExistsError):
                _move_to_free(part, place)
                return place
        raise AssertionError("the names do not end")
    finally:
        _remove_file(part)


def iterate_names(place: Path) -> Iterator[Path]:
    """Iterate over paths to try: `place` itself, then its name with -2, -3, ... before the suffix."""
    yield place
    number = 2
    while True:
        yield place.with_name(f"{place.stem}-{number}{place.suffix}")
        number += 1


@contextmanager
def hold_lock(folder: Path, wait: bool = True) -> Iterator[bool]:
    """
    Hold a directory's lock for a block; yield True if it is held.

    It is not held if the system has no locks, or if another process holds it and `wait` is False.
    """
    handle = -1
    try:
        if fcntl is not None:
            with suppress(OSError):
                handle = os.open(folder, os.O_RDONLY)
        held = False
        if handle >= 0:
            with suppress(OSError):  # the lock is held by another process, or the file system has no locks
                fcntl.flock(handle, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
                held = True
        yield held
    finally:
        if handle >= 0:
            os.close(handle)


@contextmanager
def staging_directory(place: Path) -> Iterator[Path]:
    """Make a locked staging directory next to `place` for a block, with an empty NEW_FILES_FOLDER; yield its path."""
    folder = Path(tempfile.mkdtemp(dir=place.parent, prefix=TEMPORARY_PREFIX))
    with hold_lock(folder, wait=False):
        try:
            write_atomically(folder / MARK_FILE, _content_of_mark(folder, place))
            (folder / NEW_FILES_FOLDER).mkdir()
            yield folder
        finally:
            clear_staging(folder)


def find_abandoned_staging(place: Path) -> Iterator[Path]:
    """
    Iterate over the staging directories for the final path `place` that ended processes have left.

    Each is locked in the body of the caller's loop.
    """
    with suppress(OSError):
        for folder in sorted(place.parent.iterdir()):
            if folder.name.startswith(TEMPORARY_PREFIX) and not folder.is_symlink() and _is_marked(folder, place):
                with hold_lock(folder, wait=False) as held:
                    if held:
                        yield folder


def clear_staging(folder: Path) -> None:
    """Remove a staging directory of this program, but no file that somebody else has put into it."""
    shutil.rmtree(folder / NEW_FILES_FOLDER, ignore_errors=True)
    _remove_file(folder / MARK_FILE)
    with suppress(OSError):
        folder.rmdir()


def _content_of_mark(folder: Path, place: Path) -> bytes:
    """Return the content of MARK_FILE, which marks `folder` as this program's staging directory for `place`."""
    return json.dumps({"what": "staging directory of phase-resonance", "name": folder.name, "for": place.name}).encode()


def _is_marked(folder: Path, place: Path) -> bool:
    """Return True if the MARK_FILE in a directory shows that it is this program's staging directory for `place`."""
    try:
        return read_file(folder / MARK_FILE, CHUNK_BYTES) == _content_of_mark(folder, place)
    except OSError:
        return False


def _write_part(file: Path, content: bytes) -> Path:
    """Write `content` to a temporary file in the folder of `file`; return its path. Raises OSError."""
    part = file.with_name(f"{TEMPORARY_PREFIX}{os.getpid()}-{secrets.token_hex(6)}")
    handle = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0), 0o666)
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
    except BaseException:
        _remove_file(part)
        raise
    return part


def _move_to_free(part: Path, place: Path) -> None:
    """Rename a temporary file to `place`. Raises FileExistsError if another file has just taken this name."""
    try:
        os.link(part, place)
    except FileExistsError:
        raise
    except OSError:  # the file system has no hard links: an empty file takes the name first
        os.close(os.open(place, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
        os.replace(part, place)


def _remove_file(file: Path) -> None:
    """Remove a file, or leave it where that is not possible."""
    with suppress(OSError):
        file.unlink()
