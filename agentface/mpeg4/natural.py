"""Natural poses, of which a solver learns: two emotions mixed, a viseme, lids, gaze and head."""

from __future__ import annotations

import numpy as np

from agentface.conventions import SIDES, Floats
from agentface.emotion.inference import default_inference
from agentface.emotion.state import EMOTIONS
from agentface.parameters import COUNT, HIGH, LOW, PARAMETERS, indices_of
from agentface.speech.visemes import VISEME_COUNT, visemes

_BLINKS = 0.3
"""The share of poses whose lids are closing."""
_TURNS = {"gaze_yaw": 0.2, "gaze_pitch": 0.1, "head_yaw": 0.2, "head_pitch": 0.1, "head_roll": 0.05}
"""Standard deviations in radians."""
_TOUCHING = [known.index for known in PARAMETERS if known.kind == "contact"]
"""What brings the lips against something, and so hides what else moves them: no pose to learn from has any of it."""


def natural_poses(count: int, draw: np.random.Generator) -> Floats:
    """``(count, COUNT)`` float32."""
    inference, spoken = default_inference(), visemes()
    lids = [indices_of(f"orbicularis_oculi_palpebralis_{side}")[0] for side in SIDES]
    poses = np.zeros((count, COUNT), np.float32)
    for pose in poses:
        first, second = draw.choice(len(EMOTIONS), 2, replace=False)
        state = {EMOTIONS[first]: draw.random(), EMOTIONS[second]: draw.random() ** 2}
        pose[:] = inference.pose(state).array
        said = np.float32(draw.random()) * spoken[draw.integers(VISEME_COUNT)].values
        pose[:] = np.where(np.abs(said) > np.abs(pose), said, pose)
        if draw.random() < _BLINKS:
            pose[lids] = np.maximum(pose[lids], draw.random())
        for name, width in _TURNS.items():
            pose[indices_of(name)[0]] = width * draw.normal()
    poses[:, _TOUCHING] = 0.0
    return np.clip(poses, LOW, HIGH)


def uniform_poses(count: int, draw: np.random.Generator) -> Floats:
    """``(count, COUNT)`` float32: every parameter anywhere in its range, but nothing that brings lips to something."""
    poses = (LOW + (HIGH - LOW) * draw.random((count, COUNT))).astype(np.float32)
    poses[:, _TOUCHING] = 0.0
    return poses
