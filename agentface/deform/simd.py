"""Vectors of numbers for compiled kernels: arithmetic on LANES lanes, held in registers.

numba turns a loop into vector instructions only where it can prove much, and keeps sums in memory between two loops.
A value made by :func:`load` or :func:`splat` is LANES numbers of the array's or the scalar's precision that ``+ - * /``
take lane by lane; a scalar beside one takes its precision. An index counts the elements of an array in C order,
whatever its shape, and is not checked.
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

_I32 = ir.IntType(32)
# numba's annotations keep the compiler's own arguments in a function's signature.
_intrinsic: Any = extending.intrinsic


class Vector(types.Type):
    """The type of a vector of ``number``, float32 or float64, inside a kernel only."""

    def __init__(self, number: Any) -> None:
        super().__init__(name=f"{number}x{LANES}")
        self.number = number

    @property
    def inside(self) -> Any:
        """What LLVM has for it."""
        return ir.VectorType(ir.FloatType() if self.number == types.float32 else ir.DoubleType(), LANES)


@register_default(Vector)
class _VectorModel(PrimitiveModel):
    def __init__(self, manager: Any, kind: Any) -> None:
        super().__init__(manager, kind, kind.inside)


def element_of(context: Any, builder: Any, signature: Any, args: Any) -> Any:
    """Where in memory the element of an array stands, the first two of ``args``: for intrinsics."""
    array = context.make_array(signature.args[0])(context, builder, args[0])
    index = context.cast(builder, args[1], signature.args[1], types.intp)
    return builder.gep(array.data, [index])


def _call(builder: Any, name: str, result: Any, vector: Any) -> Any:
    declare: Any = cgutils.get_or_insert_function
    bits = 32 if vector.type.element == ir.FloatType() else 64
    function = declare(builder.module, ir.FunctionType(result, [vector.type]), f"{name}.v{LANES}f{bits}")
    return builder.call(function, [vector])


def _constant(inside: Any, number: float) -> Any:
    return ir.Constant(inside, [number] * LANES)


@_intrinsic
def load(typing: Any, array: Any, index: Any) -> Any:
    """The vector at ``index`` of an array of float32 or float64."""
    kind = Vector(array.dtype)

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        start = builder.bitcast(element_of(context, builder, signature, args), kind.inside.as_pointer())
        return builder.load(start, align=4)

    return kind(array, index), generate


@_intrinsic
def store(typing: Any, array: Any, index: Any, vector: Any) -> Any:
    """Writes a vector at ``index`` of an array of its numbers."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        start = builder.bitcast(element_of(context, builder, signature, args), vector.inside.as_pointer())
        builder.store(args[2], start, align=4)
        return context.get_dummy_value()

    return types.void(array, index, vector), generate


@_intrinsic
def store_whole(typing: Any, array: Any, index: Any, vector: Any) -> Any:
    """Writes a vector of whole numbers at ``index`` of an int32 array."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        numbers = ir.VectorType(_I32, LANES)
        start = builder.bitcast(element_of(context, builder, signature, args), numbers.as_pointer())
        builder.store(builder.fptosi(args[2], numbers), start, align=4)
        return context.get_dummy_value()

    return types.void(array, index, vector), generate


@_intrinsic
def gather(typing: Any, array: Any, indices: Any, at: Any, offset: Any) -> Any:
    """The elements ``indices[at + lane] + offset`` of an array of float32 or float64; ``indices`` are int32."""
    kind = Vector(array.dtype)

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        of_array, of_indices, of_at, of_offset = signature.args
        data = context.make_array(of_array)(context, builder, args[0]).data
        places = context.make_array(of_indices)(context, builder, args[1]).data
        start, more = (
            context.cast(builder, value, kind, types.intp) for value, kind in ((args[2], of_at), (args[3], of_offset))
        )
        start, data = builder.gep(places, [start]), builder.gep(data, [more])
        vector = ir.Constant(kind.inside, ir.Undefined)
        for lane in range(LANES):
            index = builder.sext(builder.load(builder.gep(start, [_I32(lane)])), ir.IntType(64))
            vector = builder.insert_element(vector, builder.load(builder.gep(data, [index])), _I32(lane))
        return vector

    return kind(array, indices, at, offset), generate


def _in_all_lanes(builder: Any, inside: Any, number: Any) -> Any:
    empty = ir.Constant(inside, ir.Undefined)
    one = builder.insert_element(empty, number, ir.Constant(_I32, 0))
    return builder.shuffle_vector(one, empty, ir.Constant(ir.VectorType(_I32, LANES), [0] * LANES))


@_intrinsic
def splat(typing: Any, scalar: Any) -> Any:
    """A float32 or a float64 in every lane."""
    kind = Vector(scalar)

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return _in_all_lanes(builder, kind.inside, args[0])

    return kind(scalar), generate


@_intrinsic
def splat_as(typing: Any, vector: Any, scalar: Any) -> Any:
    """A number in every lane, in the precision of ``vector``."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return _in_all_lanes(builder, vector.inside, context.cast(builder, args[1], scalar, vector.number))

    return vector(vector, scalar), generate


