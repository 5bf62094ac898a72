"""A face as a GLB file: with ARKit's 52 shapes, or with a performance and the shapes that are its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.deform.geometry import FaceGeometry
from agentface.deform.protocol import Deformer
from agentface.errors import InvalidValueError
from agentface.head.arkit import ARKIT_SHAPES
from agentface.head.look import Look
from agentface.head.model import HeadModel
from agentface.head.provenance import read_provenance
from agentface.io.gltf.arkit_shapes import Shapes, ShapeWeights, bake_arkit
from agentface.io.gltf.face_parts import FacePart, face_parts
from agentface.io.gltf.figure import Figure, Joints, add_joints, eyes_of
from agentface.io.gltf.materials import add_materials
from agentface.io.gltf.modes import ModeFinder
from agentface.io.gltf.recorder import SurfaceRecorder
from agentface.io.gltf.surface import SOFT, Surface
from agentface.io.gltf.writer import GltfWriter, NodeTrack, Target, quaternions

ERROR_MM, MOST_MODES = 0.1, 128
LONGEST = 20_000
"""Frames of an animation."""
Played = Callable[[SurfaceRecorder], object]
"""Plays a performance to a sink."""


@dataclass(frozen=True)
class GlbFace:
    """A file and what there is to say of it: JSON-ready ``figures``."""

    content: bytes
    figures: dict[str, Any]


@dataclass(frozen=True)
class _Shaped:
    """Targets by shape and part, in their order, and the weights ``(T, S)`` of a performance, with its figures."""

    order: tuple[str, ...]
    targets: Mapping[str, Mapping[str, Target]]
    weights: Floats | None
    figures: dict[str, Any]


class FaceGlb:
    """What a GLB file of one face is made of.

    Args:
        model: the face.
        look: its colours.
        deformer: what makes its shapes.
    """

    def __init__(self, model: HeadModel, look: Look, deformer: Deformer) -> None:
        self.model, self.look, self._deformer = model, look, deformer
        self.parts = face_parts(model, look)
        self.surface = Surface(model, self.parts)
        self._rest = FaceGeometry.at_rest(model)
        self._shapes: tuple[Shapes, Doubles] | None = None

    def bake(self, told: Callable[[float], object] = lambda _: None) -> tuple[Shapes, Doubles]:
        """ARKit's shapes and their rows, which :meth:`with_arkit` needs, baked once; ``told`` gets how many are."""
        if self._shapes is None:
            self._shapes = bake_arkit(self.model, self._deformer, self.surface, told)
        return self._shapes

    def with_arkit(self, played: Played | None = None) -> GlbFace:
        """The face with ARKit's shapes, and with what ``played`` plays as nearly as these show it.

        Raises GraphicsError when there is no OpenGL.
        """
        shapes, rows = self.bake()
        if played is None:
            return self._file(_Shaped(ARKIT_SHAPES, shapes, None, {}), None)
        fitting = ShapeWeights(rows)
        recorder = self._recorded(fitting, played)
        errors = {"error_max_mm": fitting.error_max_mm, "error_rms_mm": fitting.error_rms_mm}
        weights = np.asarray(fitting.weights, np.float32)
        return self._file(_Shaped(ARKIT_SHAPES, shapes, weights, errors), recorder)

    def with_modes(self, played: Played, error_mm: float = ERROR_MM, most: int = MOST_MODES) -> GlbFace:
        """The face with a performance, to ``error_mm`` by as few shapes of its own as that takes, at ``most`` so many.

        Raises InvalidValueError for a performance without frames, GraphicsError when there is no OpenGL.
        """
        finder = ModeFinder(self.surface.size)
        recorder = self._recorded(finder, played)
        modes = finder.modes(error_mm, most)
        names = tuple(f"mode_{number}" for number in range(len(modes.ways)))
        targets = {name: self.surface.targets_of(way) for name, way in zip(names, modes.ways, strict=True)}
        errors = {"error_max_mm": modes.error_max_mm, "error_rms_mm": modes.error_rms_mm}
        return self._file(_Shaped(names, targets, np.asarray(modes.weights, np.float32), errors), recorder)

    def _recorded(self, taker: ShapeWeights | ModeFinder, played: Played) -> SurfaceRecorder:
        recorder = SurfaceRecorder(self.model, self.surface, taker)
        played(recorder)
        if not len(recorder):
            raise InvalidValueError("performance", "one frame or more", 0)
        return recorder

    def _file(self, shaped: _Shaped, recorder: SurfaceRecorder | None) -> GlbFace:
        writer = GltfWriter(read_provenance(self.model.folder).copyright_line)
        joints = add_joints(writer, self.model)
        figure = Figure(writer, self.model, joints)
        materials = add_materials(writer, self.model, self.look, self.parts)
        tracks = []
        for part in self.parts:
            still = Target(np.zeros((len(part.at(self._rest)[0]), 3), np.float32))
            # who looks for a shape looks on the skin, which has those that move nothing of it, too
            own = [name for name in shaped.order if part.name in shaped.targets[name] or part.name == SOFT[0]]
            targets = {name: shaped.targets[name].get(part.name, still) for name in own}
            node = figure.add(part, materials[part.material], targets)
            if part.rides == "body" and recorder is not None:
                tracks += _lifted(node, recorder.shoulders)
            if shaped.weights is not None and own:
                columns = [shaped.order.index(name) for name in own]
                tracks.append(NodeTrack(node, "weights", shaped.weights[:, columns].ravel()))
        if recorder is not None:
            tracks += self._turns(recorder, joints)
            writer.animation("performance", recorder.times_s, tracks)
        content = writer.content()
        return GlbFace(content, self._figures(content, shaped, recorder))

    def _turns(self, recorder: SurfaceRecorder, joints: Joints) -> list[NodeTrack]:
        tracks = [NodeTrack(joints.nodes["head"], "rotation", quaternions(recorder.heads))]
        for number, name in enumerate(eyes_of(self.model)):
            tracks.append(NodeTrack(joints.nodes[name], "rotation", quaternions(recorder.eyes[:, number])))
            thrust = recorder.thrusts[:, number]
            if thrust.any():
                centre = joints.at[name] - joints.at["head"]
                tracks.append(NodeTrack(joints.nodes[name], "translation", _forward(centre, thrust)))
        return tracks

    def _figures(self, content: bytes, shaped: _Shaped, recorder: SurfaceRecorder | None) -> dict[str, Any]:
        moving: dict[str, Any] = {}
        if recorder is not None:
            times = recorder.times_s
            moving = {"frames": len(recorder), "duration_s": round(float(times[-1]), 6)}
            moving |= {name: round(value, 6) for name, value in shaped.figures.items()}
        return {
            "face": self.model.name,
            "bytes": len(content),
            "shapes": list(shaped.order),
            "meshes": part_figures(self.model, self.parts),
            **moving,
        }


def part_figures(model: HeadModel, parts: Sequence[FacePart]) -> dict[str, dict[str, int]]:
    """The counts of vertices and triangles by part."""
    rest = FaceGeometry.at_rest(model)
    return {part.name: {"vertices": len(part.at(rest)[0]), "triangles": len(part.triangles)} for part in parts}


def _lifted(node: int, shoulders: Floats) -> list[NodeTrack]:
    """How breath moves the node of what is below the neck, at the model's origin; nothing where it rests."""
    if (shoulders == np.eye(4)).all():
        return []
    scales = np.ascontiguousarray(np.diagonal(shoulders[:, :3, :3], axis1=1, axis2=2))
    return [NodeTrack(node, "scale", scales), NodeTrack(node, "translation", shoulders[:, :3, 3].copy())]


def _forward(centre: Doubles, thrust: Floats) -> Floats:
    places = np.tile(np.asarray(centre, np.float32), (len(thrust), 1))
    places[:, 2] += thrust
    return places
