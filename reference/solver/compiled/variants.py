"""Functions of compiled code with two variants, of which only the one that the scene's system needs is compiled."""

from __future__ import annotations

from collections.abc import Callable
from inspect import signature
from typing import Any

from numba import types
from numba.extending import lower_builtin, type_callable


def choose_variant(field: str, without: Any, present: Any) -> Callable[..., Any]:
    """Return a function whose first argument is a System: `without` where its `field` is None, else `present`."""

    def call(system: Any, *numbers: Any) -> Any:
        """Call the variant that fits the system; Python runs this, compiled code uses `_type` and `_lower` instead."""
        return (without if getattr(system, field) is None else present)(system, *numbers)

    def choose(system: Any) -> Any:
        """Return the variant that fits a system, given numba's type of this system."""
        return types.Dispatcher(without if system.field_dict[field] == types.none else present)

    @type_callable(call)
    def _type(context: Any) -> Callable[..., Any]:
        """Return the function that tells numba the signature of a call of the variant."""

        def resolve(*kinds: Any) -> Any:
            """Return the signature of a call with arguments of these types."""
            return choose(kinds[0]).get_call_type(context, kinds, {})

        resolve.pysig = signature(without.py_func)  # type: ignore[attr-defined]  # where numba looks for it
        return resolve

    @lower_builtin(call, types.VarArg(types.Any))
    def _lower(context: Any, builder: Any, call: Any, arguments: Any) -> Any:
        """Generate machine code that calls the variant that fits the system."""
        function = context.get_function(choose(call.args[0]), call)
        context.add_linking_libs(getattr(function, "libs", ()))
        return function(builder, arguments)

    return call
