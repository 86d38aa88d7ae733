"""
How numba is made to build parts (compiled_parts.py): by its own passes, with another library for what they write.

All of this is numba's inside, which may change with any version.
"""

from __future__ import annotations

from typing import Any

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import LoweringPass, register_pass
from numba.core.runtime.context import NRTContext
from numba.core.typed_passes import AnnotateTypes


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
            if hasattr(self, "_reload_init"):  # since numba 0.62
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


class PartCompiler(CompilerBase):  # type: ignore[misc]
    """Numba's own passes, and `_AsPart` among them."""

    def define_pipelines(self) -> list[Any]:
        """Return the passes in their order."""
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.add_pass_after(_AsPart, AnnotateTypes)
        passes.finalize()
        return [passes]
