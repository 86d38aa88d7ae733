"""
Compilation of the solver: by numba, cached on disk under a hash of the solver's whole source.

Sums are not reordered and products not fused with sums (no `fastmath`), so that results are the same to the last bit in
every process and on every processor: docs/decisions/0003-floating-point-flags.md.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from reference.solver.compiled.parts import compiled_part
from reference.support.build_cache import cache_on_disk

# Options of numba: divisions by zero give inf or NaN as in NumPy; other Python threads can run at the same time.
NUMBA_OPTIONS = {"error_model": "numpy", "nogil": True}


def compiled(function: Callable[..., Any]) -> Any:
    """Decorate a solver function that only compiled code calls, so that numba compiles it (parts.py)."""
    return compiled_part(**NUMBA_OPTIONS)(function)


def cached_entry_point(function: Callable[..., Any]) -> Any:
    """Decorate a function that Python calls: its first call compiles it with all it calls, and stores that on disk."""
    return cache_on_disk(Path(__file__).parents[1], slow=True, **NUMBA_OPTIONS)(function)
