"""Poses of every kind that a face may take: what a basis is made of, and what it is measured by."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.face import Face
from agentface.head.model import HeadModel
from agentface.motion.gestures.table import all_gestures
from agentface.parameters import COUNT, HIGH, LOW, NEUTRAL, PARAMETERS
from agentface.requests import Gesture, SetEmotions, SetGaze, SetHead, SetLiveliness, ShowViseme
from agentface.speech.visemes import viseme_table

_HEAD = [known.index for known in PARAMETERS if known.kind == "head"]
_TONGUE = [known.index for known in PARAMETERS if known.kind == "tongue"]
_SHARES = (0.05, 0.12, 0.25)
"""Of the parameters that a random mixture moves."""
_STEP_S = 0.1
_CHANGES = 6  # steps


def random_mixtures(count: int, rng: np.random.Generator, *, tongue: float = 0.0) -> Floats:
    """``(count, COUNT)`` float32: some parameters anywhere in their ranges, the others and the head at rest.

    What no face would do, too: both lids shut over wide eyes, the tongue out of a bitten lip. At least the share
    ``tongue`` of the tongue's parameters is moved.
    """
    shares = np.array(_SHARES)[np.arange(count) % len(_SHARES)]
    likely = np.repeat(shares[:, None], COUNT, axis=1)
    likely[:, _TONGUE] = np.maximum(likely[:, _TONGUE], tongue)
    moved = rng.random((count, COUNT)) < likely
    values = np.where(moved, LOW + (HIGH - LOW) * rng.random((count, COUNT)), NEUTRAL).astype(np.float32)
    values[:, _HEAD] = 0.0
    return np.clip(values, LOW, HIGH)


def natural_poses(model: HeadModel, count: int, rng: np.random.Generator, *, head: bool = False) -> Floats:
    """``(count, COUNT)`` float32: a lively face that mixes emotions, speaks, looks about, gestures and blinks.

    The ``head`` is straight where it is not asked for.
    """
    face = Face(model, seed=int(rng.integers(1 << 31)))
    face.apply(SetLiveliness(1.0, 0.0))
    visemes, gestures = tuple(viseme_table()), tuple(all_gestures(None))
    poses = np.empty((count, COUNT), np.float32)
    for step in range(count):
        if step % _CHANGES == 0:
            _ask(face, rng, visemes, gestures)
        face.step(_STEP_S)
        poses[step] = face.pose.array
    face.close()
    if not head:
        poses[:, _HEAD] = 0.0
    return poses


def _ask(face: Face, rng: np.random.Generator, visemes: tuple[str, ...], gestures: tuple[str, ...]) -> None:
    felt = rng.choice(EMOTIONS, size=int(rng.integers(0, 3)), replace=False)
    face.apply(SetEmotions(EmotionState.of({str(name): float(rng.random()) for name in felt}), 0.3))
    for name in rng.choice(visemes, size=2, replace=False):
        face.apply(ShowViseme(str(name), float(rng.random()), 2.0 * _STEP_S))
    yaw, pitch = rng.normal(0.0, (15.0, 10.0)).clip((-50.0, -40.0), (50.0, 40.0))
    face.apply(SetGaze(float(yaw), float(pitch)))
    face.apply(SetHead(*(float(angle) for angle in rng.normal(0.0, 12.0, 3).clip(-50.0, 50.0))))
    if rng.random() < 0.3:
        face.apply(Gesture(str(rng.choice(gestures)), 1.0))
