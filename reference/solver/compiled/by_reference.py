"""
Types, for the compiler numba, of structures that compiled code passes by reference.

Numba can do this itself (`structref.register`). It spells out all fields of a structure in the name of every function
with such an argument, and again wherever a field is read: thousands of characters each time, to write and to read. Its
constructors take every field as an argument.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

from numba import typeof
from numba.core import types
from numba.core.datamodel import default_manager
from numba.core.datamodel.models import StructRefModel
from numba.core.extending import infer_getattr, lower_getattr_generic, lower_setattr_generic
from numba.core.imputils import impl_ret_borrowed
from numba.core.typing.templates import AttributeTemplate
from numba.experimental import structref
from numba.extending import intrinsic


class ByReference(types.StructRef):  # type: ignore[misc, name-defined]
    """Type, for the compiler numba, of a structure passed by reference; each subclass is one kind of structure."""

    def __init_subclass__(cls) -> None:
        """Tell numba how the data of a structure of the subclass lie in memory."""
        default_manager.register(cls, StructRefModel)

    @property
    def mangling_args(self) -> tuple[str, tuple[()]]:
        """Name of this type within names of compiled functions: it tells which fields are None (variants.py)."""
        return "_".join([self._typename, *(name for name, kind in self._fields if kind == types.none)]), ()

    @cached_property
    def field_dict(self) -> dict[str, Any]:
        """Types of all fields of the structure, by name."""
        return dict(self._fields)

    @cached_property
    def places(self) -> dict[str, tuple[int, Any]]:
        """By field name: offset, in bytes, in the structure, and type of a pointer; filled as `pointer` needs it."""
        return {}

    def pointer(self, context: Any, builder: Any, reference: Any, name: str) -> Any:
        """Generate machine code that computes the pointer to a structure's field, and return this pointer."""
        if name not in self.places:
            model = context.data_model_manager[self.get_data_type()]
            whole, position = model.get_value_type(), model.get_field_position(name)
            offset = whole.get_element_offset(context.target_data, position)
            self.places[name] = offset, whole.elements[position].as_pointer()
        offset, kind = self.places[name]
        data = context.nrt.meminfo_data(builder, builder.extract_value(reference, 0))
        place = builder.gep(data, [context.get_constant(types.intp, offset)], inbounds=True)
        return builder.bitcast(place, kind)


@infer_getattr
class _Fields(AttributeTemplate):  # type: ignore[misc]
    """Lookup by which the compiler numba finds the type of a structure's field."""

    key = ByReference

    def generic_resolve(self, kind: ByReference, name: str) -> Any:
        """Return the type of the structure's field with this name; None if there is no such field."""
        return kind.field_dict.get(name)


@lower_getattr_generic(ByReference)
def _read(context: Any, builder: Any, kind: ByReference, reference: Any, name: str) -> Any:
    """Generate machine code that reads a structure's field, without counting a new reference to it."""
    value = builder.load(kind.pointer(context, builder, reference, name))
    return impl_ret_borrowed(context, builder, kind.field_dict[name], value)


@lower_setattr_generic(ByReference)
def _write(context: Any, builder: Any, signature: Any, arguments: Any, name: str) -> None:
    """Generate machine code that sets a structure's field, and counts the references to an array in it."""
    kind, given = signature.args
    reference, value = arguments
    field = kind.field_dict[name]
    pointer = kind.pointer(context, builder, reference, name)
    new, old = context.cast(builder, value, given, field), builder.load(pointer)
    context.nrt.incref(builder, field, new)
    context.nrt.decref(builder, field, old)
    builder.store(new, pointer)


def _allocate(context: Any, builder: Any, kind: ByReference) -> Any:
    """Generate machine code that allocates a structure, its fields not yet set."""
    _, lower = structref.new._defn(context.typing_context, types.TypeRef(kind))
    return lower(context, builder, None, None)


def structure_from_tuple(kind: type[ByReference]) -> Any:
    """Return a function, for compiled code, that copies a named tuple into a new structure of this type."""

    @intrinsic
    def construct(context: Any, values: Any) -> Any:
        """Return the signature of the function, and the generator of its machine code, as numba demands it."""
        structure = kind(list(zip(values.fields, values.types)))

        def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            """Generate machine code that allocates the structure and copies the fields of the tuple into it."""
            reference = _allocate(context, builder, structure)
            for k, (name, field) in enumerate(structure._fields):
                value = builder.extract_value(arguments[0], k)
                context.nrt.incref(builder, field, value)
                builder.store(value, structure.pointer(context, builder, reference, name))
            return reference

        return structure(values), lower_call

    return construct


def empty_structure(kind: type[ByReference], fields: Mapping[str, Any]) -> Any:
    """Return a function, for compiled code, that makes a structure of this type with these fields, all bits zero."""
    structure = kind([(name, typeof(value)) for name, value in fields.items()])

    @intrinsic
    def construct(context: Any) -> Any:
        """Return the signature of the function, and the generator of its machine code, as numba demands it."""

        def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            """Generate machine code that allocates the structure."""
            return _allocate(context, builder, structure)

        return structure(), lower_call

    return construct
