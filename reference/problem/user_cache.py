"""
The directory of the user for what this machine made and can make again: compiled code and recorded costs.

Nothing is ever written into the installed package, which may be read-only or belong to somebody else.
"""

from __future__ import annotations

import os
import stat
import tempfile
from functools import cache
from pathlib import Path

import platformdirs

NAME = "phase-resonance"


@cache
def user_cache() -> Path | None:
    """
    The user's cache directory of this project, created if needed. All that is in it may be deleted at any time.

    Returns
    -------
    Path or None
        As the system has it: `~/.cache/phase-resonance` or below XDG_CACHE_HOME on Linux, `~/Library/Caches` on macOS,
        `%LOCALAPPDATA%` on Windows. If it cannot be written, a private directory among the temporary files. None if
        that cannot be written either.

    Examples
    --------
    >>> user_cache().is_dir()
    True
    """
    return _writable(platformdirs.user_cache_path(NAME, appauthor=False)) or _private_temporary()


def _writable(folder: Path) -> Path | None:
    try:
        if folder.is_absolute():  # not where the home directory is unknown
            folder.mkdir(parents=True, exist_ok=True)
            return folder if os.access(folder, os.W_OK) else None
    except OSError:
        pass
    return None


def _private_temporary() -> Path | None:
    """Everybody may write beside it: what another user put there in advance is not loaded."""
    user = os.getuid() if hasattr(os, "getuid") else None
    folder = Path(tempfile.gettempdir()) / (NAME if user is None else f"{NAME}-{user}")
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        status = folder.lstat()
    except OSError:
        return None
    private = user is None or (status.st_uid == user and not status.st_mode & 0o077)
    return _writable(folder) if stat.S_ISDIR(status.st_mode) and private else None
