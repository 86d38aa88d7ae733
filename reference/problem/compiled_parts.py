"""
Functions that exist only as a part of the compiled function that calls them.

Numba optimizes a function together with all that it calls, and translates it to machine code, before it looks at the
next caller. A part of a large function goes through that once per level of callers, and only the last build ever runs.
A part compiled here is linked into its callers without that: it is optimized and translated once, with the entry point.

Numba counts the references to an array wherever one is named, also while a caller holds it anyway. A part counts none:
it makes no arrays, and keeps or returns none.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import LoweringPass, register_pass
from numba.core.runtime.context import NRTContext
from numba.core.typed_passes import AnnotateTypes

njit: Any = numba.njit


class _NoEnvironment:
    """Stands for numba's code generator where it hands a function the Python objects that its wrapper needs."""

    def set_env(self, name: str, environment: object) -> None:
        """A part has no wrapper."""


class _Part(JITCodeLibrary):  # type: ignore[misc]
    """The code of one part, and of the parts that it calls, as numba writes it."""

    codegen = _NoEnvironment()

    def finalize(self) -> None:
        """Link the parts that this one calls; neither optimize nor translate them."""
        self._raise_if_finalized()
        for library in dict.fromkeys(self._linking_libraries):
            self._reload_init.update(library._reload_init)
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        self._finalize_dynamic_globals()
        self._finalized = True

    def get_pointer_to_function(self, name: str) -> int:
        """None: there is no machine code."""
        return 0


@register_pass(mutates_CFG=False, analysis_only=False)
class _AsPart(LoweringPass):  # type: ignore[misc]
    """Just before the lowering: the code goes into a `_Part` and counts no references."""

    _name = "as_part"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        context = state.targetctx  # of this function alone
        state.library = _Part(context.codegen(), state.func_id.func_qualname)
        context.nrt = NRTContext(context, True)  # fields of structures are still read through it
        context.enable_nrt = False
        return False


class _PartCompiler(CompilerBase):  # type: ignore[misc]
    """Numba's own passes, and `_AsPart` among them."""

    def define_pipelines(self) -> list[Any]:
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.add_pass_after(_AsPart, AnnotateTypes)
        passes.finalize()
        return [passes]


def compiled_part(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """
    Decorate a function that only compiled functions call, and that makes, keeps and returns no arrays.

    Parameters
    ----------
    **options
        Of `numba.njit`, those of the entry point.

    Returns
    -------
    callable
        The decorator.
    """
    decorate: Callable[[Callable[..., Any]], Any] = njit(
        no_cpython_wrapper=True, no_cfunc_wrapper=True, pipeline_class=_PartCompiler, **options
    )
    return decorate
