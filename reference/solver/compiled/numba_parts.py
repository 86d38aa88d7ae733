"""
Compilation by numba of parts (functions that only compiled code calls, parts.py) without machine code of their own.

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

# Compiler passes of numba that change nothing in a part (a function that only compiled code calls). A part has no
# expressions of whole arrays, inner functions, branches on None, or functions to inline before types are known, and
# needs no marks where a variable ends.
UNNEEDED_PASSES = {NopythonRewrites, InlineClosureLikes, DeadBranchPrune, InlineOverloads, IRLegalization}
PYTHON_OPERATORS = {each for each in vars(operator).values() if callable(each)}  # Python's operators as functions


class _NoEnvironment:
    """Stand-in for numba's code generator, which would store the Python objects that a function's wrapper needs."""

    def set_env(self, name: str, environment: object) -> None:
        """Do nothing: a part (function for compiled callers only) needs no Python objects: Python never calls it."""


class _PartLibrary(JITCodeLibrary):  # type: ignore[misc]
    """Code of one part (a function that only compiled code calls), which becomes machine code only with its caller."""

    codegen = _NoEnvironment()
    _whole: Any = None

    def finalize(self) -> None:
        """Finish a part (a function that only compiled code calls) without the linking and optimization of numba, which
        its callers do. The linkage makes the linker keep one copy where several callers bring the same part along."""
        self._raise_if_finalized()
        for function in self._final_module.functions:
            if not function.is_declaration and function.linkage == Linkage.external:
                function.linkage = Linkage.linkonce_odr
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        """Return the code of this part and of all parts that it calls, each of them once, for linking into a caller."""
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
        """Return 0, as a part (function that only compiled code calls) has no machine code of its own."""
        return 0


@register_pass(mutates_CFG=False, analysis_only=False)
class _LowerAsPart(LoweringPass):  # type: ignore[misc]
    """Compiler pass that puts code in a `_PartLibrary`, to be linked into a caller; it counts no array references."""

    _name = "as_part"

    def __init__(self) -> None:
        """Initialize the compiler pass; numba demands a constructor without arguments."""
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        """Generate code into a `_PartLibrary`, without reference counts; return False: numba's program is unchanged."""
        context = state.targetctx  # numba makes one for every function, so that it may be changed here
        state.library = _PartLibrary(context.codegen(), state.func_id.func_qualname)
        context.nrt = NRTContext(context, True)  # code that reads fields of structures still needs this object
        context.enable_nrt = False
        return False


class _RememberedFunctions(Context):  # type: ignore[misc]
    """Numba's lookup of function signatures, with a memory of the result for each function and argument types."""

    def __init__(self, context: Context) -> None:
        """Share the contents of one of numba's lookups, without a copy, and start with an empty memory."""
        self.__dict__ = context.__dict__
        self._known: dict[Any, Any] = {}

    def resolve_function_type(self, func: Any, args: Any, kws: Any) -> Any:
        """Return the signature of a function for arguments of these types, from memory if it was found before."""
        if kws or not (isinstance(func, types.Function) or func in PYTHON_OPERATORS):
            return super().resolve_function_type(func, args, kws)
        if (func, args) not in self._known:
            self._known[func, args] = super().resolve_function_type(func, args, kws)
        return self._known[func, args]


remembered_functions = cache(_RememberedFunctions)  # one `_RememberedFunctions` for each typing context of numba


class PartCompiler(CompilerBase):  # type: ignore[misc]
    """Compiler of functions for compiled callers only: numba's passes without needless ones, plus `_LowerAsPart`."""

    def compile_extra(self, func: Any) -> Any:
        """Compile a function that only compiled code will call; look up signatures of called functions only once."""
        self.state.typingctx = remembered_functions(self.state.typingctx)
        return super().compile_extra(func)

    def define_pipelines(self) -> list[Any]:
        """Return the list of pass managers that numba expects: one, with the passes that compile a part, in order."""
        passes = DefaultPassBuilder.define_nopython_pipeline(self.state)
        passes.passes = [each for each in passes.passes if each[0] not in UNNEEDED_PASSES]
        passes.add_pass_after(_LowerAsPart, AnnotateTypes)
        passes.finalize()
        return [passes]
