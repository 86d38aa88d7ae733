"""
Rows: values of compiled code that hold eight numbers each, with which the processor computes at once.

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

Row: TypeAlias = Any  # type hint of a row: eight floats, as one per stage of a step and a spare; only in compiled code
Number: TypeAlias = Any  # a float, or a row of floats

_VECTOR = ir.VectorType(ir.DoubleType(), ROW_LENGTH)  # type of a row in the machine code: a vector of doubles
_ALIGNMENT = 8  # bytes: the address of a row in an array is a multiple of it, and of nothing larger for certain
Lower: TypeAlias = Callable[[Any, Any, Any, Any], Any]  # type hint of a function that generates a call's machine code


class _RowType(types.Type):  # type: ignore[misc]
    """Type, for the compiler numba, of a row: eight floats with which the processor computes at once."""

    def __init__(self) -> None:
        """Set the name of the type."""
        super().__init__(name="Row")


@register_model(_RowType)
class _RowModel(models.PrimitiveModel):  # type: ignore[misc]
    """Model that tells numba how a row (eight floats, computed at once) is stored: as a vector of machine code."""

    def __init__(self, manager: Any, kind: Any) -> None:
        """Set the machine code's type of a row: a vector of eight floats."""
        super().__init__(manager, kind, _VECTOR)


_ROW = _RowType()  # the one type, for the compiler numba, that all rows have


def _index(k: int) -> Any:
    """Return place k of a row as a constant of machine code."""
    return ir.IntType(32)(k)


def _shuffle(builder: Any, values: Any, places: list[int]) -> Any:
    """Generate machine code for a new row with the numbers at `places` of another row."""
    return builder.shuffle_vector(values, values, ir.Constant(ir.VectorType(ir.IntType(32), ROW_LENGTH), places))


def _broadcast(builder: Any, number: Any) -> Any:
    """Generate machine code for a row that has the same number in all places."""
    first = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), number, _index(0))
    return _shuffle(builder, first, [0] * ROW_LENGTH)


def _broadcast_to_rows(builder: Any, numbers: Iterable[Any], kinds: Iterable[Any]) -> list[Any]:
    """Generate machine code that makes rows of those operands that are floats."""
    return [number if kind == _ROW else _broadcast(builder, number) for number, kind in zip(numbers, kinds)]


def _define_pair(operation: Any, instruction: Callable[[Any, Any, Any], Any]) -> None:
    """Teach numba an operation on two rows, or on a row and a float, whose result is a row.

    `instruction` generates its machine code from a builder and two rows.
    """

    def typer(context: Any) -> Callable[..., Any]:
        """Return the function that tells numba the type of the operation's result."""

        def kind(left: Any, right: Any) -> Any:
            """Return the type of a row if the operands are two rows, or a row and a float; else None."""
            return _ROW if _ROW in (left, right) and {left, right} <= {_ROW, types.float64} else None

        return kind

    def lower_call(context: Any, builder: Any, signature: Any, numbers: Any) -> Any:
        """Generate machine code that applies the instruction to two operands, number by number of their rows."""
        return instruction(builder, *_broadcast_to_rows(builder, numbers, signature.args))

    type_callable(operation)(typer)
    for kinds in ((_ROW, _ROW), (_ROW, types.float64), (types.float64, _ROW)):
        lower_builtin(operation, *kinds)(lower_call)


def _define_single(operation: Any, lower_call: Lower) -> None:
    """Teach numba a function of one row whose result is a row; lower_call generates its machine code."""

    def typer(context: Any) -> Callable[..., Any]:
        """Return the function that tells numba the type of the result: a row of a row."""
        return lambda number: _ROW if number == _ROW else None

    type_callable(operation)(typer)
    lower_builtin(operation, _ROW)(lower_call)


def _lower_by_instruction(name: str) -> Lower:
    """Return a generator of machine code that calls the named instruction for a whole row."""

    def lower_call(context: Any, builder: Any, signature: Any, numbers: Any) -> Any:
        """Generate the call of the instruction, and return its result."""
        kind = ir.FunctionType(_VECTOR, [_VECTOR])
        return builder.call(cgutils.get_or_insert_function(builder.module, kind, f"{name}.v{ROW_LENGTH}f64"), numbers)

    return lower_call


