"""The expressions of an avatar, baked: each a shape of all meshes, and what it keeps blinks and mouth shapes from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from agentface.conventions import SIDES, Doubles, Indices
from agentface.deform.geometry import FaceGeometry
from agentface.deform.protocol import Deformer
from agentface.face import Face
from agentface.head.model import HeadModel
from agentface.io.gltf.arkit_shapes import bake_arkit
from agentface.io.gltf.face_parts import FacePart, released
from agentface.io.gltf.surface import Surface
from agentface.io.gltf.writer import Target, moved_between
from agentface.io.vrm.presets import (
    BLINKS,
    EMOTIONS,
    LOOKS,
    VISEMES,
    blink_pose,
    emotion_pose,
    look_pose,
    together,
    viseme_pose,
)
from agentface.parameters import FacePose

OFF_MM = 4.0
"""mm: where lids or lips are farther than that from where the face has them, an emotion holds the other back."""
NEUTRAL = "neutral"
Told = Callable[[float], object]


@dataclass(frozen=True)
class Expression:
    """One expression.

    Attributes:
        targets: by part, what it moves at 1.
        overrides: of ``mouth`` and ``blink``, what is held back while it is shown.
        custom: whether it is none of VRM's presets.
    """

    targets: dict[str, Target]
    overrides: tuple[str, ...] = ()
    custom: bool = False


class ExpressionBaker:
    """Bakes the expressions of one face.

    Args:
        face: shows the emotions; at rest.
        deformer: what makes shapes of poses.
        parts: the face's meshes.
    """

    def __init__(self, face: Face, deformer: Deformer, parts: list[FacePart]) -> None:
        self._face, self._deformer, self._model = face, deformer, face.model
        self._surface = Surface(face.model, parts)
        self._eyes = {part.name: part for part in parts if part.rides in ("eye_l", "eye_r")}
        self._lids, self._lips = lid_vertices(face.model), lip_vertices(face.model)

    def baked(self, told: Told = lambda _: None) -> dict[str, Expression]:
        """VRM's eighteen presets, and ARKit's 52 as custom ones; ``told`` gets how many are done."""
        emotions = {name: emotion_pose(self._face, name) for name in EMOTIONS}
        visemes = {name: viseme_pose(name) for name in VISEMES}
        blinks = {name: blink_pose(name) for name in BLINKS}
        found = {NEUTRAL: Expression({})}
        for name, pose in (emotions | visemes | blinks).items():
            overrides: tuple[str, ...] = ()
            if name in emotions:
                overrides = self._overrides(pose, list(visemes.values()), list(blinks.values()))
            found[name] = Expression(self._surface.targets(self._shown(pose)), overrides)
            told(len(found))
        for name in LOOKS:
            shown = self._shown(look_pose(self._model, name))
            found[name] = Expression(self._surface.targets(shown) | self._turned_eyes(shown))
            told(len(found))
        presets = len(found)
        shapes, _ = bake_arkit(self._model, self._deformer, self._surface, lambda done: told(presets + done))
        return found | {name: Expression(targets, custom=True) for name, targets in shapes.items()}

    def _shown(self, pose: FacePose) -> FaceGeometry:
        return released(self._model, self._deformer.at(pose))

    def _overrides(self, emotion: FacePose, visemes: list[FacePose], blinks: list[FacePose]) -> tuple[str, ...]:
        found = []
        for name, others, where in (("mouth", visemes, self._lips), ("blink", blinks, self._lids)):
            if max(self.off_mm(emotion, other, where) for other in others) > OFF_MM:
                found.append(name)
        return tuple(found)

    def off_mm(self, first: FacePose, second: FacePose, where: Indices) -> float:
        """mm: how far the sum of two shapes is off from the two poses at once, at the farthest of some vertices."""
        rows = [self._moved(pose, where) for pose in (first, second, together(first, second))]
        return float(1e3 * np.linalg.norm(rows[0] + rows[1] - rows[2], axis=1).max())

    def _moved(self, pose: FacePose, where: Indices) -> Doubles:
        return np.asarray(self._shown(pose).vertices[where] - self._model.vertices[where], np.float64)

    def _turned_eyes(self, shown: FaceGeometry) -> dict[str, Target]:
        found = {}
        for number, side in enumerate(SIDES):
            rest = self._eyes[f"eye_{side}"].at(shown)
            turn = shown.eye_rotations[number].T
            found[f"eye_{side}"] = moved_between(rest, (rest[0] @ turn, rest[1] @ turn))
        return found


def lid_vertices(model: HeadModel) -> Indices:
    """``(N,)``: the vertices of the lids' rings."""
    rings = [ring for side in SIDES for ring in model.eyelids.rings[side]]
    return np.unique(np.array([vertex for ring in rings for vertex in (*ring.upper, *ring.lower)], np.int32))


def lip_vertices(model: HeadModel) -> Indices:
    """``(N,)``: the vertices of the lips' rings."""
    return np.unique(np.array([v for ring in model.lips.rings for v in (*ring.upper, *ring.lower)], np.int32))
