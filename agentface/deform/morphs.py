"""What moves the skin by a shape: jaw forward and aside, halves of the lips, cheeks, nostrils, nose, ears.

A parameter of the value s moves each of its vertices by |s| times its way at that end of its range, turned as far as
the vertex turns with the jaw; what several do adds up. A half of a lip is a part of one muscle, orbicularis oris: its
morphs share what the whole muscle leaves, 1 less what that puckers and presses.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.eyes.eyelids import HOLD, EyelidsTables
from agentface.deform.lanes import LANES
from agentface.head.model import HeadModel
from agentface.parameters import indices_of

LIP_HALVES = 4
WHOLE_LIPS = "orbicularis_oris_pucker", "orbicularis_oris_press"
_SLIDES = "jaw_thrust", "jaw_shift"


class MorphTables(NamedTuple):
    """The K morphs of a face.

    Attributes:
        parameters: int32 ``(K,)``, where each stands in a pose.
        signs: float32 ``(K,)``, 1 for the upper end of its range, -1 for the lower one.
        lips: int32 ``(K,)``, the half of a lip, 0..3, or -1.
        first: int32 ``(K + 1,)``, where each morph's entries begin.
        vertices: int32 ``(N,)``, the vertices that a morph moves.
        ways: float32 ``(N, 3)`` m, how far at the end of the range.
        moved: int32 ``(M,)``, the vertices that any morph moves; ``places (N,)`` are those of ``vertices`` among them.
        shares: float32 0..1, the part of the jaw's turn that each of these makes; ``(M,)``, and 0 up to a whole block.
        widest: rad, the jaw's whole turn.
        jaw: where ``jaw_open`` stands in a pose.
        whole: int32 ``(2,)``, where the whole muscle's pucker and press stand.
    """

    parameters: Indices
    signs: Floats
    lips: Indices
    first: Indices
    vertices: Indices
    ways: Floats
    moved: Indices
    places: Indices
    shares: Floats
    widest: float
    jaw: int
    whole: Indices


def prepare(model: HeadModel, of_eyelids: EyelidsTables) -> MorphTables:
    """The tables of a face; what the lids hold moves as much less."""
    free = np.ones(len(model.vertices), np.float32)
    free[of_eyelids.vertex] = 1.0 - of_eyelids.fields[:, HOLD]
    placed = model.morphs
    counts = [len(morph.vertices) for morph in placed]
    vertices = np.concatenate([np.zeros(0), *(morph.vertices for morph in placed)]).astype(np.int32)
    ways = np.concatenate([np.zeros((0, 3)), *(morph.ways for morph in placed)])
    moved, places = np.unique(vertices, return_inverse=True)
    return MorphTables(
        parameters=np.array([morph.index for morph in placed], np.int32),
        signs=np.array([morph.sign for morph in placed], np.float32),
        lips=np.array([morph.lip for morph in placed], np.int32),
        first=np.concatenate([[0], np.cumsum(counts)]).astype(np.int32),
        vertices=vertices,
        ways=(free[vertices, None] * ways).astype(np.float32),
        moved=moved.astype(np.int32),
        places=places.astype(np.int32),
        shares=np.append(model.jaw_weights[moved], np.zeros(-len(moved) % LANES)).astype(np.float32),
        widest=math.radians(model.jaw.widest_deg),
        jaw=indices_of("jaw_open")[0],
        whole=np.array([indices_of(name)[0] for name in WHOLE_LIPS], np.int32),
    )


class JawSlides(NamedTuple):
    """How far the bone slides.

    Attributes:
        parameters: int32 ``(2,)``, where ``jaw_thrust`` and ``jaw_shift`` stand in a pose.
        ways: float32 ``(2, 2)`` m, forward and to the person's left, at the upper and at the lower end of each.
    """

    parameters: Indices
    ways: Floats


def jaw_slides(model: HeadModel) -> JawSlides:
    """As far as the tip of the chin goes; what the morphs do to the skin beside is the skin's."""
    chin = int(np.linalg.norm(model.vertices - model.landmarks["pogonion"], axis=1).argmin())
    parameters = np.array([indices_of(name)[0] for name in _SLIDES], np.int32)
    ways = np.zeros((len(_SLIDES), 2), np.float32)
    for row, (index, axis) in enumerate(zip(parameters, (2, 0), strict=True)):
        for morph in model.morphs:
            if morph.index == index:
                ways[row, int(morph.sign < 0)] = morph.ways[morph.vertices == chin, axis].sum()
    return JawSlides(parameters, ways)


def jaw_slide(slides: JawSlides, values: Floats) -> tuple[float, float]:
    """How far the bone goes forward and to the person's left, m, before it turns."""
    thrust, shift = values[slides.parameters[0]], values[slides.parameters[1]]
    ahead = max(thrust, 0.0) * slides.ways[0, 0] + max(-thrust, 0.0) * slides.ways[0, 1]
    aside = max(shift, 0.0) * slides.ways[1, 0] + max(-shift, 0.0) * slides.ways[1, 1]
    return ahead, aside


def share_of_lip(left: np.float32, used: np.float32) -> np.float32:
    """How much of what the morphs of a half of a lip ask for, ``used``, they get when so much is ``left`` of it."""
    return np.float32(1.0) if used <= left else left / used


def apply(tables: MorphTables, values: Floats, points: Floats) -> None:
    """Move ``points (P, 3)`` m in place, to the parameters ``values``."""
    levels = np.maximum(tables.signs * values[tables.parameters], np.float32(0.0))
    left = max(np.float32(0.0), np.float32(1.0) - values[tables.whole].sum())
    for half in range(LIP_HALVES):
        levels[tables.lips == half] *= share_of_lip(left, levels[tables.lips == half].sum())
    active = np.repeat(levels, np.diff(tables.first))
    chosen = active > 0.0
    ways = active[chosen, None] * tables.ways[chosen]
    angle = tables.shares[tables.places[chosen]] * np.float32(tables.widest * values[tables.jaw])
    cosine, sine = np.cos(angle), np.sin(angle)
    turned = np.stack([ways[:, 0], cosine * ways[:, 1] - sine * ways[:, 2], sine * ways[:, 1] + cosine * ways[:, 2]], 1)
    np.add.at(points, tables.vertices[chosen], turned)