def _of_one(make: Callable[[Any, Any], Any], of_lane: bool = False) -> Any:
    """An operation on a vector; ``make`` gets the builder and it. Where it is ``of_lane``, the result is a number."""

    @_intrinsic
    def operation(typing: Any, vector: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            return make(builder, args[0])

        return (vector.number if of_lane else vector)(vector), generate

    return operation


def _root(builder: Any, vector: Any) -> Any:
    return _call(builder, "llvm.sqrt", vector.type, vector)


def _whole(builder: Any, vector: Any) -> Any:
    return builder.sitofp(builder.fptosi(vector, ir.VectorType(_I32, LANES)), vector.type)


def _largest(builder: Any, vector: Any) -> Any:
    return _call(builder, "llvm.vector.reduce.fmax", vector.type.element, vector)


root = _of_one(_root)
whole = _of_one(_whole)  # towards 0
inverse_root = _of_one(lambda builder, vector: builder.fdiv(_constant(vector.type, 1.0), _root(builder, vector)))
largest = _of_one(_largest, of_lane=True)


def _select(builder: Any, comparison: str, a: Any, b: Any) -> Any:
    return builder.select(builder.fcmp_ordered(comparison, a, b), a, b)


def _lane_by_lane(make: Callable[[Any, Any, Any], Any]) -> Any:
    """An operation on two vectors; ``make`` gets the builder and both."""

    @_intrinsic
    def operation(typing: Any, a: Any, b: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            return make(builder, *args)

        return (a(a, b), generate) if a == b else None

    return operation


larger = _lane_by_lane(lambda builder, a, b: _select(builder, ">", a, b))


def _chosen(builder: Any, condition: Any, a: Any, b: Any) -> Any:
    return builder.select(builder.fcmp_ordered(">=", condition, _constant(a.type, 0.0)), a, b)


@_intrinsic
def choose(typing: Any, condition: Any, a: Any, b: Any) -> Any:
    """``a`` where ``condition`` is not negative, else ``b``."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return _chosen(builder, *args)

    return a(condition, a, b), generate


where_positive = _lane_by_lane(lambda builder, a, b: _chosen(builder, a, b, _constant(a.type, 0.0)))
smaller = _lane_by_lane(lambda builder, a, b: _select(builder, "<", a, b))


def _define(symbol: Any, operation: Any) -> None:
    """Lets a kernel write ``symbol`` for an operation on two vectors, or a vector and a number."""

    def operation_of_two(a: Any, b: Any) -> Any:
        return operation(a, b)

    @extending.overload(symbol, strict=False)
    def choose(a: Any, b: Any) -> Any:
        if isinstance(a, Vector) and isinstance(b, Vector):
            return operation_of_two
        if isinstance(a, Vector) and isinstance(b, types.Float):
            return lambda a, b: operation(a, splat_as(a, b))
        if isinstance(a, types.Float) and isinstance(b, Vector):
            return lambda a, b: operation(splat_as(b, a), b)
        return None


_define(operator.add, _lane_by_lane(lambda builder, a, b: builder.fadd(a, b)))
_define(operator.sub, _lane_by_lane(lambda builder, a, b: builder.fsub(a, b)))
_define(operator.mul, _lane_by_lane(lambda builder, a, b: builder.fmul(a, b)))
_define(operator.truediv, _lane_by_lane(lambda builder, a, b: builder.fdiv(a, b)))
