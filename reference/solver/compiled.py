"""
How the solver is compiled: numba, cached on disk under a hash of the solver's whole source.

Numba looks at the file of a function alone when it decides whether a cached build is still good, not at what it
calls in other files. A build that belongs to all sources together cannot go stale.

Sums are not reordered and products are not fused with sums (no `fastmath`), so that mu is the same to the last bit in
every process and on every processor: docs/decisions/0003-floating-point-flags.md.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba

njit: Any = numba.njit
config: Any = numba.config


def _cache_folder() -> str:
    package = Path(__file__).parent
    digest = hashlib.sha256()
    for source in sorted(package.rglob("*.py")):
        digest.update(source.read_bytes())
    name = f"numba-{digest.hexdigest()[:12]}"
    default_parents = (package / "__pycache__", Path.home() / ".cache" / "phase-resonance", Path(tempfile.gettempdir()))
    # NUMBA_CACHE_DIR is the user's choice
    for parent in (Path(config.CACHE_DIR),) if config.CACHE_DIR else default_parents:
        try:
            parent.mkdir(parents=True, exist_ok=True)
        except OSError:
            continue
        if os.access(parent, os.W_OK):
            return str(parent / name)
    return ""


CACHE_FOLDER = _cache_folder()
# divisions by zero give inf or NaN as in NumPy; other threads go on meanwhile
OPTIONS = {"error_model": "numpy", "nogil": True}


def compiled(function: Callable[..., Any]) -> Any:
    """A part of the solver, called by compiled code alone: it is built into its caller and not wrapped for Python."""
    return njit(no_cpython_wrapper=True, no_cfunc_wrapper=True, **OPTIONS)(function)


def inlined(function: Callable[..., Any]) -> Any:
    """A part called in one place: its body becomes part of the caller, which shortens compilation."""
    return njit(inline="always", **OPTIONS)(function)


def cached_entry_point(function: Callable[..., Any]) -> Any:
    """Compile `function` with everything it calls on first use, and keep the build on disk."""
    before = config.CACHE_DIR
    config.CACHE_DIR = CACHE_FOLDER
    try:
        return njit(cache=True, **OPTIONS)(function)
    finally:
        config.CACHE_DIR = before
