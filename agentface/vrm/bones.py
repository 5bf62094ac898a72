"""The bones of an avatar that a face moves: neck, head and eyes, in this face's axes."""

from __future__ import annotations

from typing import NamedTuple

from agentface.conventions import SIDES
from agentface.deform.finish import head_turn
from agentface.deform.geometry import FaceGeometry
from agentface.head.model import HeadModel
from agentface.vrm.expressions import ExpressionTable, expression_table
from agentface.vrm.turns import Quaternion, inverse, part_of, product, quaternion_of

_NECK_M = 0.09
"""So far below the point about which this head turns an avatar's neck begins: ours."""


class BonePose(NamedTuple):
    """A bone in its parent: where it begins, in metres, and its turn."""

    position: tuple[float, float, float]
    turn: Quaternion


class FaceBones:
    """Tells the bones of one face. A bone at rest has no turn.

    Args:
        model: the face.
        table: says how head and neck share a turn; that of ``rules/vrm.yaml`` when None.
    """

    def __init__(self, model: HeadModel, table: ExpressionTable | None = None) -> None:
        self._share = (expression_table() if table is None else table).neck
        joint = head_turn.prepare(model).neck
        self._eyes = [_place(model.eye_centre(side) - joint) for side in SIDES]

    def bones(self, geometry: FaceGeometry) -> dict[str, BonePose]:
        """``Neck``, in the body, ``Head``, in the neck, ``LeftEye`` and ``RightEye``, in the head."""
        turn = quaternion_of(geometry.head[:3, :3])
        neck = part_of(turn, self._share)
        eyes = [quaternion_of(rotation) for rotation in geometry.eye_rotations]
        return {
            "Neck": BonePose((0.0, _NECK_M, 0.0), neck),
            "Head": BonePose((0.0, _NECK_M, 0.0), product(inverse(neck), turn)),
            "LeftEye": BonePose(self._eyes[0], eyes[0]),
            "RightEye": BonePose(self._eyes[1], eyes[1]),
        }


def _place(point: object) -> tuple[float, float, float]:
    x, y, z = map(float, point)  # type: ignore[call-overload]
    return x, y, z
