"""What a frame of the geometric face needs, made once a model."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats
from agentface.deform import creases, midpoints, morphs
from agentface.deform.eyes import eyelids
from agentface.deform.eyes.eyelids import EyelidsTables
from agentface.deform.finish import order as finish
from agentface.deform.finish.order import FinishTables
from agentface.deform.midpoints import MidpointTables
from agentface.deform.morphs import MorphTables
from agentface.deform.mouth import contact, jaw, lips
from agentface.deform.mouth.contact_tables import ContactTables
from agentface.deform.mouth.jaw import JawTables
from agentface.deform.mouth.lips import LipTables
from agentface.deform.muscles import limits, volumes
from agentface.deform.muscles.blocks import Blocks, pack
from agentface.deform.muscles.limits import LimitTables
from agentface.deform.muscles.squash import SquashTables
from agentface.deform.muscles.volumes import VolumeTables
from agentface.head.model import HeadModel
from agentface.head.muscle_set import MuscleSet


class SkinTables(NamedTuple):
    """The tables of a face with V vertices and C control points of the lips, P = V + C.

    ``rest`` is ``(P, 3)`` float32 m, the skin's vertices, then the control points; the others are those of the stages.
    """

    rest: Floats
    limits: LimitTables
    lips: LipTables
    eyelids: EyelidsTables
    volumes: VolumeTables
    jaw: JawTables
    morphs: MorphTables
    contact: ContactTables
    creases: SquashTables
    midpoints: MidpointTables


class FaceTables(NamedTuple):
    """Everything that a frame needs, in the form that kernels take: the skin's, the last part's, the muscles'."""

    skin: SkinTables
    finish: FinishTables
    blocks: Blocks


def of(model: HeadModel) -> FaceTables:
    """The tables of a face, prepared once: deformers of the same model share them."""
    tables: FaceTables = model.derived("deform.tables", prepare)
    return tables


def prepare(model: HeadModel) -> FaceTables:
    """The tables of a face."""
    skin = _skin(model)
    return FaceTables(skin, finish.prepare(model), pack(skin.rest, muscles_of(model, skin.lips)))


def muscles_of(model: HeadModel, of_lips: LipTables) -> MuscleSet:
    """The face's vector muscles, which also reach the control points: as far as the skin over which each lies."""
    reach = (model.muscles.reach[:, of_lips.control_vertices] * of_lips.control_weights).sum(axis=2)
    return replace(model.muscles, reach=np.hstack([model.muscles.reach, np.clip(reach, 0.0, 1.0)]))


def _skin(model: HeadModel) -> SkinTables:
    of_lips = lips.prepare(model)
    follow = of_lips.control_vertices, of_lips.control_weights
    rest = np.concatenate([model.vertices, of_lips.control_rest])
    of_eyelids = eyelids.prepare(model)
    return SkinTables(
        rest=rest,
        limits=limits.prepare(model, follow, rest),
        lips=of_lips,
        eyelids=of_eyelids,
        volumes=volumes.prepare(model),
        jaw=jaw.prepare(model, follow, (of_lips.patch, of_lips.controls, of_lips.weight, of_lips.control_rest)),
        morphs=morphs.prepare(model, of_eyelids),
        contact=contact.prepare(model),
        creases=creases.prepare(model, of_eyelids, of_lips),
        midpoints=midpoints.prepare(model),
    )
