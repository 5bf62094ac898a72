"""Rows of three single precision numbers for compiled kernels: a place or a way in one register.

A value made by :func:`row_at` or :func:`wide_row_at` is x, y, z and one number more, which arithmetic carries along and
nothing reads; ``+ - *`` take it number by number, or with a float32. An index counts the elements of an array in C
order, whatever its shape, and is not checked.
"""

# mypy: disable-error-code="untyped-decorator, no-untyped-call, import-untyped, attr-defined"
# numba's extension points carry no types.
from __future__ import annotations

import operator
from typing import Any

from llvmlite import ir
from numba import extending, types
from numba.core.datamodel import PrimitiveModel, register_default

from agentface.deform.lanes import LANES
from agentface.deform.simd import Vector, element_of

_WIDTH = 4
_ROW, _PAIR = ir.VectorType(ir.FloatType(), _WIDTH), ir.VectorType(ir.FloatType(), 2)
_BLOCK, _LANES = ir.VectorType(ir.FloatType(), _WIDTH * LANES), Vector(types.float32)
_I32 = ir.IntType(32)
_THIRD = ir.Constant(_I32, 2)
# numba's annotations keep the compiler's own arguments in a function's signature.
_intrinsic: Any = extending.intrinsic


class RegisterRow(types.Type):
    """The type of a row, inside a kernel only."""

    def __init__(self) -> None:
        super().__init__(name=f"float32x{_WIDTH}")


@register_default(RegisterRow)
class _RowModel(PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _ROW)


_TYPE: Any = RegisterRow()


def _shuffled(builder: Any, row: Any, *order: int) -> Any:
    return builder.shuffle_vector(row, row, ir.Constant(ir.VectorType(_I32, len(order)), list(order)))


@_intrinsic
def row_at(typing: Any, array: Any, index: Any) -> Any:
    """The three numbers from ``index`` on of a float32 array."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        start = element_of(context, builder, signature, args)
        pair = builder.load(builder.bitcast(start, _PAIR.as_pointer()), align=4)
        third = builder.load(builder.gep(start, [_THIRD]))
        return builder.insert_element(_shuffled(builder, pair, 0, 1, 2, 3), third, _THIRD)

    return _TYPE(array, index), generate


@_intrinsic
def put_row(typing: Any, array: Any, index: Any, row: Any) -> Any:
    """Writes the three numbers of a row from ``index`` on of a float32 array."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        start = element_of(context, builder, signature, args)
        builder.store(_shuffled(builder, args[2], 0, 1), builder.bitcast(start, _PAIR.as_pointer()), align=4)
        builder.store(builder.extract_element(args[2], _THIRD), builder.gep(start, [_THIRD]))
        return context.get_dummy_value()

    return types.void(array, index, row), generate


@_intrinsic
def wide_row_at(typing: Any, array: Any, index: Any) -> Any:
    """The row at ``index`` of a float32 array whose rows take four numbers each."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        start = element_of(context, builder, signature, args)
        return builder.load(builder.bitcast(start, _ROW.as_pointer()), align=4)

    return _TYPE(array, index), generate


@_intrinsic
def put_wide_row(typing: Any, array: Any, index: Any, row: Any) -> Any:
    """Writes a row at ``index`` of a float32 array whose rows take four numbers each."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        start = element_of(context, builder, signature, args)
        builder.store(args[2], builder.bitcast(start, _ROW.as_pointer()), align=4)
        return context.get_dummy_value()

    return types.void(array, index, row), generate


@_intrinsic
def row_of(typing: Any, scalar: Any) -> Any:
    """A row of one float32 in all places."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        one = builder.insert_element(ir.Constant(_ROW, ir.Undefined), args[0], ir.Constant(_I32, 0))
        return _shuffled(builder, one, 0, 0, 0, 0)

    return _TYPE(types.float32), generate


@_intrinsic
def cross(typing: Any, a: Any, b: Any) -> Any:
    """The vector product."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        one, other = args
        turned, other_turned = (_shuffled(builder, row, 1, 2, 0, 3) for row in args)
        turned = builder.fsub(builder.fmul(one, other_turned), builder.fmul(turned, other))
        return _shuffled(builder, turned, 1, 2, 0, 3)

    return _TYPE(_TYPE, _TYPE), generate


@_intrinsic
def dot(typing: Any, a: Any, b: Any) -> Any:
    """The scalar product, a float32."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        products = builder.fmul(*args)
        x, y, z = (builder.extract_element(products, ir.Constant(_I32, axis)) for axis in range(3))
        return builder.fadd(builder.fadd(x, y), z)

    return types.float32(_TYPE, _TYPE), generate


def _column(axis: int) -> Any:
    @_intrinsic
    def column(typing: Any, rows: Any, index: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            start = element_of(context, builder, signature, args)
            block = builder.load(builder.bitcast(start, _BLOCK.as_pointer()), align=4)
            return _shuffled(builder, block, *range(axis, _WIDTH * LANES, _WIDTH))

        return _LANES(rows, index), generate

    return column


xs_of, ys_of, zs_of = (_column(axis) for axis in range(3))  # the vectors of LANES wide rows from an index on


def _put_columns(width: int) -> Any:
    @_intrinsic
    def put(typing: Any, rows: Any, index: Any, x: Any, y: Any, z: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            start = element_of(context, builder, signature, args)
            pairs = ir.Constant(ir.VectorType(_I32, 2 * LANES), list(range(2 * LANES)))
            flat, deep = (
                builder.shuffle_vector(args[2], args[3], pairs),
                builder.shuffle_vector(args[4], args[4], pairs),
            )
            order = [axis * LANES + lane for lane in range(LANES) for axis in range(width)]
            block = builder.shuffle_vector(flat, deep, ir.Constant(ir.VectorType(_I32, len(order)), order))
            builder.store(block, builder.bitcast(start, block.type.as_pointer()), align=4)
            return context.get_dummy_value()

        return types.void(rows, index, x, y, z), generate

    return put


# write three vectors as LANES rows from an index on, of three numbers each or wide
put_narrow_columns, put_columns = _put_columns(3), _put_columns(_WIDTH)


def _define(symbol: Any, name: str) -> None:
    """Lets a kernel write ``symbol`` for the instruction ``name`` on two rows, or a row and a float32."""

    @_intrinsic
    def operation(typing: Any, a: Any, b: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            return getattr(builder, name)(*args)

        return _TYPE(_TYPE, _TYPE), generate

    def operation_of_two(a: Any, b: Any) -> Any:
        return operation(a, b)

    @extending.overload(symbol, strict=False)
    def choose(a: Any, b: Any) -> Any:
        if isinstance(a, RegisterRow) and isinstance(b, RegisterRow):
            return operation_of_two
        if isinstance(a, RegisterRow) and b == types.float32:
            return lambda a, b: operation(a, row_of(b))
        if a == types.float32 and isinstance(b, RegisterRow):
            return lambda a, b: operation(row_of(a), b)
        return None


_define(operator.add, "fadd")
_define(operator.sub, "fsub")
_define(operator.mul, "fmul")
