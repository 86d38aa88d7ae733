"""
Compilation of parts (parts.py) by numba's own passes, with another library for the code that they write.

All of this uses numba's internals, which may change with any version.
"""

from __future__ import annotations

import operator
from functools import cache
from typing import Any

from llvmlite.binding import Linkage
from numba.core import types
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase, DefaultPassBuilder
from numba.core.compiler_machinery import LoweringPass, register_pass
from numba.core.runtime.context import NRTContext
from numba.core.typed_passes import AnnotateTypes, InlineOverloads, IRLegalization, NopythonRewrites
from numba.core.typing import Context
from numba.core.untyped_passes import DeadBranchPrune, InlineClosureLikes

# Passes that change nothing in a part: it has no expressions of whole arrays, inner functions, branches on None or
# functions that numba inlines before their types are known, and no variable whose end must be marked.
UNNEEDED_PASSES = {NopythonRewrites, InlineClosureLikes, DeadBranchPrune, InlineOverloads, IRLegalization}
PYTHON_OPERATORS = {each for each in vars(operator).values() if callable(each)}  # functions such as operator.add


class _NoEnvironment:
    """Substitute for numba's code generator, which hands a function the Python objects that its wrapper needs."""

    def set_env(self, name: str, environment: object) -> None:
        """Do nothing: no Python code calls a part, so that it needs no Python objects."""


class _PartLibrary(JITCodeLibrary):  # type: ignore[misc]
    """Code of one part (a function only called by compiled code), which entry points link, optimize and translate."""

    codegen = _NoEnvironment()
    _whole: Any = None

    def finalize(self) -> None:
        """Finish the part without linking what it calls, without optimizing and without translating it."""
        self._raise_if_finalized()
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == Linkage.external:
                function.linkage = Linkage.linkonce_odr
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        """Return the code of this part and of all parts that it calls, each once, for the linking of an entry point."""
        if self._whole is None:
            whole = self._final_module.clone()
            libraries = [self]
            for library in libraries:
                called = library._linking_libraries if isinstance(library, _PartLibrary) else ()
                libraries += [each for each in dict.fromkeys(called) if each not in libraries]
                if hasattr(self, "_reload_init"):  # since numba 0.62
                    self._reload_init.update(library._reload_init)
            for library in libraries[1:]:
                part = isinstance(library, _PartLibrary)
                whole.link_in(library._final_module if part else library._get_module_for_linking(), preserve=True)
            self._whole = whole
        return self._whole

    def get_pointer_to_function(self, name: str) -> int:
        """Return 0: there is no machine code."""
        return 0


@register_pass(mutates_CFG=False, analysis_only=False)
class _LowerAsPart(LoweringPass):  # type: ignore[misc]
    """Compiler pass that directs machine code into a `_PartLibrary` and switches off reference counting."""

    _name = "as_part"

    def __init__(self) -> None:
        """Make the pass."""
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        """Give the function a `_PartLibrary` and switch off reference counting; return False: its code is unchanged."""
        context = state.targetctx  # numba makes a context for every function
        state.library = _PartLibrary(context.codegen(), state.func_id.func_qualname)
        context.nrt = NRTContext(context, True)  # fields of structures are still read through this context
        context.enable_nrt = False
        return False


class _RememberedFunctions(Context):  # type: ignore[misc]
    """Numba's lookup of the types of functions, which remembers the answer for every function and its arguments."""

    def __init__(self, context: Context) -> None:
        """Share the contents of one of numba's contexts, and start without remembered answers."""
        self.__dict__ = context.__dict__
        self._known: dict[Any, Any] = {}

    def resolve_function_type(self, func: Any, args: Any, kws: Any) -> Any:
        """Return the signature of a function for these types of arguments, from memory where it is known."""
        if kws or not (isinstance(func, types.Function) or func in PYTHON_OPERATORS):
            return super().resolve_function_type(func, args, kws)
        if (func, args) not in self._known:
            self._known[func, args] = super().resolve_function_type(func, args, kws)
        return self._known[func, args]


remembered_functions = cache(_RememberedFunctions)  # returns one lookup for each of numba's contexts


class PartCompiler(CompilerBase):  # type: ignore[misc]
    """Compiler with numba's own passes except those that a part does not need, and with `_LowerAsPart`."""

    def compile_extra(self, func: Any) -> Any:
        """Compile a Python function as a part, with remembered lookups of types."""
        self.state.typingctx = remembered_functions(self.state.typingctx)
        return super().compile_extra(func)

    def define_pipelines(self) -> list[Any]:
        """Return the passes by which numba compiles a part, in their order."""
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.passes = [each for each in passes.passes if each[0] not in UNNEEDED_PASSES]
        passes.add_pass_after(_LowerAsPart, AnnotateTypes)
        passes.finalize()
        return [passes]
