"""No skin turns over where the lids or the lips press it against what the vector muscles brought there.

What :mod:`agentface.deform.muscles.squash` does after the vector muscles, done once more when lids, lips and jaw
have moved: a lid that opens wide lifts skin into the lowered brow, lips that press draw skin under the corner of a
smiling mouth. Lids and the red of the lips fold by design and do not give way.
"""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles
from agentface.deform.eyes import eyelids
from agentface.deform.eyes.eyelids import HOLD, EyelidsTables
from agentface.deform.mouth import lips
from agentface.deform.mouth.lips import LipTables
from agentface.deform.muscles import squash
from agentface.deform.muscles.squash import SquashTables
from agentface.deform.muscles.vector_muscle import pull
from agentface.head.model import HeadModel
from agentface.parameters import FacePose

_TOUCHED = 1e-4  # m, the way from which on lids or lips move a vertex
_RINGS = 2  # of triangles beyond these, over which what is pushed can spread
_HALVED = 2e-4  # m, the way at which a vertex gives way sqrt(1/2) times as much as where nothing moves
_LOST = 0.4
_PASSES = 2
_MOVES = {
    "levator_palpebrae_l": 1.0,
    "orbicularis_oculi_orbitalis_l": 1.0,
    "orbicularis_oculi_palpebralis_l": 1.0,
    "orbicularis_oris_press": 0.5,
    "orbicularis_oris_pucker": 0.5,
}


def prepare(model: HeadModel, of_eyelids: EyelidsTables, of_lips: LipTables) -> SquashTables:
    """The heights that vector muscles with lids or lips could squash, of skin that lids or lips move, and near it.

    They have their turn from where lids and lips move most outward, and give way the more the farther out: what is
    pushed up there is handed on to where the skin has room.
    """
    wide, squeezed, shut, pressed, puckered = _moves(model, of_eyelids, of_lips)
    held = np.zeros(len(model.vertices))
    held[of_eyelids.vertex] = of_eyelids.fields[:, HOLD]
    points = model.vertices.astype(np.float64)
    of_muscles = [
        (1.0 - held)[:, None] * pull(model.muscles, i, points, 1.0)
        for i, name in enumerate(model.muscles.names)
        if name.endswith("_l")
    ]
    way = np.max([np.linalg.norm(move, axis=1) for move in (wide, squeezed, shut, pressed + puckered)], axis=0)
    way = np.maximum(way, way[model.mirror])
    near = way > _TOUCHED
    for _ in range(_RINGS):
        near[model.triangles[near[model.triangles].any(axis=1)]] = True
    free = (1.0 - held) * (1.0 - model.material[:, :3].max(axis=1)) / np.sqrt(1.0 + way / _HALVED)
    free = np.minimum(free, free[model.mirror])
    moves = [*of_muscles, wide, squeezed, shut, pressed, puckered]
    return squash.tables_of(model, moves, free, near, outward=-way, lost=_LOST, passes=_PASSES)


def _moves(model: HeadModel, of_eyelids: EyelidsTables, of_lips: LipTables) -> list[Doubles]:
    """``(V, 3)`` m from rest each: the left lid wide open, the eye squeezed, the lid shut; half of a press and of a
    pucker, whose images count too.
    """
    rest = np.concatenate([model.vertices, of_lips.control_rest])
    moves = []
    for name, part in _MOVES.items():
        values, there = FacePose.of(**{name: 1.0}).array, rest.copy()
        lips.contract(of_lips, values, lips.as_they_lie(of_lips, rest), there)
        eyelids.apply(of_eyelids, values, there)
        lips.surface(of_lips, there)
        moves.append(part * (there[: len(model.vertices)].astype(np.float64) - model.vertices))
    return moves
