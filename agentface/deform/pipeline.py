"""The muscle-based face of Bui, Heylen and Nijholt, from a pose to a geometry."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partial

import numpy as np

from agentface.conventions import Floats
from agentface.deform import order, tables
from agentface.deform.finish import order as last_part
from agentface.deform.finish.order import FinishStage
from agentface.deform.geometry import FaceArrays, FaceGeometry
from agentface.deform.mouth import lips
from agentface.deform.muscles.combine import STEP, Combiner, Method
from agentface.deform.order import Stage
from agentface.deform.protocol import Frames
from agentface.head.model import HeadModel
from agentface.parameters import VECTOR_MUSCLES, FacePose, check_pose, indices_of

_FIRST_MUSCLE = indices_of(VECTOR_MUSCLES[0])[0]
_SKIN_PART = int(Stage.VOLUMES), int(Stage.MIDPOINTS)
_LAST_PART = int(FinishStage.SMOOTH_NORMALS), int(FinishStage.NECK)
_MUSCLES = slice(_FIRST_MUSCLE, _FIRST_MUSCLE + len(VECTOR_MUSCLES))


class GeometricDeformer:
    """The geometric face: a pose has one shape, whatever came before.

    The vector muscles move the skin and the control points of the lips, combined as ``combine`` says, and gather
    volumes, as far as each region allows; orbicularis oris contracts in the same steps; then the lids, and the jaw,
    which carries all that along; then the lips' surface takes its vertices, lips and teeth are kept apart, no skin
    turns over (:mod:`agentface.deform.order`), and the skin gets its wrinkles, normals and neck
    (:mod:`agentface.deform.finish.order`). ``compiled=False`` takes the numpy forms, the same to 1e-6 m: ready at once,
    slow a frame.

    Attributes:
        frames: writes rows of poses into rows of faces, one call at a time.
    """

    def __init__(self, model: HeadModel, combine: Method = "parallel", *, compiled: bool = True) -> None:
        self._model, self._method, self._compiled = model, combine, compiled
        self._tables = tables.of(model)
        skin = self._tables.skin
        self._points = skin.rest.copy()
        self._found = lips.as_they_lie(skin.lips, skin.rest)
        self._deform, self._finish, self._slice = order.deform, last_part.finish, lips.slice_steps
        self.frames: Frames = self._by_parts
        if compiled:
            from agentface.deform import order_compiled
            from agentface.deform.mouth import lips_compiled

            self._deform, self._finish = order_compiled.deform, order_compiled.finish
            self._slice = lips_compiled.slice_steps
            if combine == "parallel":
                desk = order_compiled.new_desk(self._tables, order_compiled.new_scratch(self._tables))
                self.frames = partial(order_compiled.frames, desk)
        self._rows = self._new_rows()
        self._arrays, self._shown = self._rows.arrays(), self._rows[0]

    @cached_property
    def _combiner(self) -> Combiner:
        skin = self._tables.skin
        muscles = tables.muscles_of(self._model, skin.lips)
        return Combiner(skin.rest, muscles, self._method, compiled=self._compiled)

    @cached_property
    def _shares(self) -> Floats:
        """Which part of orbicularis oris acts in each step; where muscles act otherwise, all of it after them."""
        shares = np.zeros((self._combiner.steps + 1, lips.CONTRACTIONS), np.float32)
        shares[-1] = 1.0
        return shares

    def reset(self, pose: FacePose) -> None:
        """Nothing: this face has no memory."""

    def step(self, pose: FacePose, dt: float) -> FaceGeometry:
        """The face in ``pose``, in arrays that the next step overwrites.

        Raises InvalidValueError for a parameter outside its range.
        """
        check_pose(pose.array)
        self.frames(0, 1, pose.array[None], self._arrays)
        return self._shown

    def at(self, pose: FacePose) -> FaceGeometry:
        """The face in ``pose``, in arrays of its own; raises InvalidValueError for a parameter outside its range."""
        check_pose(pose.array)
        rows = self._new_rows()
        self.frames(0, 1, pose.array[None], rows.arrays())
        return rows[0]

    def worker(self) -> Frames:
        """Writes rows of poses into rows of faces; each worker may be at work at the same time as the others."""
        return GeometricDeformer(self._model, self._method, compiled=self._compiled).frames

    def stages(self, geometry: FaceGeometry) -> dict[str, Callable[[FacePose], None]]:
        """What a frame consists of, in its order, by name: each goes on from what the ones before it left."""
        face = geometry.arrays()
        acts: dict[str, Callable[[FacePose], None]] = {"muscles": lambda pose: self._contract(pose.array)}
        for stage in Stage:
            acts[stage.name.lower()] = partial(self._skin_stages, int(stage), int(stage))
        acts["copy"] = lambda _: self._copy(face)
        for last in FinishStage:
            acts[last.name.lower()] = partial(self._last_stages, face, int(last), int(last))
        return acts

    def _by_parts(self, first: int, last: int, poses: Floats, rows: FaceArrays) -> None:
        for index in range(first, last):
            values, face = poses[index], FaceArrays(*(array[index] for array in rows))
            self._contract(values)
            self._deform(*_SKIN_PART, self._tables.skin, values, self._found, self._points)
            self._copy(face)
            self._finish(*_LAST_PART, self._tables.finish, values, face)

    def _contract(self, values: Floats) -> None:
        if self._method == "parallel":
            self._slice(self._tables.skin.lips, values, STEP, self._shares)
        self._combiner.apply(values[_MUSCLES], self._points, self._shares, self._found)

    def _skin_stages(self, first: int, last: int, pose: FacePose) -> None:
        self._deform(first, last, self._tables.skin, pose.array, self._found, self._points)

    def _copy(self, face: FaceArrays) -> None:
        face.vertices[:] = self._points[: len(face.vertices)]

    def _last_stages(self, face: FaceArrays, first: int, last: int, pose: FacePose) -> None:
        self._finish(first, last, self._tables.finish, pose.array, face)

    def _new_rows(self) -> FaceGeometry:
        return FaceGeometry.at_rest(self._model, batch=(1,))
