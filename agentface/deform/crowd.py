"""Many faces at once: one model, a pose a face, on one thread or more."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from agentface.conventions import Floats, read_only
from agentface.deform.geometry import FaceArrays, FaceGeometry
from agentface.deform.protocol import DEFAULT_DEFORMER, Deformer, Frames, make_deformer
from agentface.errors import InvalidValueError
from agentface.head.model import HeadModel
from agentface.parameters import COUNT, FacePose, check_poses

_EXPECTED = f"an array of numbers of shape (B, {COUNT}) or a sequence of poses"
_CHUNK = 8  # faces that a thread takes at a time, at most


class Crowd:
    """Deforms many faces of one model.

    Every face is, bit for bit, what the deformer's ``at`` makes of its pose. It takes one call at a time: two threads
    that share a crowd overwrite each other's faces, so give each its own.

    Args:
        model: the face they all have.
        threads: how many work on them at once, 1 or more. They share the model's tables; a few faces at a time go to
            whichever is free. A deformer that can do one face at a time alone works on one.
        deformer: the name of one of :func:`agentface.deform.protocol.deformer_names`.
        compiled: False for numpy instead of compiled kernels.

    Raises:
        InvalidValueError: for ``threads`` that is no number from 1 on.
        UnknownNameError: for a deformer that is not there.
    """

    def __init__(
        self, model: HeadModel, threads: int = 1, *, deformer: str = DEFAULT_DEFORMER, compiled: bool = True
    ) -> None:
        if isinstance(threads, bool) or not isinstance(threads, int) or threads < 1:
            raise InvalidValueError("threads", "a number from 1 on", threads)
        self.model, self.threads = model, threads
        made = make_deformer(deformer, model, compiled=compiled)
        worker = getattr(made, "worker", None)
        self._workers: list[Frames] = [_one_by_one(made)] if worker is None else [worker() for _ in range(threads)]
        self._pool = ThreadPoolExecutor(threads, "agentface-crowd") if len(self._workers) > 1 else None
        self._geometry = self._new_geometry(0)
        self._closed = False

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def deform(self, poses: npt.ArrayLike | Sequence[FacePose]) -> FaceGeometry:
        """The faces in ``poses``: a sequence of them, or ``(B, COUNT)``, rows like ``FacePose.array``.

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
        geometry = self._geometry[: len(values)]
        arrays = geometry.arrays()
        size = min(_CHUNK, 1 + len(values) // (2 * self.threads))
        chunks = iter([slice(start, start + size) for start in range(0, len(values), size)])
        if self._pool is None or len(values) == 1:
            _work(self._workers[0], chunks, values, arrays)
        else:
            jobs = [self._pool.submit(_work, worker, chunks, values, arrays) for worker in self._workers]
            for job in jobs:
                job.result()
        return geometry

    def close(self) -> None:
        """Ends the threads and the crowd's work; a crowd that is not used any more does so by itself."""
        self._closed = True
        if self._pool is not None:
            self._pool.shutdown()

    def _new_geometry(self, count: int) -> FaceGeometry:
        return FaceGeometry.at_rest(self.model, batch=(count,))


def _work(worker: Frames, chunks: Iterator[slice], poses: Floats, faces: FaceArrays) -> None:
    """Takes chunk after chunk until none is left; every thread takes from the same ``chunks``."""
    for chunk in chunks:
        worker(chunk.start, min(chunk.stop, len(poses)), poses, faces)


def _one_by_one(deformer: Deformer) -> Frames:
    def frames(first: int, last: int, poses: Floats, faces: FaceArrays) -> None:
        for index in range(first, last):
            for row, array in zip(faces, deformer.at(FacePose(poses[index])).arrays(), strict=True):
                row[index] = array

    return frames


def _checked(poses: npt.ArrayLike | Sequence[FacePose]) -> Floats:
    given = _array(poses)
    if given.ndim != 2 or given.shape[1] != COUNT:
        raise InvalidValueError("poses", _EXPECTED, given.shape)
    with np.errstate(over="ignore"):  # what is too large for single precision is refused as infinite
        values = np.ascontiguousarray(given, np.float32)
    check_poses(values)
    return read_only(values)


def _array(poses: npt.ArrayLike | Sequence[FacePose]) -> npt.NDArray[Any]:
    rows: Any = poses
    if isinstance(poses, (list, tuple)):
        rows = [pose.array if isinstance(pose, FacePose) else pose for pose in poses] or np.zeros((0, COUNT))
    try:
        array = np.asarray(rows)
    except (TypeError, ValueError):  # rows of different lengths
        raise InvalidValueError("poses", _EXPECTED, poses) from None
    if array.dtype.kind not in "fiu":
        raise InvalidValueError("poses", _EXPECTED, f"{type(poses).__name__} of {array.dtype}")
    return array
