"""What a frame of one face needs besides its vector muscles, made once: the tables of every part."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform import creases
from agentface.deform import midpoints as between
from agentface.deform.eyes import eyeballs as eyes
from agentface.deform.eyes import eyelids
from agentface.deform.eyes.eyeballs import EyesTables
from agentface.deform.eyes.eyelids import EyelidsTables
from agentface.deform.finish import head_turn as head
from agentface.deform.finish import wrinkle_normals as shading
from agentface.deform.finish import wrinkles
from agentface.deform.finish.head_turn import HeadTables
from agentface.deform.finish.wrinkle_normals import ShadingTables
from agentface.deform.finish.wrinkles import WrinkleTables
from agentface.deform.midpoints import BetweenTables
from agentface.deform.mouth import contact, jaw, lips
from agentface.deform.mouth.contact import ContactTables
from agentface.deform.mouth.jaw import JawTables
from agentface.deform.mouth.lips import LipTables
from agentface.deform.muscles import limits, volumes
from agentface.deform.muscles.limits import LimitTables
from agentface.deform.muscles.squash import SquashTables
from agentface.deform.muscles.volumes import VolumeTables
from agentface.head.model import HeadModel
from agentface.head.muscle_set import MuscleSet


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
