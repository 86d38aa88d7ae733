"""
Eight numbers as one value of compiled code, a row: the processor computes with all of them at once.

A row has one number for each stage of a step, and one without a meaning; or the real and the imaginary parts of a
step's channels (collocation.py). The last axis of the arrays in `Workspace` has room for it.

    values = row(work.a, (0, axis))             read
    put(work.stage, POSITION, x + h * values)   write
    values[k]                                   one number

`+ - * /`, negation, abs, min, max and `math`'s sqrt, exp, expm1 and log do with every number what they do with a float,
to the same bits. So one function serves both an instant and all stages. LLVM does not vectorize loops over stages by
itself, since their arrays might overlap: docs/decisions/0014-rows-of-stages.md.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable
from typing import Any, TypeAlias

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, lower_builtin, models, register_model, type_callable
from numpy.typing import NDArray

from reference.solver.collocation import ROW_LENGTH, STAGES
from reference.solver.compiled import compiled

Row: TypeAlias = Any  # a row, which exists in compiled code alone
Number: TypeAlias = Any  # a float, or a row of floats

_VECTOR = ir.VectorType(ir.DoubleType(), ROW_LENGTH)  # LLVM's type of a row
_ALIGNMENT = 8  # bytes, the alignment that numpy's arrays guarantee
Lower: TypeAlias = Callable[[Any, Any, Any, Any], Any]  # a function that numba asks for the code of a call


class _RowType(types.Type):  # type: ignore[misc]
    """Numba's type of a row."""

    def __init__(self) -> None:
        """Give the type its name."""
        super().__init__(name="Row")


@register_model(_RowType)
class _RowModel(models.PrimitiveModel):  # type: ignore[misc]
    """Type of a row in LLVM."""

    def __init__(self, manager: Any, kind: Any) -> None:
        """Set LLVM's type of a row."""
        super().__init__(manager, kind, _VECTOR)


_ROW = _RowType()  # numba's type of every row


def _index(k: int) -> Any:
    """Return LLVM's constant for the place k in a row."""
    return ir.IntType(32)(k)


def _shuffle(builder: Any, values: Any, places: list[int]) -> Any:
    """Write code for a row of the numbers at these places of another row."""
    return builder.shuffle_vector(values, values, ir.Constant(ir.VectorType(ir.IntType(32), ROW_LENGTH), places))


def _broadcast(builder: Any, number: Any) -> Any:
    """Write code for a row with the same number in all places."""
    first = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), number, _index(0))
    return _shuffle(builder, first, [0] * ROW_LENGTH)


def _broadcast_to_rows(builder: Any, numbers: Iterable[Any], kinds: Iterable[Any]) -> list[Any]:
    """Write code that makes a row of every number that is not one yet."""
    return [number if kind == _ROW else _broadcast(builder, number) for number, kind in zip(numbers, kinds)]


def _define_pair(operation: Any, instruction: Callable[[Any, Any, Any], Any]) -> None:
    """Define an operation of two rows, or of a row and a float, whose result is a row."""

    def typer(context: Any) -> Callable[..., Any]:
        """Return the function that tells numba the type of the result."""

        def kind(left: Any, right: Any) -> Any:
            """Return the type of the result for two operands; None if they are no row with a row or a float."""
            return _ROW if _ROW in (left, right) and {left, right} <= {_ROW, types.float64} else None

        return kind

    def lower_call(context: Any, builder: Any, signature: Any, numbers: Any) -> Any:
        """Write machine code that applies an LLVM instruction to two operands, element by element of their rows."""
        return instruction(builder, *_broadcast_to_rows(builder, numbers, signature.args))

    type_callable(operation)(typer)
    for kinds in ((_ROW, _ROW), (_ROW, types.float64), (types.float64, _ROW)):
        lower_builtin(operation, *kinds)(lower_call)


