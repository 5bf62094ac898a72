"""The skin's stages, compiled, and whole frames of many faces without a return to Python.

:func:`deform` is :func:`.order.deform` with the compiled twins in the places of the numpy forms.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.deform import midpoints_compiled as midpoints  # noqa: F401  # the twin's names
from agentface.deform import morphs_compiled as morphs  # noqa: F401
from agentface.deform import order
from agentface.deform.desk import Desk
from agentface.deform.eyes import eyelids_compiled as eyelids  # noqa: F401
from agentface.deform.finish.order import FinishStage
from agentface.deform.finish.order_compiled import finish
from agentface.deform.geometry import FaceArrays
from agentface.deform.geometry_compiled import face_at
from agentface.deform.mouth import contact_compiled as contact  # noqa: F401
from agentface.deform.mouth import jaw_compiled as jaw  # noqa: F401
from agentface.deform.mouth import lips_compiled as lips
from agentface.deform.mouth.lips import CONTRACTIONS
from agentface.deform.muscles import combine_compiled as combine
from agentface.deform.muscles import limits_compiled as limits  # noqa: F401
from agentface.deform.muscles import squash_compiled as squash  # noqa: F401
from agentface.deform.muscles import volumes_compiled as volumes  # noqa: F401
from agentface.deform.muscles.combine import STEP
from agentface.deform.order import Stage
from agentface.deform.tables import FaceTables
from agentface.kernel import compiled_twin, kernel
from agentface.parameters import VECTOR_MUSCLES, indices_of

__all__ = ["Scratch", "deform", "finish", "frames", "new_desk", "new_scratch", "shape"]

_FIRST_MUSCLE = indices_of(VECTOR_MUSCLES[0])[0]
_FIRST, _LAST = int(Stage.VOLUMES), int(Stage.MIDPOINTS)
_FINISH_FIRST, _FINISH_LAST = int(FinishStage.SMOOTH_NORMALS), int(FinishStage.NECK)


class Scratch(NamedTuple):
    """What one worker overwrites for each face: M contractions, their parts in S steps, P moved points in metres.

    ``shares`` and ``found`` are orbicularis oris's in these steps: :meth:`.combine.Combiner.apply`.
    """

    levels: Doubles
    """``(M,)``."""
    parts: Floats
    """``(S, M)``."""
    shares: Floats
    """``(S + 1, 3)``."""
    found: Floats
    """``(144, 3)`` m."""
    points: Floats
    """``(P, 3)``."""


def new_scratch(tables: FaceTables) -> Scratch:
    """The scratch of one worker."""
    muscles, steps = len(VECTOR_MUSCLES), math.ceil(1.0 / STEP)
    return Scratch(
        np.zeros(muscles),
        np.zeros((steps, muscles), np.float32),
        np.zeros((steps + 1, CONTRACTIONS), np.float32),
        np.zeros((len(tables.skin.lips.control_rest), CONTRACTIONS), np.float32),
        tables.skin.rest.copy(),
    )


deform = compiled_twin(order.deform, globals(), error_model="numpy")


@kernel(error_model="numpy")
def shape(tables: FaceTables, scratch: Scratch, last: int, values: Floats) -> None:
    """Move ``scratch.points`` to the pose ``values (COUNT,)``: the vector muscles, then the stages up to ``last``."""
    scratch.levels[:] = values[_FIRST_MUSCLE : _FIRST_MUSCLE + scratch.levels.shape[0]]
    combine.slice_steps(scratch.levels, STEP, scratch.parts)
    lips.slice_steps(tables.skin.lips, values, STEP, scratch.shares)
    combine.contract(tables.skin.rest, tables.blocks, scratch.parts, scratch.shares, scratch.found, scratch.points)
    deform(_FIRST, last, tables.skin, values, scratch.found, scratch.points)


@kernel(error_model="numpy")
def new_desk(tables: FaceTables, scratch: Scratch) -> Desk:
    """The desk of one worker, for :func:`frames`."""
    return Desk(tables, scratch)


@kernel(error_model="numpy")
def frames(desk: Desk, first: int, last: int, poses: Floats, faces: FaceArrays) -> None:
    """Write the faces of ``poses[first:last]`` into ``faces``, a row a face.

    ``poses`` is float32 ``(B, COUNT)``, contractions in 0..1; the vector muscles combine in parallel.
    """
    tables, scratch = desk.tables, desk.scratch
    for index in range(first, last):
        values = poses[index]
        shape(tables, scratch, _LAST, values)
        face = face_at(faces, index)
        moved, shown = scratch.points.ravel(), face.vertices.ravel()
        for place in range(shown.shape[0]):
            shown[place] = moved[place]
        finish(_FINISH_FIRST, _FINISH_LAST, tables.finish, values, face)
