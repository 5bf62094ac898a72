"""What every deformer's skin gets last, in order: normals, wrinkles, eyes, teeth, tongue, head, neck with the chest."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.eyes import eyeballs
from agentface.deform.eyes.eyeballs import EyesTables
from agentface.deform.finish import chest, head_turn, neck, teeth, wrinkle_normals, wrinkles
from agentface.deform.finish.chest import ChestTables
from agentface.deform.finish.head_turn import HeadTurnTables
from agentface.deform.finish.neck import NeckTables
from agentface.deform.finish.teeth import TeethTables
from agentface.deform.finish.wrinkle_normals import WrinkleNormalTables
from agentface.deform.finish.wrinkles import WrinkleTables
from agentface.deform.geometry import FaceArrays
from agentface.deform.tongue import tables as tongue_tables
from agentface.deform.tongue import tongue
from agentface.deform.tongue.tables import TongueTables
from agentface.head.model import HeadModel
from agentface.mesh import normals


class FinishStage(IntEnum):
    """The stages in their order."""

    SMOOTH_NORMALS = 0
    WRINKLES = 1
    NORMALS = 2
    EYES = 3
    TEETH = 4
    TONGUE = 5
    HEAD = 6
    NECK = 7


class FinishTables(NamedTuple):
    """What the last stages need of a face: the ``(T, 3)`` int32 triangles of its skin, and a record a stage."""

    triangles: Indices
    wrinkles: WrinkleTables
    wrinkle_normals: WrinkleNormalTables
    eyes: EyesTables
    teeth: TeethTables
    tongue: TongueTables
    head: HeadTurnTables
    neck: NeckTables
    chest: ChestTables


def prepare(model: HeadModel) -> FinishTables:
    """The tables of a face."""
    of_wrinkles = wrinkles.prepare(model)
    return FinishTables(
        triangles=np.ascontiguousarray(model.triangles, np.int32),
        wrinkles=of_wrinkles,
        wrinkle_normals=wrinkle_normals.prepare(model, of_wrinkles),
        eyes=eyeballs.prepare(model),
        teeth=teeth.prepare(model),
        tongue=tongue_tables.prepare(model),
        head=head_turn.prepare(model),
        neck=neck.prepare(model),
        chest=chest.prepare(model),
    )


def finish(first: int, last: int, tables: FinishTables, values: Floats, face: FaceArrays) -> None:
    """The stages ``first`` to ``last`` on one face whose ``vertices`` are the deformed skin, at the pose ``values``."""
    for stage in range(first, last + 1):
        if stage == FinishStage.SMOOTH_NORMALS:
            normals.write_normals(face.vertices, tables.triangles, face.smooth_normals)
        elif stage == FinishStage.WRINKLES:
            wrinkles.levels(tables.wrinkles, values, face.wrinkle_levels)
            wrinkles.heights(tables.wrinkles, values, face.wrinkles)
            wrinkles.raise_vertices(tables.wrinkles, face.wrinkles, face.smooth_normals, face.vertices)
        elif stage == FinishStage.NORMALS:
            wrinkle_normals.apply(
                tables.wrinkle_normals, face.wrinkles, face.vertices, face.smooth_normals, face.normals
            )
        elif stage == FinishStage.EYES:
            eyeballs.apply(tables.eyes, values, face.eye_rotations)
            eyeballs.thrust(tables.eyes, values, face.eye_thrust)
            eyeballs.dilate(tables.eyes, values, face.pupils)
        elif stage == FinishStage.TEETH:
            teeth.apply(tables.teeth, values, face.jaw)
        elif stage == FinishStage.TONGUE:
            tongue.apply(tables.tongue, values, face.vertices, face.jaw, face.tongue)
        elif stage == FinishStage.HEAD:
            head_turn.apply(tables.head, values, face.head)
        elif stage == FinishStage.NECK:
            neck.apply(tables.neck, face.head, face.vertices, face.normals, face.smooth_normals)
            chest.apply(tables.chest, values, face.shoulders)
