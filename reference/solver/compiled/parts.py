"""
Functions (parts) that only compiled functions call, and that are compiled as a piece of these callers.

Numba optimizes a function together with all that it calls, and translates it to machine code, before it looks at the
next caller. A part of a large function goes through that once per level of callers, and only the last build ever runs.
A part compiled here is linked into its callers without that: it is optimized and translated once, with the entry point.

Numba counts the references to an array wherever one is named, also while a caller holds it anyway. A part counts none:
it makes no arrays, and keeps or returns none.

This needs numba's internals (numba_parts.py). With a numba newer than the newest that was tried, parts are built as
numba builds functions: the same numbers, in about twice the time of compiling
(docs/decisions/0013-parts-compiled-with-their-entry-point.md).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba

njit: Any = numba.njit  # numba has no type hints
NEWEST_KNOWN = 0, 68  # newest numba tested with its internals (oldest: 0.61); newer ones compile the slower, public way


def compiled_part(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator for a function that only compiled code calls, and that makes, keeps and returns no arrays."""
    if numba.version_info.short <= NEWEST_KNOWN:
        from reference.solver.compiled.numba_parts import PartCompiler

        options["pipeline_class"] = PartCompiler
    decorate: Callable[[Callable[..., Any]], Any] = njit(no_cpython_wrapper=True, no_cfunc_wrapper=True, **options)
    return decorate
