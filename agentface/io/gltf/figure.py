"""The nodes of a face in a glTF scene: a body, a head that turns on it, eyes that turn in the head, and the meshes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from agentface.conventions import SIDES, Doubles
from agentface.deform.finish import head_turn
from agentface.deform.geometry import FaceGeometry
from agentface.head.model import HeadModel
from agentface.io.gltf.face_parts import FacePart
from agentface.io.gltf.writer import GltfWriter, Target


class Figure:
    """Adds the meshes of a face to a document whose joints are there.

    Args:
        writer: the document.
        model: the face.
        body, head: the nodes on which it hangs; unturned, the head's stands at the neck.
        eyes: the nodes of the left and the right eye, at their centres.
        origin: ``(3,)`` m, where the model's origin stands in the document's axes.
    """

    def __init__(
        self, writer: GltfWriter, model: HeadModel, body: int, head: int, eyes: Sequence[int], origin: Doubles
    ) -> None:
        self._writer, self._origin = writer, np.asarray(origin, np.float64)
        self._on = {"body": body, "head": head, "eye_l": eyes[0], "eye_r": eyes[1]}
        self._neck = neck_of(model)
        self._skin: int | None = None
        self.rest = FaceGeometry.at_rest(model)
        self.meshes: dict[str, int] = {}
        """The nodes of the parts by name."""

    def add(self, part: FacePart, material: int, targets: Mapping[str, Target]) -> int:
        """A part with its morph targets; returns its node."""
        skinned = part.rides == "skin"
        places, normals = part.at(self.rest)
        shift = self._shift(part)
        mesh = self._writer.mesh(part, ((places + shift).astype(np.float32), normals), material, targets, skinned)
        piece = {"name": part.name, "mesh": mesh}
        if skinned:
            node = self._writer.add("nodes", {**piece, "skin": self._hanging()})
            self._writer.document["scenes"][0]["nodes"].append(node)
        else:
            node = self._writer.add("nodes", piece)
            self._writer.document["nodes"][self._on[part.rides]].setdefault("children", []).append(node)
        self.meshes[part.name] = node
        return node

    def _shift(self, part: FacePart) -> Doubles:
        """From a part's axes to its node's: joints have no turn at rest, a head's parts are about the neck."""
        if part.rides == "skin":
            return self._origin
        return -self._neck if part.rides == "head" else np.zeros(3)

    def _hanging(self) -> int:
        if self._skin is None:
            joints = [self._on["head"], self._on["body"]]
            self._skin = self._writer.skin("neck", joints, self._origin + np.stack([self._neck, np.zeros(3)]))
        return self._skin


def neck_of(model: HeadModel) -> Doubles:
    """``(3,)`` m: about which point the head turns."""
    return head_turn.prepare(model).neck.astype(np.float64)


def add_joints(writer: GltfWriter, model: HeadModel) -> tuple[int, int, tuple[int, int]]:
    """A body at the model's origin, its head, and the eyes of that: for a scene of a face alone."""
    neck = neck_of(model)
    eyes = [
        writer.add("nodes", {"name": f"eye_{side}_turn", "translation": (model.eye_centre(side) - neck).tolist()})
        for side in SIDES
    ]
    head = writer.add("nodes", {"name": "head", "translation": neck.tolist(), "children": list(eyes)})
    body = writer.add("nodes", {"name": model.name, "children": [head]})
    writer.document["scenes"][0]["nodes"].append(body)
    return body, head, (eyes[0], eyes[1])


Told = Callable[[float], object]
"""Gets how much of a long piece of work is done."""
