"""VRM's preset expressions as poses of this face: its own emotions, visemes, blinks and looks.

Source: VRM Consortium, VRMC_vrm-1.0, expressions.md.
"""

from __future__ import annotations

import math

import numpy as np

from agentface.agents.faces import default_faces
from agentface.face import Face
from agentface.head.model import HeadModel
from agentface.parameters import NEUTRAL, FacePose, indices_of
from agentface.requests import SetEmotions
from agentface.speech.visemes import viseme_table

EMOTIONS = ("happy", "angry", "sad", "relaxed", "surprised")
VISEMES = {"aa": "aa", "ih": "ih", "ou": "ou", "ee": "E", "oh": "oh"}
"""VRM's mouth shapes and the visemes that they are."""
BLINKS = {"blink": "", "blinkLeft": "_l", "blinkRight": "_r"}
LOOKS = {"lookUp": (0.0, 1.0), "lookDown": (0.0, -1.0), "lookLeft": (1.0, 0.0), "lookRight": (-1.0, 0.0)}
"""Parts of the way to the left edge and to the upper edge of the eye's hole."""
_LIDS = "orbicularis_oculi_palpebralis"


def emotion_pose(face: Face, name: str) -> FacePose:
    """What ``face`` shows of an emotion by VRM's name, and of nothing else."""
    face.neutral(0.0)
    face.apply(SetEmotions(default_faces()[name], 0.0))
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
