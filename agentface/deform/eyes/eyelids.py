"""The eyelids (Bui et al., section 3.3): Parke's lids on a sphere, Waters' sphincter, and how the two couple.

Round an eye's centre, with theta the turn of a point about the lateral axis and rho its distance from that axis:

    theta' = theta + c A + t B + (1 - c) (o W + g G + n N + i I)        rho' = rho (1 + c D + t E)

``c`` is the closing, ``t = min(1, 2 s)`` what the squeeze ``s`` raises the line where the lids meet, ``o`` the
levator, ``g`` the eye's pitch, ``n`` the tightening of the lower lid, ``i`` how far the inner brow rises more than the
outer one. A, B, W, G, N, I, D, E are fields over the skin (:mod:`agentface.deform.eyes.lid_fields`): the
edges interpolate linearly between open and closed, where both lie on one curve; the skin follows with a fade, down
onto the sphere that the closed edge lies on. Where an eye stands forward of its place, the lids go along as far as
they are held. No point goes below a sphere slightly larger than the eye. Before that
the skin goes the way ``s (2 - s)`` of the sphincter: like a squint, most of it with little force.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import SIDES, Floats, Indices
from agentface.deform.eyes import eyeballs
from agentface.deform.eyes.eyeballs import EyesTables
from agentface.deform.eyes.lid_fields import LidFields, lid_fields
from agentface.deform.lanes import LANES
from agentface.head.model import HeadModel
from agentface.parameters import indices_of

HOLD, CLOSE, HIGHER, WIDEN, FOLLOW, TIGHTEN, SLANT = range(7)
SHRINK, SHRINK_HIGHER, ACROSS, UP, TIGHT_ACROSS, TIGHT_UP, FLOOR = range(7, 14)
"""Rows of a block of :attr:`EyelidsTables.fields`."""
LOOKING_UP = np.float32(0.7)
"""How much of following an eye upward a levator at full contraction leaves out: it has done the lifting."""
_NEAR = np.float32(1e-6)  # m
_ZERO, _ONE, _TWO = (np.float32(number) for number in (0.0, 1.0, 2.0))


class EyelidsTables(NamedTuple):
    """What the lids of one face need; the left eye first, the right one its mirror image."""

    vertex: Indices
    """``(2, B, LANES)``: the vertices round each eye, in blocks; the last vertex fills the last block up."""
    rest: Floats
    """``(2, B, 3, LANES)`` m: where they rest."""
    centre: Floats
    """``(2, 3)`` m: the centres of the eyes."""
    fields: Floats
    """``(B, 14, LANES)``: what :class:`.lid_fields.LidFields` has after ``vertex``, in its order."""
    closing: Indices
    """``(2,)``: where pars palpebralis stands in a pose."""
    squeezing: Indices
    """``(2,)``: pars orbitalis."""
    opening: Indices
    """``(2,)``: levator palpebrae."""
    tightening: Indices
    """``(2,)``: the preseptal part of pars palpebralis."""
    inner_brow: Indices
    """``(2,)``: the medial fibres of frontalis."""
    outer_brow: Indices
    """``(2,)``: its lateral fibres."""
    eyes: EyesTables
    """How far the eyes turn: the lids follow them."""


def prepare(model: HeadModel) -> EyelidsTables:
    """The tables of a face."""
    fields = lid_fields(model)
    count = len(fields.vertex)
    full = np.minimum(np.arange(-(-count // LANES) * LANES), count - 1).reshape(-1, LANES)
    vertex = np.stack([fields.vertex[full], model.mirror[fields.vertex[full]]]).astype(np.int32)
    columns = [getattr(fields, name)[full] for name in fields.__slots__[1:]]
    return EyelidsTables(
        vertex=vertex,
        rest=np.ascontiguousarray(np.moveaxis(model.vertices[vertex], 3, 2)),
        centre=np.stack([model.eye_centre(side) for side in SIDES]),
        fields=np.ascontiguousarray(np.stack(columns, axis=1), np.float32),
        closing=np.array(indices_of("orbicularis_oculi_palpebralis"), np.int32),
        squeezing=np.array(indices_of("orbicularis_oculi_orbitalis"), np.int32),
        opening=np.array(indices_of("levator_palpebrae"), np.int32),
        tightening=np.array(indices_of("orbicularis_oculi_preseptalis"), np.int32),
        inner_brow=np.array(indices_of("frontalis_medialis"), np.int32),
        outer_brow=np.array(indices_of("frontalis_lateralis"), np.int32),
        eyes=eyeballs.prepare(model),
    )


def coupled(closing: float, squeezing: float, other_closing: float, other_squeezing: float) -> tuple[float, float]:
    """The closing and the squeezing of an eye as its two muscles and those of the other eye make them, 0..1.

    The paper: if squeezing > closing / 2, closing = min(1, 2 squeezing) (it prints max); else, if one tries to close
    only one eye, squeezing = closing / 2. Each branch raises one number to what the other asks for, so both are a
    maximum. "Only one" is a matter of degree here: what counts is by how much the other eye is less closed.
    """
    closed = max(closing, min(1.0, 2.0 * squeezing))
    other = max(other_closing, min(1.0, 2.0 * other_squeezing))
    return closed, max(squeezing, 0.5 * (closed - other))


def apply(tables: EyelidsTables, values: Floats, points: Floats) -> None:
    """Move the lids and what they take along of ``points (V + C, 3)`` m in place, to the parameters ``values``."""
    closing, squeezing, opening = (values[row] for row in (tables.closing, tables.squeezing, tables.opening))
    tightening = values[tables.tightening]
    alone = np.maximum(values[tables.inner_brow] - values[tables.outer_brow], _ZERO)
    lid = LidFields(tables.vertex[0].ravel(), *np.moveaxis(tables.fields, 1, 0).reshape(FLOOR + 1, -1))
    for side in range(len(SIDES)):
        c, s = (
            np.float32(level)
            for level in coupled(closing[side], squeezing[side], closing[1 - side], squeezing[1 - side])
        )
        raised, o = min(_ONE, _TWO * s), np.float32(opening[side])
        pitch = np.float32(eyeballs.eye_angles(tables.eyes, values, side)[1])
        pitch *= _ONE - LOOKING_UP * o * (pitch > 0)
        where, centre = tables.vertex[side].ravel(), tables.centre[side]
        at, rest = points[where], np.moveaxis(tables.rest[side], 1, 2).reshape(-1, 3)
        at -= lid.hold[:, None] * (at - rest)
        way = s * (_TWO - s)
        tight = (_ONE - c) * tightening[side]
        at[:, 0] += (way * lid.across + tight * lid.tight_across) * (1 - 2 * side)
        at[:, 1] += way * lid.up + tight * lid.tight_up
        turned = o * lid.widen + pitch * lid.follow + alone[side] * lid.slant
        angle = c * lid.close + raised * lid.meet_higher + (_ONE - c) * turned + tight * lid.tighten
        scale = _ONE + c * lid.shrink + raised * lid.shrink_higher
        cosine, sine = scale * np.cos(angle) - _ONE, scale * np.sin(angle)
        y, z = at[:, 1] - centre[1], at[:, 2] - centre[2]
        at[:, 1] += cosine * y + sine * z
        at[:, 2] += cosine * z - sine * y
        ahead = eyeballs.FARTHEST * values[tables.eyes.thrust[side]]
        at[:, 2] += ahead * lid.hold
        arm = at - centre
        arm[:, 2] -= ahead
        distance = np.sqrt((arm * arm).sum(1))
        at += np.maximum(lid.floor / np.maximum(distance, _NEAR) - _ONE, _ZERO)[:, None] * arm
        points[where] = at
