"""Vectors of single precision numbers for compiled kernels: arithmetic on LANES lanes, held in registers.

numba turns a loop into vector instructions only where it can prove much, and keeps sums in memory between two loops.
A value made by :func:`load` or :func:`splat` is LANES numbers that ``+ - *`` take lane by lane. An index counts the
elements of an array in C order, whatever its shape, and is not checked.
"""

# mypy: disable-error-code="untyped-decorator, no-untyped-call, import-untyped, attr-defined"
# numba's extension points carry no types.
from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import extending, types
from numba.core import cgutils
from numba.core.datamodel import PrimitiveModel, register_default

from agentface.deform.lanes import LANES

_VECTOR = ir.VectorType(ir.FloatType(), LANES)
_I32 = ir.IntType(32)
# numba's annotations keep the compiler's own arguments in a function's signature.
_intrinsic: Any = extending.intrinsic


class Vector(types.Type):
    """The type of a vector, inside a kernel only."""

    def __init__(self) -> None:
        super().__init__(name=f"float32x{LANES}")


@register_default(Vector)
class _VectorModel(PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, _VECTOR)


_TYPE: Any = Vector()


def element_of(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Where in memory the element of an array stands, the first two of ``args``: for intrinsics."""
    array = context.make_array(signature.args[0])(context, builder, args[0])
    index = context.cast(builder, args[1], signature.args[1], types.intp)
    return builder.gep(array.data, [index])


def _pointer(builder: Any, start: Any) -> Any:
    return builder.bitcast(start, _VECTOR.as_pointer())


def _call(builder: Any, name: str, result: Any, vector: Any) -> Any:
    declare: Any = cgutils.get_or_insert_function
    function = declare(builder.module, ir.FunctionType(result, [_VECTOR]), f"{name}.v{LANES}f32")
    return builder.call(function, [vector])


@_intrinsic
def load(typing: Any, array: Any, index: Any) -> Any:
    """The vector at ``index`` of a float32 array."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.load(_pointer(builder, element_of(context, builder, signature, args)), align=4)

    return _TYPE(array, index), generate


@_intrinsic
def store(typing: Any, array: Any, index: Any, vector: Any) -> Any:
    """Writes a vector at ``index`` of a float32 array."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        builder.store(args[2], _pointer(builder, element_of(context, builder, signature, args)), align=4)
        return context.get_dummy_value()

    return types.void(array, index, vector), generate


@_intrinsic
def gather(typing: Any, array: Any, indices: Any, at: Any, offset: Any) -> Any:
    """The elements ``indices[at + lane] + offset`` of a float32 array; ``indices`` are int32."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        of_array, of_indices, of_at, of_offset = signature.args
        data = context.make_array(of_array)(context, builder, args[0]).data
        places = context.make_array(of_indices)(context, builder, args[1]).data
        start, more = (
            context.cast(builder, value, kind, types.intp) for value, kind in ((args[2], of_at), (args[3], of_offset))
        )
        start, data = builder.gep(places, [start]), builder.gep(data, [more])
        vector = ir.Constant(_VECTOR, ir.Undefined)
        for lane in range(LANES):
            index = builder.sext(builder.load(builder.gep(start, [_I32(lane)])), ir.IntType(64))
            vector = builder.insert_element(vector, builder.load(builder.gep(data, [index])), _I32(lane))
        return vector

    return _TYPE(array, indices, at, offset), generate


@_intrinsic
def splat(typing: Any, scalar: Any) -> Any:
    """A float32 in every lane."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        empty = ir.Constant(_VECTOR, ir.Undefined)
        one = builder.insert_element(empty, args[0], ir.Constant(_I32, 0))
        return builder.shuffle_vector(one, empty, ir.Constant(ir.VectorType(_I32, LANES), [0] * LANES))

    return _TYPE(types.float32), generate


@_intrinsic
def inverse_root(typing: Any, vector: Any) -> Any:
    """1 / sqrt of every lane."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fdiv(ir.Constant(_VECTOR, [1.0] * LANES), _call(builder, "llvm.sqrt", _VECTOR, args[0]))

    return _TYPE(_TYPE), generate


@_intrinsic
def largest(typing: Any, vector: Any) -> Any:
    """The largest lane, a float32."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return _call(builder, "llvm.vector.reduce.fmax", ir.FloatType(), args[0])

    return types.float32(_TYPE), generate


def _select(builder: Any, comparison: str, a: Any, b: Any) -> Any:
    return builder.select(builder.fcmp_ordered(comparison, a, b), a, b)


def _lane_by_lane(make: Callable[[Any, Any, Any], Any]) -> Any:
    """An operation on two vectors; ``make`` gets the builder and both."""

    @_intrinsic
    def operation(typing: Any, a: Any, b: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            return make(builder, *args)

        return _TYPE(_TYPE, _TYPE), generate

    return operation


larger = _lane_by_lane(lambda builder, a, b: _select(builder, ">", a, b))


def _chosen(builder: Any, condition: Any, a: Any, b: Any) -> Any:
    return builder.select(builder.fcmp_ordered(">=", condition, ir.Constant(_VECTOR, [0.0] * LANES)), a, b)


@_intrinsic
def choose(typing: Any, condition: Any, a: Any, b: Any) -> Any:
    """``a`` where ``condition`` is not negative, else ``b``."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return _chosen(builder, *args)

    return _TYPE(_TYPE, _TYPE, _TYPE), generate


where_positive = _lane_by_lane(lambda builder, a, b: _chosen(builder, a, b, ir.Constant(_VECTOR, [0.0] * LANES)))
smaller = _lane_by_lane(lambda builder, a, b: _select(builder, "<", a, b))


def _define(symbol: Any, operation: Any) -> None:
    """Lets a kernel write ``symbol`` for an operation on two vectors, or a vector and a float32."""

    def operation_of_two(a: Any, b: Any) -> Any:
        return operation(a, b)

    @extending.overload(symbol, strict=False)
    def choose(a: Any, b: Any) -> Any:
        if isinstance(a, Vector) and isinstance(b, Vector):
            return operation_of_two
        if isinstance(a, Vector) and b == types.float32:
            return lambda a, b: operation(a, splat(b))
        if a == types.float32 and isinstance(b, Vector):
            return lambda a, b: operation(splat(a), b)
        return None


_define(operator.add, _lane_by_lane(lambda builder, a, b: builder.fadd(a, b)))
_define(operator.sub, _lane_by_lane(lambda builder, a, b: builder.fsub(a, b)))
_define(operator.mul, _lane_by_lane(lambda builder, a, b: builder.fmul(a, b)))
_define(operator.truediv, _lane_by_lane(lambda builder, a, b: builder.fdiv(a, b)))
