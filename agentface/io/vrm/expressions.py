"""The expressions of an avatar, baked: each a shape of all meshes, and what it keeps blinks and mouth shapes from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from agentface.conventions import SIDES, Doubles, Indices
from agentface.deform.geometry import FaceGeometry
from agentface.deform.protocol import Deformer
from agentface.emotion.inference import default_inference
from agentface.head.model import HeadModel
from agentface.io.gltf.arkit_shapes import bake_arkit
from agentface.io.gltf.face_parts import FacePart, released
from agentface.io.gltf.surface import Surface
from agentface.io.gltf.writer import Target, moved_between
from agentface.parameters import FacePose
from agentface.vrm.expression_poses import ExpressionPoses
from agentface.vrm.expressions import PRESETS

OFF_MM = 4.0
"""mm: where lids or lips are farther than that from where the face has them, an emotion holds the other back."""
Told = Callable[[float], object]


@dataclass(frozen=True)
class BakedExpression:
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
        model: the face.
        deformer: what makes shapes of poses.
        parts: the face's meshes.
    """

    def __init__(self, model: HeadModel, deformer: Deformer, parts: list[FacePart]) -> None:
        self._model, self._deformer = model, deformer
        self._surface = Surface(model, parts)
        self._eyes = {part.name: part for part in parts if part.rides in ("eye_l", "eye_r")}
        self._lids, self._lips = lid_vertices(model), lip_vertices(model)
        self._poses = ExpressionPoses(model, default_inference())

    def baked(self, told: Told = lambda _: None) -> dict[str, BakedExpression]:
        """VRM's eighteen presets, and ARKit's 52 as custom ones; ``told`` gets how many are done."""
        found = {}
        for name, preset in self._poses.table.items():
            shown = self._shown(self.pose(name))
            targets = self._surface.targets(shown)
            if preset.looks is not None:
                targets |= self._turned_eyes(shown)
            found[name] = BakedExpression(targets, self._overrides(name) if preset.emotions else ())
            told(len(found))
        shapes, _ = bake_arkit(self._model, self._deformer, self._surface, lambda done: told(len(PRESETS) + done))
        return found | {name: BakedExpression(targets, custom=True) for name, targets in shapes.items()}

    def pose(self, name: str) -> FacePose:
        """What the face does for a preset at 1."""
        return FacePose(self._poses.pose({name: 1.0})[0])

    def _shown(self, pose: FacePose) -> FaceGeometry:
        return released(self._model, self._deformer.at(pose))

    def _overrides(self, emotion: str) -> tuple[str, ...]:
        table, found = self._poses.table, []
        visemes = [name for name, preset in table.items() if preset.viseme is not None]
        blinks = [name for name, preset in table.items() if preset.closes]
        for what, others, where in (("mouth", visemes, self._lips), ("blink", blinks, self._lids)):
            if max(self.off_mm(self.pose(emotion), self.pose(other), where) for other in others) > OFF_MM:
                found.append(what)
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


def together(first: FacePose, second: FacePose) -> FacePose:
    """Both at once, as the face shows it: of each parameter the one that is farther from rest."""
    a, b = first.array, second.array
    return FacePose(np.where(np.abs(a) >= np.abs(b), a, b))


def lid_vertices(model: HeadModel) -> Indices:
    """``(N,)``: the vertices of the lids' rings."""
    rings = [ring for side in SIDES for ring in model.eyelids.rings[side]]
    return np.unique(np.array([vertex for ring in rings for vertex in (*ring.upper, *ring.lower)], np.int32))


def lip_vertices(model: HeadModel) -> Indices:
    """``(N,)``: the vertices of the lips' rings."""
    return np.unique(np.array([v for ring in model.lips.rings for v in (*ring.upper, *ring.lower)], np.int32))
