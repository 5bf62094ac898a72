"""What every deformer's skin gets last, in order: normals, wrinkles, eyes, teeth, tongue, head, neck with the chest."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

from agentface.conventions import Floats
from agentface.deform.eyes import eyeballs
from agentface.deform.eyes.eyeballs import EyesTables
from agentface.deform.finish import chest, head_turn, neck, smooth_normals, teeth, wrinkle_normals, wrinkles
from agentface.deform.finish.chest import ChestTables
from agentface.deform.finish.head_turn import HeadTurnTables
from agentface.deform.finish.neck import NeckTables
from agentface.deform.finish.smooth_normals import SmoothNormalTables
from agentface.deform.finish.teeth import TeethTables
from agentface.deform.finish.wrinkle_normals import WrinkleNormalTables
from agentface.deform.finish.wrinkles import WrinkleTables
from agentface.deform.geometry import FaceArrays
from agentface.deform.tongue import tables as tongue_tables
from agentface.deform.tongue import tongue
from agentface.deform.tongue.tables import TongueTables
from agentface.head.model import HeadModel


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
    """What the last stages need of a face: a record a stage."""

    smooth_normals: SmoothNormalTables
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
    of_wrinkles, of_skin = wrinkles.prepare(model), smooth_normals.prepare(model)
    return FinishTables(
        smooth_normals=of_skin,
        wrinkles=of_wrinkles,
        wrinkle_normals=wrinkle_normals.prepare(of_skin, of_wrinkles),
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
            smooth_normals.apply(tables.smooth_normals, face.vertices, face.smooth_normals)
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