def _lower_one_by_one(operation: Any) -> Lower:
    """Return a generator of machine code that applies a function to each stage's number; the last place becomes 0."""
    # exp, expm1 and log are functions of the C library for one float: called for each number, they give the same bits
    # as in the calculation for a single instant, which uses floats.

    def lower_call(context: Any, builder: Any, signature: Any, numbers: Any) -> Any:
        """Generate machine code that calls the function for every number of a row."""
        function = context.get_function(operation, types.float64(types.float64))
        results = ir.Constant(_VECTOR, [0.0] * ROW_LENGTH)
        for place in map(_index, range(STAGES)):
            result = function(builder, [builder.extract_element(numbers[0], place)])
            results = builder.insert_element(results, result, place)
        return results

    return lower_call


def _lower_negation(context: Any, builder: Any, signature: Any, numbers: Any) -> Any:
    """Generate machine code that changes the sign of every number of a row."""
    return builder.fneg(numbers[0])


def _select_by(relation: str) -> Callable[[Any, Any, Any], Any]:
    """Return a generator of machine code that selects the smaller ("<") or larger (">") numbers of two rows."""

    def lower_call(builder: Any, left: Any, right: Any) -> Any:
        """Generate machine code that selects one number from each pair of numbers of two rows."""
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
_define_single(operator.neg, _lower_negation)
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
    """Generate machine code for row[k], which reads one number of a row."""
    return builder.extract_element(*arguments)


def _address(context: Any, builder: Any, kinds: Any, arguments: Any) -> Any:
    """Generate machine code for the address of the row at a place (an index, or a tuple of them) of an array."""
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
    """Return the row that an array holds at `place`: an index, or a tuple of them, for all axes but the last."""

    def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        """Generate machine code that reads a row from an array."""
        return builder.load(_address(context, builder, signature.args, arguments), align=_ALIGNMENT)

    return _ROW(array, place), lower_call


@intrinsic
def put(context: Any, array: Any, place: Any, values: Any) -> Any:
    """Write a row, or a float eight times, into an array at `place`: an index, or a tuple of them."""

    def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        """Generate machine code that stores a row in an array."""
        (written,) = _broadcast_to_rows(builder, arguments[2:], signature.args[2:])
        builder.store(written, _address(context, builder, signature.args, arguments), align=_ALIGNMENT)
        return context.get_dummy_value()

    return types.void(array, place, values), lower_call


@intrinsic
def broadcast_like(context: Any, number: Any, pattern: Any) -> Any:
    """Return a row that has the float `number` in all places if `pattern` is a row; else the float itself."""

    def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        """Generate machine code that makes a row of a float if the result must be a row."""
        return _broadcast(builder, arguments[0]) if signature.return_type == _ROW else arguments[0]

    return pattern(types.float64, pattern), lower_call


@intrinsic
def where_positive(context: Any, number: Any, positive: Any, otherwise: Any) -> Any:
    """Return `positive` where `number` > 0, else `otherwise`; all three are rows (place by place), or all floats."""

    def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        """Generate machine code that selects by the sign of each number."""
        zero = ir.Constant(arguments[0].type, [0.0] * ROW_LENGTH if signature.return_type == _ROW else 0.0)
        return builder.select(builder.fcmp_ordered(">", arguments[0], zero), *arguments[1:])

    return number(number, number, number), lower_call


def _reduce_by(relation: str) -> Callable[..., Any]:
    """Return a function, for numba's `intrinsic`, that finds the smallest ("<") or largest (">") stage number of a row.

    Of a float, it returns the float itself.
    """
    # Three comparisons of a row with a rearranged copy of itself leave the extreme number in the first place. The last
    # place of a row has no meaning: the last stage is compared in its stead. Where a number is NaN, any of the numbers
    # may be returned: an ordered comparison with NaN is false.

    def reduce(context: Any, values: Any) -> Any:
        """Return the function's signature, and the generator of its machine code, as numba demands it."""

        def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            """Generate machine code that compares halves of a row three times, down to its extreme number."""
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
    """Return True if the numbers of a row at all stages are finite."""

    def lower_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        """Generate machine code that tests all stages together."""
        bits = ir.IntType(ROW_LENGTH)
        known = builder.fcmp_ordered("ord", *[builder.fsub(arguments[0], arguments[0])] * 2)
        never_looked_at = bits(1 << ROW_LENGTH - 1)
        return builder.icmp_signed("==", builder.or_(builder.bitcast(known, bits), never_looked_at), bits(-1))

    return types.boolean(values), lower_call


@compiled
def combine_columns(columns: NDArray[np.float64], values: Row) -> Row:
    """Return the product of a matrix, given by its columns (STAGES or fewer, ROW_LENGTH), with the vector `values`."""
    total = row(columns, 0) * values[0]
    for m in range(1, columns.shape[0]):
        total += row(columns, m) * values[m]
    return total
