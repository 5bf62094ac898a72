"""What a frame of one face needs besides its vector muscles, made once: the tables of every part."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from agentface.anatomy.model import HeadModel
from agentface.anatomy.muscle_set import MuscleSet
from agentface.conventions import Floats, Indices
from agentface.deform import (
    between,
    contact,
    creases,
    eyelids,
    eyes,
    head,
    jaw,
    limits,
    lips,
    shading,
    volumes,
    wrinkles,
)
from agentface.deform.between import BetweenTables
from agentface.deform.contact import ContactTables
from agentface.deform.eyelids import EyelidsTables
from agentface.deform.eyes import EyesTables
from agentface.deform.head import HeadTables
from agentface.deform.jaw import JawTables
from agentface.deform.limits import LimitTables
from agentface.deform.lips import LipTables
from agentface.deform.shading import ShadingTables
from agentface.deform.squash import SquashTables
from agentface.deform.volumes import VolumeTables
from agentface.deform.wrinkles import WrinkleTables


class PartTables(NamedTuple):
    """The tables of a face with V vertices and C control points of the lips, P = V + C.

    Attributes:
        rest: ``(P, 3)`` float32 m, the skin's vertices, then the control points.
        triangles: ``(T, 3)`` int32, of the skin.
        limits, lips, eyelids, volumes, jaw, contact, creases, between, wrinkles, shading, eyes, head: the parts
            of the same names.
    """

    rest: Floats
    triangles: Indices
    limits: LimitTables
    lips: LipTables
    eyelids: EyelidsTables
    volumes: VolumeTables
    jaw: JawTables
    contact: ContactTables
    creases: SquashTables
    between: BetweenTables
    wrinkles: WrinkleTables
    shading: ShadingTables
    eyes: EyesTables
    head: HeadTables


def prepare(model: HeadModel) -> tuple[PartTables, MuscleSet]:
    """The tables of a face, and its vector muscles, which also reach the control points.

    A muscle reaches a control point as far as the skin over which it lies.
    """
    of_lips = lips.prepare(model)
    follow = of_lips.control_vertices, of_lips.control_weights
    rest = np.concatenate([model.vertices, of_lips.control_rest])
    reach = (model.muscles.reach[:, follow[0]] * follow[1]).sum(axis=2)
    muscles = replace(model.muscles, reach=np.hstack([model.muscles.reach, np.clip(reach, 0.0, 1.0)]))
    of_eyelids = eyelids.prepare(model)
    of_wrinkles = wrinkles.prepare(model)
    tables = PartTables(
        rest=rest,
        triangles=np.ascontiguousarray(model.triangles, np.int32),
        limits=limits.prepare(model, follow, rest),
        lips=of_lips,
        eyelids=of_eyelids,
        volumes=volumes.prepare(model),
        jaw=jaw.prepare(model, follow, (of_lips.patch, of_lips.controls, of_lips.weight, of_lips.control_rest)),
        contact=contact.prepare(model),
        creases=creases.prepare(model, of_eyelids, of_lips),
        between=between.prepare(model),
        wrinkles=of_wrinkles,
        shading=shading.prepare(model, of_wrinkles),
        eyes=eyes.prepare(model),
        head=head.prepare(model),
    )
    return tables, muscles