def _define_single(operation: Any, lower_call: Lower) -> None:
    """Define a function of one row whose result is a row."""
    type_callable(operation)(lambda context: lambda number: _ROW if number == _ROW else None)
    lower_builtin(operation, _ROW)(lower_call)


def _lower_by_instruction(name: str) -> Lower:
    """Return code that calls one instruction of LLVM for a whole row."""

    def lower_call(context: Any, builder: Any, signature: Any, numbers: Any) -> Any:
        """Write the LLVM call of the instruction, and return its result."""
        kind = ir.FunctionType(_VECTOR, [_VECTOR])
        return builder.call(cgutils.get_or_insert_function(builder.module, kind, f"{name}.v{ROW_LENGTH}f64"), numbers)

    return lower_call


def _lower_one_by_one(operation: Any) -> Lower:
    """Return code that applies a function to the number at every stage; the last place of the row becomes 0."""
    # exp, expm1 and log are functions of the C library for one float: called for each number, they give the same bits
    # as at an instant.

    def lower_call(context: Any, builder: Any, signature: Any, numbers: Any) -> Any:
        """Write code that calls the function for every number of a row."""
        function = context.get_function(operation, types.float64(types.float64))
        results = ir.Constant(_VECTOR, [0.0] * ROW_LENGTH)
        for place in map(_index, range(STAGES)):
            result = function(builder, [builder.extract_element(numbers[0], place)])
            results = builder.insert_element(results, result, place)
        return results

    return lower_call


def _select_by(relation: str) -> Callable[[Any, Any, Any], Any]:
    """Return code that selects the smaller or larger numbers of two rows, by a relation of LLVM."""

    def lower_call(builder: Any, left: Any, right: Any) -> Any:
        """Write code that selects from each pair of numbers of two rows."""
        return builder.select(builder.fcmp_ordered(relation, left, right), left, right)

    return lower_call


for _operations, _instruction in (
    ((operator.add, operator.iadd), ir.IRBuilder.fadd),
    ((operator.sub, operator.isub), ir.IRBuilder.fsub),
    ((operator.mul, operator.imul), ir.IRBuilder.fmul),
    ((operator.truediv, operator.itruediv), ir.IRBuilder.fdiv),
    ((max,), _select_by(">")),
    ((min,), _select_by("<")),
):
    for _operation in _operations:
        _define_pair(_operation, _instruction)
_define_single(operator.neg, lambda context, builder, signature, numbers: builder.fneg(numbers[0]))
_define_single(abs, _lower_by_instruction("llvm.fabs"))
_define_single(math.sqrt, _lower_by_instruction("llvm.sqrt"))
for _function in (math.exp, math.expm1, math.log):
    _define_single(_function, _lower_one_by_one(_function))


@type_callable(operator.getitem)
def _type_getitem(context: Any) -> Callable[..., Any]:
    """Tell numba that row[k] is a float for a whole number k."""
    return lambda values, k: types.float64 if values == _ROW and isinstance(k, types.Integer) else None


