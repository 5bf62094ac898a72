"""Many faces at once: one model, a pose a face, on one thread or more."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Floats
from agentface.deform import tables as frame
from agentface.deform.geometry import FaceGeometry
from agentface.deform.muscles.combine import STEP
from agentface.deform.ranges import check_poses
from agentface.errors import InvalidValueError
from agentface.head.model import HeadModel
from agentface.parameters import COUNT, VECTOR_MUSCLES, FacePose

_EXPECTED = f"an array of numbers of shape (B, {COUNT}) or a sequence of poses"
_CHUNK = 8  # faces that a thread takes at a time, at most


@dataclass(frozen=True, slots=True)
class CrowdGeometry:
    """B faces at one instant, in the model's axes and metres: :class:`FaceGeometry` with a row a face.

    Attributes:
        vertices: ``(B, V, 3)`` float32.
        normals: ``(B, V, 3)`` float32.
        wrinkles: ``(B, V)`` float32.
        eye_rotations: ``(B, 2, 3, 3)`` float32.
        jaw: ``(B, 4, 4)`` float32.
        head: ``(B, 4, 4)`` float32.
        smooth_normals: ``(B, V, 3)`` float32.
        wrinkle_levels: ``(B, K)`` float32.
    """

    vertices: Floats
    normals: Floats
    wrinkles: Floats
    eye_rotations: Floats
    jaw: Floats
    head: Floats
    smooth_normals: Floats
    wrinkle_levels: Floats

    def __len__(self) -> int:
        return len(self.vertices)

    def face(self, index: int) -> FaceGeometry:
        """One face of them; its arrays are parts of these."""
        return FaceGeometry(**{field.name: getattr(self, field.name)[index] for field in fields(self)})

    def first(self, count: int) -> CrowdGeometry:
        """The first ``count`` faces; their arrays are parts of these."""
        return CrowdGeometry(**{field.name: getattr(self, field.name)[:count] for field in fields(self)})


class Crowd:
    """Deforms many faces of one model by the muscles' parallel combination; compiled.

    Every face is, bit for bit, what :class:`agentface.deform.pipeline.GeometricDeformer` makes of its pose.
    It takes one call at a time: two threads that share a crowd overwrite each other's faces, so give each its own.

    Args:
        model: the face they all have.
        threads: how many work on them at once, 1 or more. They share the model's tables; a few faces at a time go to
            whichever is free.

    Raises:
        InvalidValueError: for ``threads`` that is no number from 1 on.
    """

    def __init__(self, model: HeadModel, threads: int = 1) -> None:
        from agentface.deform import crowd_compiled as kernels
        from agentface.deform.muscles.blocks import pack

        if isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
            raise InvalidValueError("threads", "a number from 1 on", threads)
        self.model, self.threads = model, threads
        self._kernels = kernels
        self._tables, muscles = frame.prepare(model)
        self._blocks = pack(self._tables.rest, muscles)
        self._scratch = [self._new_scratch() for _ in range(threads)]
        self._pool = ThreadPoolExecutor(threads, "agentface-crowd") if threads > 1 else None
        self._geometry = self._new_geometry(0)
        self._closed = False

    def deform(self, poses: npt.ArrayLike | Sequence[FacePose]) -> CrowdGeometry:
        """The faces in ``poses``: a sequence of them, or ``(B, COUNT)``, rows like ``FacePose.values``.

        The result's arrays are overwritten by the next call; they grow with the largest crowd so far.

        Raises:
            InvalidValueError: for another shape, for what are no numbers, for a parameter outside its range, and after
                :meth:`close`.
        """
        if self._closed:
            raise InvalidValueError(
                "Crowd.deform", "a crowd that is not closed", "one after close()", "make a new Crowd"
            )
        values = _checked(poses)
        if len(values) > len(self._geometry):
            self._geometry = self._new_geometry(len(values))
        geometry = self._geometry.first(len(values))
        size = min(_CHUNK, 1 + len(values) // (2 * self.threads))
        chunks = iter([slice(start, start + size) for start in range(0, len(values), size)])
        if self._pool is None or len(values) == 1:
            self._work(self._scratch[0], chunks, values, geometry)
        else:
            jobs = [self._pool.submit(self._work, scratch, chunks, values, geometry) for scratch in self._scratch]
            for job in jobs:
                job.result()
        return geometry

    def close(self) -> None:
        """Ends the threads and the crowd's work; a crowd that is not used any more does so by itself."""
        self._closed = True
        if self._pool is not None:
            self._pool.shutdown()

    def _work(self, scratch: Any, chunks: Iterator[slice], values: Floats, geometry: CrowdGeometry) -> None:
        """Takes chunk after chunk until none is left; every thread takes from the same ``chunks``."""
        faces = self._kernels.Faces(**{name: getattr(geometry, name) for name in self._kernels.Faces._fields})
        for chunk in chunks:
            end = min(chunk.stop, len(values))
            self._kernels.deform(self._tables, self._blocks, values, chunk.start, end, scratch, faces)

    def _new_scratch(self) -> Any:
        muscles, steps = len(VECTOR_MUSCLES), math.ceil(1.0 / STEP)
        levels, parts = np.zeros(muscles), np.zeros((steps, muscles), np.float32)
        return self._kernels.Scratch(levels, parts, self._tables.rest.copy())

    def _new_geometry(self, count: int) -> CrowdGeometry:
        vertices, trains = len(self.model.vertices), len(self._tables.wrinkles.parameters)
        shapes = {
            "vertices": (vertices, 3), "normals": (vertices, 3), "wrinkles": (vertices,), "eye_rotations": (2, 3, 3),
            "jaw": (4, 4), "head": (4, 4), "smooth_normals": (vertices, 3), "wrinkle_levels": (trains,),
        }  # fmt: skip
        return CrowdGeometry(**{name: np.empty((count, *shape), np.float32) for name, shape in shapes.items()})


def _checked(poses: npt.ArrayLike | Sequence[FacePose]) -> Floats:
    given = _array(poses)
    if given.ndim != 2 or given.shape[1] != COUNT:
        raise InvalidValueError("poses", _EXPECTED, given.shape)
    with np.errstate(over="ignore"):  # what is too large for single precision is refused as infinite
        values = np.ascontiguousarray(given, np.float32)
    check_poses(values)
    return values


def _array(poses: npt.ArrayLike | Sequence[FacePose]) -> npt.NDArray[Any]:
    rows: Any = poses
    if isinstance(poses, (list, tuple)):
        rows = [pose.values if isinstance(pose, FacePose) else pose for pose in poses] or np.zeros((0, COUNT))
    try:
        array = np.asarray(rows)
    except (TypeError, ValueError):  # rows of different lengths
        raise InvalidValueError("poses", _EXPECTED, poses) from None
    if array.dtype.kind not in "fiu":
        raise InvalidValueError("poses", _EXPECTED, f"{type(poses).__name__} of {array.dtype}")
    return array
