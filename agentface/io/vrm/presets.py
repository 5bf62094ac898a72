"""VRM's preset expressions as poses of this face: its own emotions, visemes, blinks and looks.

Source: VRM Consortium, VRMC_vrm-1.0, expressions.md.
"""

from __future__ import annotations

import math

import numpy as np

from agentface.emotion.state import EmotionState
from agentface.face import Face
from agentface.head.model import HeadModel
from agentface.parameters import NEUTRAL, FacePose, indices_of
from agentface.requests import SetEmotions
from agentface.speech.visemes import viseme_table
from agentface.vrm.expressions import expression_table

_TABLE = expression_table()
EMOTIONS = tuple(name for name, row in _TABLE.items() if row.emotions)
VISEMES = {name: row.viseme for name, row in _TABLE.items() if row.viseme is not None}
"""VRM's mouth shapes and the visemes that they are."""
BLINKS = {name: "" if len(row.closes) > 1 else f"_{row.closes[0][0]}" for name, row in _TABLE.items() if row.closes}
LOOKS = {name: row.looks for name, row in _TABLE.items() if row.looks is not None}
"""Parts of the way to the left edge and to the upper edge of the eye's hole."""
_LIDS = "orbicularis_oculi_palpebralis"


def emotion_pose(face: Face, name: str) -> FacePose:
    """What ``face`` shows of an emotion by VRM's name, and of nothing else."""
    face.neutral(0.0)
    face.apply(SetEmotions(EmotionState.of(_TABLE[name].emotions), 0.0))
    face.step(0.0)
    return face.pose


def viseme_pose(name: str) -> FacePose:
    """A mouth shape by VRM's name."""
    return FacePose(viseme_table()[VISEMES[name]].values.copy())


def blink_pose(name: str) -> FacePose:
    """One or two closed eyes."""
    return _pose({f"{_LIDS}{BLINKS[name]}": 1.0})


def look_pose(model: HeadModel, name: str) -> FacePose:
    """Eyes at an edge of their holes, with the lids that follow them."""
    aside, up = LOOKS[name]
    return _pose(
        {
            "gaze_yaw": math.radians(aside * model.eyes.yaw_limit_deg),
            "gaze_pitch": math.radians(up * model.eyes.pitch_limit_deg),
        }
    )


def together(first: FacePose, second: FacePose) -> FacePose:
    """Both at once, as the face shows it: of each parameter the one that is farther from rest."""
    a, b = first.array, second.array
    return FacePose(np.where(np.abs(a) >= np.abs(b), a, b))


def _pose(values: dict[str, float]) -> FacePose:
    pose = NEUTRAL.copy()
    for name, value in values.items():
        pose[list(indices_of(name))] = value
    return FacePose(pose)
