"""numpy's functions for vectors: a kernel made of code that is written for numbers or arrays takes them, too."""

# mypy: disable-error-code="untyped-decorator, no-untyped-call, import-untyped"
# numba's extension points carry no types.
from __future__ import annotations

from typing import Any

import numpy as np
from numba import extending, types

from agentface.deform.simd import Vector, larger, root, smaller, splat_as

# of the Taylor series in nested form: to 1e-11 up to 1.6 rad, to 1e-7 up to 2.6
_COSINE = tuple(-1.0 / (n * (n - 1)) for n in range(2, 18, 2))
_SINE = tuple(-1.0 / (n * (n - 1)) for n in range(3, 17, 2))
_ONE = 1.0


def _define(function: Any, operation: Any) -> None:
    """Lets a kernel write ``function`` for an operation on two vectors, or a vector and a number."""

    @extending.overload(function, strict=False)
    def choose(a: Any, b: Any) -> Any:
        if isinstance(a, Vector) and isinstance(b, Vector):
            return lambda a, b: operation(a, b)  # noqa: PLW0108  # numba wants parameters of these names
        if isinstance(a, Vector) and isinstance(b, types.Float):
            return lambda a, b: operation(a, splat_as(a, b))
        if isinstance(a, types.Float) and isinstance(b, Vector):
            return lambda a, b: operation(splat_as(b, a), b)
        return None


_define(np.minimum, smaller)
_define(np.maximum, larger)


@extending.overload(np.sqrt, strict=False)
def _sqrt(x: Any) -> Any:
    return (lambda x: root(x)) if isinstance(x, Vector) else None  # noqa: PLW0108  # as above


@extending.overload(np.cos, strict=False)
def _cos(x: Any) -> Any:
    if not isinstance(x, Vector):
        return None
    c2, c4, c6, c8, c10, c12, c14, c16 = _COSINE

    def cosine(x: Any) -> Any:
        square = x * x
        inner = _ONE + square * c12 * (_ONE + square * c14 * (_ONE + square * c16))
        inner = _ONE + square * c6 * (_ONE + square * c8 * (_ONE + square * c10 * inner))
        return _ONE + square * c2 * (_ONE + square * c4 * inner)

    return cosine


@extending.overload(np.sin, strict=False)
def _sin(x: Any) -> Any:
    if not isinstance(x, Vector):
        return None
    s3, s5, s7, s9, s11, s13, s15 = _SINE

    def sine(x: Any) -> Any:
        square = x * x
        inner = _ONE + square * s11 * (_ONE + square * s13 * (_ONE + square * s15))
        inner = _ONE + square * s7 * (_ONE + square * s9 * inner)
        return x * (_ONE + square * s3 * (_ONE + square * s5 * inner))

    return sine