@lower_builtin(operator.getitem, _ROW, types.Integer)
def _lower_getitem(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    """Write code that reads one number of a row."""
    return builder.extract_element(*arguments)


def _address(context: Any, builder: Any, kinds: Any, arguments: Any) -> Any:
    """Write code for the address of the row at a place of an array: an index, or a tuple of them."""
    array = context.make_array(kinds[0])(context, builder, arguments[0])
    several = isinstance(kinds[1], types.BaseTuple)
    place = cgutils.unpack_tuple(builder, arguments[1]) if several else [arguments[1]]
    indices = [
        context.cast(builder, index, kind, types.intp)
        for index, kind in zip(place, kinds[1].types if several else [kinds[1]])
    ]
    first = cgutils.get_item_pointer(context, builder, kinds[0], array, [*indices, context.get_constant(types.intp, 0)])
    return builder.bitcast(first, _VECTOR.as_pointer())


@intrinsic
def row(context: Any, array: Any, place: Any) -> Any:
    """Return the row at a place of an array: an index, or a tuple of them, for all axes but the last."""

    def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        """Write code that reads a row from an array."""
        return builder.load(_address(context, builder, signature.args, arguments), align=_ALIGNMENT)

    return _ROW(array, place), lower_call


@intrinsic
def put(context: Any, array: Any, place: Any, values: Any) -> Any:
    """Write a row, or a float in all places of it, to a place of an array."""

    def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        """Write code that stores a row in an array."""
        (written,) = _broadcast_to_rows(builder, arguments[2:], signature.args[2:])
        builder.store(written, _address(context, builder, signature.args, arguments), align=_ALIGNMENT)
        return context.get_dummy_value()

    return types.void(array, place, values), lower_call


@intrinsic
def broadcast_like(context: Any, number: Any, pattern: Any) -> Any:
    """Return a float unchanged, or a row with it in all places if `pattern` is a row."""

    def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        """Write code that makes a row of a float where a row is asked for."""
        return _broadcast(builder, arguments[0]) if signature.return_type == _ROW else arguments[0]

    return pattern(types.float64, pattern), lower_call


@intrinsic
def where_positive(context: Any, number: Any, positive: Any, otherwise: Any) -> Any:
    """Return one value where the number is above zero, the other elsewhere; all three rows, or all floats."""

    def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        """Write code that selects by the sign of each number."""
        zero = ir.Constant(arguments[0].type, [0.0] * ROW_LENGTH if signature.return_type == _ROW else 0.0)
        return builder.select(builder.fcmp_ordered(">", arguments[0], zero), *arguments[1:])

    return number(number, number, number), lower_call


def _reduce_by(relation: str) -> Callable[..., Any]:
    """Return a function that finds the largest or smallest number of a row's stages, and returns a float unchanged."""
    # Three comparisons of a row with a rearranged copy of itself leave the extreme number in the first place. The last
    # place of a row has no meaning: the last stage is compared in its stead. Where a number is NaN, any of the numbers
    # may be returned: an ordered comparison with NaN is false.

    def reduce(context: Any, values: Any) -> Any:
        """Return the signature of the function, and the writer of its code, as numba asks for them."""

        def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            """Write code that halves a row three times, down to its largest or smallest number."""
            if signature.args[0] != _ROW:
                return arguments[0]
            best, width = arguments[0], ROW_LENGTH
            while width > 1:
                width //= 2
                places = [min(k + width, STAGES - 1) if k < width else k for k in range(ROW_LENGTH)]
                other = _shuffle(builder, best, places)
                best = builder.select(builder.fcmp_ordered(relation, other, best), other, best)
            return builder.extract_element(best, _index(0))

        return types.float64(values), lower_call

    return reduce


row_minimum = intrinsic(_reduce_by("<"))  # smallest number at the stages of a row; of a float, itself
row_maximum = intrinsic(_reduce_by(">"))  # largest number at the stages of a row; of a float, itself


@intrinsic
def is_finite(context: Any, values: Any) -> Any:
    """Return True if the numbers at the stages are finite."""

    def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        """Write code that tests all stages at once."""
        bits = ir.IntType(ROW_LENGTH)
        known = builder.fcmp_ordered("ord", *[builder.fsub(arguments[0], arguments[0])] * 2)
        never_looked_at = bits(1 << ROW_LENGTH - 1)
        return builder.icmp_signed("==", builder.or_(builder.bitcast(known, bits), never_looked_at), bits(-1))

    return types.boolean(values), lower_call


@compiled
def combine_columns(columns: NDArray[np.float64], values: Row) -> Row:
    """Return the sum of the columns of a matrix, given as rows (M, ROW_LENGTH), each times its number in `values`."""
    total = row(columns, 0) * values[0]
    for m in range(1, columns.shape[0]):
        total += row(columns, m) * values[m]
    return total
