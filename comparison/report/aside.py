"""
The directory beside a report in which the next one is written; what a killed run left there is found and cleared.

Whoever writes holds a lock on the directory, which ends with the process, however that ends. A directory with our mark
and without a lock belongs to nobody who lives. Without such locks (Windows) nothing is cleared.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

try:
    import fcntl
except ImportError:
    fcntl = None  # type: ignore[assignment]

MARK = "phase-resonance-report"  # file that says whose directory it is; written once the lock is held
NEW, OLD = "new", "old"  # the report being written; the one it replaces, for a moment


@contextmanager
def aside(place: Path) -> Iterator[Path]:
    """A directory of our own beside `place`, locked; it is gone after the block. Raises OSError."""
    folder = Path(tempfile.mkdtemp(dir=place.parent, prefix=f".{place.name}-"))
    lock = _locked(folder)
    try:
        (folder / MARK).touch()
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        if lock is not None:
            os.close(lock)


def clear_dead(out: Path) -> None:
    """
    Remove what killed runs left beside `out`.

    One that was killed between taking the old report away and putting the new one in its place gets its old one back.
    """
    place = out.resolve()
    for folder in place.parent.glob(f".{place.name}-*"):
        if not (folder / MARK).is_file() or (lock := _locked(folder)) is None:
            continue
        try:
            if (folder / OLD).is_dir() and not place.exists():
                with suppress(OSError):
                    os.rename(folder / OLD, place)
            if not (folder / OLD).exists() or place.exists():
                shutil.rmtree(folder, ignore_errors=True)
        finally:
            os.close(lock)


def _locked(folder: Path) -> int | None:
    """A lock on the directory, until it is closed or the process ends; None if another process has it."""
    if fcntl is None:
        return None
    try:
        lock = os.open(folder, os.O_RDONLY)
    except OSError:
        return None
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:  # held, or a file system without locks
        os.close(lock)
        return None
    return lock
