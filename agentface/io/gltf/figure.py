"""The nodes of a face in a glTF scene: a body, a head that turns on it, eyes that turn in the head, and the meshes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from agentface.conventions import SIDES, Doubles
from agentface.deform.finish import head_turn
from agentface.deform.geometry import FaceGeometry
from agentface.head.model import HeadModel
from agentface.io.gltf.face_parts import FacePart
from agentface.io.gltf.writer import GltfWriter, Target


@dataclass(frozen=True)
class Joints:
    """The nodes that a face hangs on, and where they stand.

    Attributes:
        nodes: of ``body``, ``head``, ``eye_l`` and ``eye_r``; none is turned.
        at: ``(3,)`` m, where each of them stands in the scene.
        origin: ``(3,)`` m, where the model's origin is.
    """

    nodes: dict[str, int]
    at: dict[str, Doubles]
    origin: Doubles


class Figure:
    """Adds the meshes of a face to a document whose joints are there."""

    def __init__(self, writer: GltfWriter, model: HeadModel, joints: Joints) -> None:
        self._writer, self._joints = writer, joints
        self._skin: int | None = None
        self._rest = FaceGeometry.at_rest(model)

    def add(self, part: FacePart, material: int, targets: Mapping[str, Target]) -> int:
        """A part with its morph targets; returns its node."""
        skinned = part.rides == "skin"
        places, normals = part.at(self._rest)
        rest = (places + self._shift(part)).astype(np.float32), normals
        piece = {"name": part.name, "mesh": self._writer.mesh(part, rest, material, targets, skinned)}
        if skinned:  # its joints alone say where it is
            node = self._writer.add("nodes", {**piece, "skin": self._hanging()})
            self._writer.document["scenes"][0]["nodes"].append(node)
        else:
            node = self._writer.add("nodes", piece)
            self._writer.document["nodes"][self._joints.nodes[part.rides]].setdefault("children", []).append(node)
        return node

    def _shift(self, part: FacePart) -> Doubles:
        """From the axes of a part to those of its node."""
        if part.rides == "skin":
            return self._joints.origin
        if part.rides in ("eye_l", "eye_r"):
            return np.zeros(3)
        return self._joints.origin - self._joints.at[part.rides]

    def _hanging(self) -> int:
        if self._skin is None:
            names = ("head", "body")
            at = np.stack([self._joints.at[name] for name in names])
            self._skin = self._writer.skin("neck", [self._joints.nodes[name] for name in names], at)
        return self._skin


def neck_of(model: HeadModel) -> Doubles:
    """``(3,)`` m: about which point the head turns."""
    return head_turn.prepare(model).neck.astype(np.float64)


def add_joints(writer: GltfWriter, model: HeadModel) -> Joints:
    """A body at the model's origin, its head, and the eyes of that: for a scene of a face alone."""
    at = {"body": np.zeros(3), "head": neck_of(model)} | eyes_of(model)
    nodes = {
        name: writer.add("nodes", {"name": f"{name}_turn", "translation": (at[name] - at["head"]).tolist()})
        for name in ("eye_l", "eye_r")
    }
    children = list(nodes.values())
    nodes["head"] = writer.add("nodes", {"name": "head", "translation": at["head"].tolist(), "children": children})
    nodes["body"] = writer.add("nodes", {"name": model.name, "children": [nodes["head"]]})
    writer.document["scenes"][0]["nodes"].append(nodes["body"])
    return Joints(nodes, at, np.zeros(3))


def eyes_of(model: HeadModel) -> dict[str, Doubles]:
    """``(3,)`` m by ``eye_l`` and ``eye_r``: their centres."""
    return {f"eye_{side}": model.eye_centre(side).astype(np.float64) for side in SIDES}
