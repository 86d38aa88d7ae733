"""
Caching of functions compiled by numba: on disk, in the user's cache folder, under a hash of their source files.

Numba itself decides by the file of a function alone whether a compiled build is still valid, and does not see changes
of the functions that it calls in other files. Here the folder of a build is named after all of these sources, so that a
build cannot go stale. Nothing is ever written into the installed package, which may be read-only or belong to others.
"""

from __future__ import annotations

import gc
import hashlib
import multiprocessing
import os
import stat
import sys
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba
import platformdirs
from numba.core.compiler import Compiler

CACHE_NAME = "phase-resonance"  # name of this project's folder in the user's cache folder
njit: Any = numba.njit  # numba has no type hints
config: Any = numba.config  # global settings of numba


class _CompilerWithoutCollection(Compiler):  # type: ignore[misc]
    """Numba's compiler with Python's garbage collection off while it runs, which frees little and takes time."""

    def compile_extra(self, func: Any) -> Any:
        """Compile a Python function, with garbage collection off."""
        if not gc.isenabled():
            return super().compile_extra(func)
        gc.disable()
        try:
            return super().compile_extra(func)
        finally:
            gc.enable()


def build_folder(sources: Path) -> Path | None:
    """Return the folder for compiled `sources`, in NUMBA_CACHE_DIR or in the user's cache; None if there is neither."""
    # For safety numba's own setting is ignored: any file in the working directory may set it, and builds are executed.
    named = os.environ.get("NUMBA_CACHE_DIR")
    parent = Path(named) if named else user_cache()
    if parent is None:
        return None
    digest = hashlib.sha256()
    for source in sorted(sources.rglob("*.py")) if sources.is_dir() else [sources]:
        digest.update(source.read_bytes())
    return parent / f"numba-{digest.hexdigest()[:12]}"


class _AnnouncingCompiler(_CompilerWithoutCollection):
    """Compiler that tells the user on standard error that a long compilation begins; silent in worker processes."""

    def compile_extra(self, func: Any) -> Any:
        """Tell the user that a compilation begins, then compile a Python function."""
        if multiprocessing.parent_process() is None and sys.stderr is not None:
            print("compiling the reference, once; about 20 s", file=sys.stderr, flush=True)
        return super().compile_extra(func)


def cache_on_disk(sources: str | Path, slow: bool = False, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """
    Return a decorator that compiles a function with numba and caches it on disk.

    sources: file or folder of all code that the function calls. slow: True if its compilation takes long, so that the
    user is told of it on standard error.
    """
    pipeline = _AnnouncingCompiler if slow else _CompilerWithoutCollection
    folder = build_folder(Path(sources))

    def decorate(function: Callable[..., Any]) -> Any:
        """Return the function for compilation by numba, which stores the compiled code in the cache, `folder`."""
        before = config.CACHE_DIR
        config.CACHE_DIR = str(folder or "")
        try:
            decorate = njit(cache=folder is not None, pipeline_class=pipeline, no_cfunc_wrapper=True, **options)
            return decorate(function)
        finally:
            config.CACHE_DIR = before

    return decorate


@cache
def user_cache() -> Path | None:
    """Return this project's folder in the user's cache, else a private temporary one; None if neither is writable."""
    return _find_writable(platformdirs.user_cache_path(CACHE_NAME, appauthor=False)) or _private_temporary()


def _find_writable(folder: Path) -> Path | None:
    """Return the folder, which is made if absent; None if it cannot be written to."""
    try:
        if folder.is_absolute():  # the path is relative where the home directory is unknown
            folder.mkdir(parents=True, exist_ok=True)
            return folder if os.access(folder, os.W_OK) else None
    except OSError:
        pass
    return None


def _private_temporary() -> Path | None:
    """
    Return a temporary directory that no other user can write to; None if that is impossible.

    Compiled code in it is run, so another user who could write there could run code as this one.
    """
    user = os.getuid() if hasattr(os, "getuid") else None
    folder = Path(tempfile.gettempdir()) / (CACHE_NAME if user is None else f"{CACHE_NAME}-{user}")
    try:
        folder.mkdir(mode=0o700, exist_ok=True)
        status = folder.lstat()
    except OSError:
        return None
    private = user is None or (status.st_uid == user and not status.st_mode & 0o077)
    return _find_writable(folder) if stat.S_ISDIR(status.st_mode) and private else None
