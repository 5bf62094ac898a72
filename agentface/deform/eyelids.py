"""The eyelids: they turn about the eyeball's axis between open and closed (Parke 1974; Bui et al., section 3.3)."""

from __future__ import annotations

import numpy as np

from agentface.anatomy.model import HeadModel, RingHalves
from agentface.conventions import SIDES, Doubles, Floats
from agentface.parameters import indices_of

_EDGE_RING = 3
_MEETING = 0.22  # where the closed lids meet, from the lower edge up, as a part of the opening
_WIDEST = 0.27  # rad, how far the upper lid rises past neutral in the middle of the eye
_SQUEEZE_UPPER, _SQUEEZE_LOWER = 0.22, 1.15  # how far a squeeze brings each lid towards where they meet
_FOLLOW_UPPER, _FOLLOW_LOWER = 0.55, 0.25  # of the eye's pitch, which the lids follow
_LID_HEIGHT = {"upper": 0.62, "lower": 0.60}  # rad above or below the edge over which the skin follows it


class Eyelids:
    """Moves the lids of one face.

    Every vertex near an eye gets, at rest, its lid (upper or lower), how much of the edge's turn it follows,
    and the angle at its place across the eye between the open edge and the line where the lids meet.
    """

    def __init__(self, model: HeadModel) -> None:
        self._eyes = [_Lids(model, side) for side in SIDES]
        self._close, self._open, self._squeeze = (
            indices_of(name)
            for name in ("orbicularis_oculi_palpebralis", "levator_palpebrae", "orbicularis_oculi_orbitalis")
        )
        self._pitch = indices_of("gaze_pitch")[0]

    def apply(self, values: Floats, vertices: Floats) -> None:
        """Move the lids of ``vertices (V, 3)`` in place, to the parameters ``values``."""
        for lids, close, opened, squeeze in zip(self._eyes, self._close, self._open, self._squeeze, strict=True):
            lids.apply(
                vertices,
                float(values[close]),
                float(values[opened]),
                float(values[squeeze]),
                float(values[self._pitch]),
            )


class _Lids:
    def __init__(self, model: HeadModel, side: str) -> None:
        centre = model.eye_centre(side).astype(np.float64)
        self._centre = model.eye_centre(side)
        edge = model.eyelids.rings[side][_EDGE_RING]
        arms = model.vertices.astype(np.float64) - centre
        across, turn = arms[:, 0], np.arctan2(arms[:, 1], arms[:, 2])
        upper, lower = (_edge_turn(half, across, turn) for half in (edge.upper, edge.lower))
        opening = np.maximum(upper - lower, 0.0)
        meeting = lower + _MEETING * opening
        is_upper = turn >= np.where(opening > 0.02, meeting, 0.5 * (upper + lower))
        follow = _follow(arms, across, turn, upper, lower, is_upper, edge)
        near = (arms[:, 2] > 0) & (np.linalg.norm(arms, axis=1) < 2.9 * model.eyes.radius) & (follow > 1e-3)
        own = model.vertices[:, 0] * (1 if side == SIDES[0] else -1) > 0.005
        self._where = np.flatnonzero(near & own)
        pick = self._where
        self._is_upper = is_upper[pick]
        # one turn of the edge, in radians, for each thing a lid does; positive lifts
        to_meeting = np.where(is_upper, meeting - upper, meeting - lower)[pick]
        self._closing = (follow[pick] * to_meeting).astype(np.float32)
        self._follow = follow[pick].astype(np.float32)
        profile = is_upper * opening / opening.max()
        self._widening = (follow * profile)[pick].astype(np.float32)

    def apply(self, vertices: Floats, close: float, opened: float, squeeze: float, pitch: float) -> None:
        if not (close or opened or squeeze or pitch):
            return
        shut_upper = np.clip(close + _SQUEEZE_UPPER * squeeze, 0, 1)
        shut_lower = np.clip(close + _SQUEEZE_LOWER * squeeze, 0, 1)
        gaze = pitch * (1 - close) * np.where(self._is_upper, _FOLLOW_UPPER, _FOLLOW_LOWER)
        angle = self._closing * np.where(self._is_upper, shut_upper, shut_lower) + self._follow * gaze
        angle += _WIDEST * opened * (1 - close) * self._widening
        cosine, sine = np.cos(angle), np.sin(angle)
        arm = vertices[self._where] - self._centre
        vertices[self._where, 1] = self._centre[1] + cosine * arm[:, 1] + sine * arm[:, 2]
        vertices[self._where, 2] = self._centre[2] - sine * arm[:, 1] + cosine * arm[:, 2]


def _edge_turn(edge: list[int], across: Doubles, turn: Doubles) -> Doubles:
    """The lid edge's angle about the eye's lateral axis at the place across of every vertex."""
    order = np.argsort(across[edge])
    return np.interp(across, across[edge][order], turn[edge][order])


def _follow(
    arms: Doubles, across: Doubles, turn: Doubles, upper: Doubles, lower: Doubles,
    is_upper: np.typing.NDArray[np.bool_], edge: RingHalves,
) -> Doubles:  # fmt: skip
    beyond = np.where(is_upper, (turn - upper) / _LID_HEIGHT["upper"], (lower - turn) / _LID_HEIGHT["lower"])
    first, last = across[edge.upper].min(), across[edge.upper].max()
    outside = np.maximum(np.maximum(first - across, across - last), 0.0) / (0.35 * (last - first))
    return _fade(np.clip(beyond, 0, 1)) * _fade(np.clip(outside, 0, 1))


def _fade(t: Doubles) -> Doubles:
    return 1 - t * t * (3 - 2 * t)
