"""The bones of an avatar: those that VRM 1.0 demands, and the neck and eyes; a face has a body of none of its own.

Source: VRM Consortium, VRMC_vrm-1.0, humanoid.md: fifteen bones are required, the avatar stands with its arms to its
sides and looks along +Z.
"""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles
from agentface.head.model import HeadModel
from agentface.io.gltf.figure import Joints, eyes_of, neck_of
from agentface.io.gltf.writer import GltfWriter

EYE_BONES = {"eye_l": "leftEye", "eye_r": "rightEye"}
_EYE_HEIGHT = 1.55
"""m: where the model's origin, which is about between the eyes, is over the ground."""
_BODY = "chest"
_SPINE = {"hips": 0.93, "spine": 1.06, _BODY: 1.20}
"""m over the ground."""
_NECK_LENGTH = 0.09
_SIDED = {
    "UpperLeg": ("hips", 0.09, 0.88), "LowerLeg": ("UpperLeg", 0.09, 0.48), "Foot": ("LowerLeg", 0.09, 0.08),
    "UpperArm": (_BODY, 0.17, 1.36), "LowerArm": ("UpperArm", 0.43, 1.36), "Hand": ("LowerArm", 0.67, 1.36),
}  # fmt: skip
"""Parent, m from the median plane, m over the ground."""


def bones_of(model: HeadModel) -> dict[str, tuple[str | None, Doubles]]:
    """The bones by VRM's name, parents first: the parent, and where the bone is, ``(3,)`` m over the ground."""
    origin = np.array([0.0, _EYE_HEIGHT, 0.0])
    head = origin + neck_of(model)
    bones: dict[str, tuple[str | None, Doubles]] = {}
    parent: str | None = None
    for name, height in _SPINE.items():
        bones[name] = parent, np.array([0.0, height, head[2]])
        parent = name
    bones["neck"] = parent, head - [0.0, _NECK_LENGTH, 0.0]
    bones["head"] = "neck", head
    for eye, centre in eyes_of(model).items():
        bones[EYE_BONES[eye]] = "head", origin + centre
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for name, (above, aside, height) in _SIDED.items():
            bones[f"{side}{name}"] = (
                above if above in bones else f"{side}{above}",
                np.array([sign * aside, height, head[2]]),
            )
    return bones


def add_bones(writer: GltfWriter, model: HeadModel) -> tuple[Joints, dict[str, int]]:
    """The bones as nodes under one root: what the face hangs on, and the nodes by VRM's names."""
    bones = bones_of(model)
    nodes: dict[str, int] = {}
    for name, (parent, at) in bones.items():
        above = np.zeros(3) if parent is None else bones[parent][1]
        nodes[name] = writer.add("nodes", {"name": name, "translation": (at - above).tolist()})
        if parent is not None:
            writer.document["nodes"][nodes[parent]].setdefault("children", []).append(nodes[name])
    root = writer.add("nodes", {"name": model.name, "children": [nodes["hips"]]})
    writer.document["scenes"][0]["nodes"].append(root)
    own = {"body": _BODY, "head": "head", **EYE_BONES}
    joints = Joints(
        {name: nodes[bone] for name, bone in own.items()},
        {name: bones[bone][1] for name, bone in own.items()},
        np.array([0.0, _EYE_HEIGHT, 0.0]),
    )
    return joints, nodes
