"""
Functions that numba compiles and keeps on disk, in the user's cache, under a hash of the source they are made from.

Numba looks at the file of a function alone when it decides whether a build is still good, not at what it calls in other
files. A build that belongs to all of these sources together cannot go stale.
"""

from __future__ import annotations

import gc
import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
from numba.core.compiler import Compiler

from reference.problem.user_cache import user_cache

njit: Any = numba.njit
config: Any = numba.config


class _Uncollected(Compiler):  # type: ignore[misc]
    """Numba's compiler while Python does not search for garbage: nearly all that it makes is in use to its end."""

    def compile_extra(self, func: Any) -> Any:
        """Compile a Python function."""
        if not gc.isenabled():
            return super().compile_extra(func)
        gc.disable()
        try:
            return super().compile_extra(func)
        finally:
            gc.enable()


def build_folder(sources: Path) -> Path | None:
    """
    Where the builds from a source are kept.

    Parameters
    ----------
    sources : Path
        A file, or a folder with all Python files below it.

    Returns
    -------
    Path or None
        Below NUMBA_CACHE_DIR if the user set it, otherwise in the user's cache. None if neither can be written.
    """
    # not numba's own setting: a file in the working directory may have made it, and builds are run
    named = os.environ.get("NUMBA_CACHE_DIR")
    parent = Path(named) if named else user_cache()
    if parent is None:
        return None
    digest = hashlib.sha256()
    for source in sorted(sources.rglob("*.py")) if sources.is_dir() else [sources]:
        digest.update(source.read_bytes())
    return parent / f"numba-{digest.hexdigest()[:12]}"


def cached_on_disk(sources: str | Path, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """
    Decorate a function that numba compiles on its first call and keeps on disk.

    Parameters
    ----------
    sources : str or Path
        The file or folder with all that the function calls: usually `__file__`.
    **options
        Of `numba.njit`.

    Returns
    -------
    callable
        The decorator.
    """
    folder = build_folder(Path(sources))

    def decorate(function: Callable[..., Any]) -> Any:
        before = config.CACHE_DIR
        config.CACHE_DIR = str(folder or "")
        try:
            decorate = njit(cache=folder is not None, pipeline_class=_Uncollected, no_cfunc_wrapper=True, **options)
            return decorate(function)
        finally:
            config.CACHE_DIR = before

    return decorate
