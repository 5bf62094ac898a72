"""A mesh as shaders take it: what each vertex has, by the names of their attributes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Indices


@dataclass(frozen=True, slots=True)
class DrawnMesh:
    """``fields``: rows ``(N,)`` or ``(N, 1..4)`` of float32 or int32 by attribute, ``triangles (T, 3)`` int32."""

    fields: dict[str, npt.NDArray[Any]]
    triangles: Indices

    @classmethod
    def of(cls, triangles: Indices, **fields: npt.NDArray[Any]) -> DrawnMesh:
        """A mesh of arrays of any kind of number: whole ones stay whole."""
        single = {
            name: np.ascontiguousarray(field, np.int32 if field.dtype.kind in "iu" else np.float32)
            for name, field in fields.items()
        }
        return cls(single, np.ascontiguousarray(triangles, np.int32))

    def layout(self, context: Any, program: Any, *, partly: bool = False) -> list[tuple[Any, str, str]]:
        """Its fields in buffers, as moderngl wants them; ``partly``: those that ``program`` uses."""
        return [
            (context.buffer(field.tobytes()), form_of(field), name)
            for name, field in self.fields.items()
            if not partly or name in program
        ]

    def array(self, context: Any, program: Any, *, partly: bool = False) -> Any:
        """It on the GPU, to be drawn by ``program``; the rest as :meth:`layout`."""
        layout = self.layout(context, program, partly=partly)
        return context.vertex_array(program, layout, context.buffer(self.triangles.tobytes()))


def form_of(field: npt.NDArray[Any]) -> str:
    """How moderngl writes a row of ``field``."""
    return f"{1 if field.ndim == 1 else field.shape[1]}{'i' if field.dtype.kind == 'i' else 'f'}"
