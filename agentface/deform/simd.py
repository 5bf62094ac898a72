"""Vectors of single precision numbers for compiled kernels: arithmetic on LANES lanes, held in registers.

numba turns a loop into vector instructions only where it can prove much, and keeps sums in memory between two loops.
A value made by :func:`load`, :func:`tile` or :func:`splat` is LANES numbers that ``+ - *`` take lane by lane. It is
made of parts of eight, which is a register of AVX; LLVM splits them where registers are narrower. An index counts
the elements of an array in C order, whatever its shape, and is not checked.
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

from agentface.deform.lanes import LANES, PART, PARTS

_LANES = ir.VectorType(ir.FloatType(), PART)
_VECTOR = ir.ArrayType(_LANES, PARTS)
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


def _each(builder: Any, make: Callable[..., Any], *vectors: Any) -> Any:
    """A vector whose parts ``make`` makes of the parts of others."""
    result = ir.Constant(_VECTOR, ir.Undefined)
    for part in range(PARTS):
        result = builder.insert_value(result, make(*(builder.extract_value(v, part) for v in vectors)), part)
    return result


def _address(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    array = context.make_array(signature.args[0])(context, builder, args[0])
    index = context.cast(builder, args[1], signature.args[1], types.intp)
    return builder.gep(array.data, [index])


def _address_of(part: int, builder: Any, start: Any) -> Any:
    return builder.bitcast(builder.gep(start, [ir.Constant(_I32, part * PART)]), _LANES.as_pointer())


def _broadcast(builder: Any, scalar: Any) -> Any:
    empty = ir.Constant(_LANES, ir.Undefined)
    one = builder.insert_element(empty, scalar, ir.Constant(_I32, 0))
    everywhere = builder.shuffle_vector(one, empty, ir.Constant(ir.VectorType(_I32, PART), [0] * PART))
    return _each(builder, lambda: everywhere)


def _call(builder: Any, name: str, result: Any, part: Any) -> Any:
    declare: Any = cgutils.get_or_insert_function
    function = declare(builder.module, ir.FunctionType(result, [_LANES]), name)
    return builder.call(function, [part])


@_intrinsic
def load(typing: Any, array: Any, index: Any) -> Any:
    """The vector at ``index`` of a float32 array."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        start = _address(context, builder, signature, args)
        parts = iter([builder.load(_address_of(part, builder, start), align=4) for part in range(PARTS)])
        return _each(builder, lambda: next(parts))

    return _TYPE(array, index), generate


@_intrinsic
def store(typing: Any, array: Any, index: Any, vector: Any) -> Any:
    """Writes a vector at ``index`` of a float32 array."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        start = _address(context, builder, signature, args)
        for part in range(PARTS):
            builder.store(builder.extract_value(args[2], part), _address_of(part, builder, start), align=4)
        return context.get_dummy_value()

    return types.void(array, index, vector), generate


@_intrinsic
def tile(typing: Any, array: Any, row: Any) -> Any:
    """The :data:`PART` numbers of one row of a float32 array with rows of that length, in every part of the vector.

    Rows of one number repeated save the instructions that would spread a single one over a register.
    """

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        index = builder.mul(args[1], ir.Constant(args[1].type, PART))
        start = _address(context, builder, signature, (args[0], index))
        numbers = builder.load(_address_of(0, builder, start), align=4)
        return _each(builder, lambda: numbers)

    return _TYPE(array, row), generate


@_intrinsic
def splat(typing: Any, scalar: Any) -> Any:
    """A float32 in every lane."""
    return _TYPE(types.float32), lambda context, builder, signature, args: _broadcast(builder, args[0])


@_intrinsic
def inverse_root(typing: Any, vector: Any) -> Any:
    """1 / sqrt of every lane."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        one = ir.Constant(_LANES, [1.0] * PART)
        return _each(builder, lambda x: builder.fdiv(one, _call(builder, "llvm.sqrt.v8f32", _LANES, x)), *args)

    return _TYPE(_TYPE), generate


@_intrinsic
def largest(typing: Any, vector: Any) -> Any:
    """The largest lane, a float32."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        result = builder.extract_value(args[0], 0)
        for part in range(1, PARTS):
            result = _select(builder, ">", result, builder.extract_value(args[0], part))
        return _call(builder, "llvm.vector.reduce.fmax.v8f32", ir.FloatType(), result)

    return types.float32(_TYPE), generate


def _select(builder: Any, comparison: str, a: Any, b: Any) -> Any:
    return builder.select(builder.fcmp_ordered(comparison, a, b), a, b)


def _lane_by_lane(make: Callable[[Any, Any, Any], Any]) -> Any:
    """An operation on two vectors; ``make`` gets the builder and one part of each."""

    @_intrinsic
    def operation(typing: Any, a: Any, b: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            return _each(builder, lambda x, y: make(builder, x, y), *args)

        return _TYPE(_TYPE, _TYPE), generate

    return operation


larger = _lane_by_lane(lambda builder, a, b: _select(builder, ">", a, b))
where_positive = _lane_by_lane(
    lambda builder, a, b: builder.select(
        builder.fcmp_ordered(">=", a, ir.Constant(_LANES, [0.0] * PART)), b, ir.Constant(_LANES, [0.0] * PART)
    )
)
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
