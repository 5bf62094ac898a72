"""A glTF document with materials, nodes, skins and animations, built piece by piece; every piece is known by number.

Source: Khronos Group, glTF 2.0 Specification (ISO/IEC 12113:2022), chapters 3.5 to 3.11.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.errors import InvalidValueError
from agentface.io.gltf.face_parts import FacePart
from agentface.mesh.gltf_buffer import GltfBuffer

_STILL_M, _STILL_NORMAL = 1e-6, 2e-3
"""What moves or turns less is not written."""
_SPARSE = 0.8
"""The part of the vertices up to which a sparse accessor is smaller."""
_COLOUR_STEPS = np.float32(65535)
_WEIGHT_STEPS = 65535


class Target(NamedTuple):
    """A morph target: how far it moves places in m, and changes normals; ``(N, 3)`` each, or no normals."""

    places: Floats
    normals: Floats | None = None


class GltfWriter(GltfBuffer):
    """Collects the pieces; :meth:`content` is the file."""

    def __init__(self, copyright_line: str) -> None:
        super().__init__()
        self.document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "agentface", "copyright": copyright_line},
            "scene": 0,
            "scenes": [{"nodes": []}],
        }

    def content(self) -> bytes:
        """The GLB file."""
        return self.binary(self.document)

    def use(self, extension: str) -> None:
        """Name an extension that pieces of the document have."""
        names: list[str] = self.document.setdefault("extensionsUsed", [])
        if extension not in names:
            names.append(extension)

    def add(self, kind: str, piece: Mapping[str, Any]) -> int:
        """A piece of the document's list ``kind``."""
        pieces: list[Any] = self.document.setdefault(kind, [])
        pieces.append(dict(piece))
        return len(pieces) - 1

    def picture(self, name: str, raw: bytes, mime: str) -> int:
        """A texture of a PNG or JPEG file's bytes."""
        image = self.image(name, raw, mime)
        if "samplers" not in self.document:
            self.add("samplers", {"magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071})
        return self.add("textures", {"source": image, "sampler": 0, "name": name})

    def image(self, name: str, raw: bytes, mime: str) -> int:
        """An image of a PNG or JPEG file's bytes."""
        return self.add("images", {"name": name, "bufferView": self.view(raw), "mimeType": mime})

    def mesh(
        self, part: FacePart, rest: tuple[Floats, Floats], material: int, targets: Mapping[str, Target], joints: bool
    ) -> int:
        """The mesh of a part at ``rest``; with ``joints`` it hangs on two: the head, and for what stays, the body."""
        places, normals = rest
        attributes = {
            "POSITION": self.attribute("POSITION", np.asarray(places, np.float32)),
            "NORMAL": self.attribute("NORMAL", _unit(normals)),
        }
        if part.uv is not None:
            attributes["TEXCOORD_0"] = self.attribute("TEXCOORD_0", np.asarray(part.uv, np.float32))
        if part.colours is not None:
            steps = np.round(_COLOUR_STEPS * np.clip(part.colours, 0.0, 1.0)).astype(np.uint16)
            attributes["COLOR_0"] = self.attribute("COLOR_0", steps)
        if joints:
            attributes |= self._joints(part, len(places))
        primitive: dict[str, Any] = {
            "attributes": attributes,
            "indices": self.triangles(part.triangles, len(places)),
            "material": material,
        }
        extras = {}
        if targets:
            primitive["targets"] = [self._target(name, target) for name, target in targets.items()]
            extras = {"targetNames": list(targets)}
        return self.add(
            "meshes", {"name": part.name, "primitives": [primitive], **({"extras": extras} if extras else {})}
        )

    def skin(self, name: str, joints: Sequence[int], at: Doubles) -> int:
        """A skin whose joints, unturned, stand at ``at (J, 3)`` m in the axes of the meshes that hang on it."""
        bind = np.tile(np.eye(4, dtype=np.float32), (len(joints), 1, 1))
        bind[:, 3, :3] = -at  # glTF has columns first
        return self.add(
            "skins", {"name": name, "joints": list(joints), "inverseBindMatrices": self.numbers(bind.reshape(-1, 16))}
        )

    def animation(self, name: str, times_s: Doubles, tracks: Sequence[NodeTrack]) -> int:
        """What nodes do at some times, and linearly between them."""
        times = self.numbers(np.asarray(times_s, np.float32))
        samplers = [
            {"input": times, "output": self.numbers(track.values), "interpolation": "LINEAR"} for track in tracks
        ]
        channels = [
            {"sampler": number, "target": {"node": track.node, "path": track.path}}
            for number, track in enumerate(tracks)
        ]
        return self.add("animations", {"name": name, "samplers": samplers, "channels": channels})

    def _joints(self, part: FacePart, count: int) -> dict[str, int]:
        if part.stays is None:
            raise InvalidValueError(part.name, "a part that rides as the skin", part.rides)
        body = np.round(_WEIGHT_STEPS * np.clip(part.stays.astype(np.float64), 0.0, 1.0)).astype(np.uint16)
        weights, joints = np.zeros((count, 4), np.uint16), np.zeros((count, 4), np.uint8)
        weights[:, 0], weights[:, 1] = _WEIGHT_STEPS - body, body
        joints[:, 1] = body > 0  # a joint without weight is to be number 0
        return {"JOINTS_0": self.attribute("JOINTS_0", joints), "WEIGHTS_0": self.attribute("WEIGHTS_0", weights)}

    def _target(self, name: str, target: Target) -> dict[str, int]:
        found = {"POSITION": self._offsets(name, "POSITION", target.places, _STILL_M)}
        if target.normals is not None:
            found["NORMAL"] = self._offsets(name, "NORMAL", target.normals, _STILL_NORMAL)
        return found

    def _offsets(self, shape: str, name: str, offsets: Floats, still: float) -> int:
        moved = np.flatnonzero(np.abs(offsets).max(axis=1) > still).astype(np.int32)
        if len(moved) <= _SPARSE * len(offsets):
            return self.sparse(f"shape {shape}", moved, offsets[moved], len(offsets))
        return self.attribute(name, np.asarray(offsets, np.float32))


class NodeTrack(NamedTuple):
    """What one node does: ``values`` a row a time; of weights, ``(T * W,)``."""

    node: int
    path: Literal["translation", "rotation", "scale", "weights"]
    values: Floats


def quaternions(rotations: Floats) -> Floats:
    """``(T, 4)`` float32 x, y, z, w of rotation matrices ``(T, 3, 3)``, none turned over from one row to the next."""
    from scipy.spatial.transform import Rotation

    rows = Rotation.from_matrix(np.asarray(rotations, np.float64)).as_quat()
    flips = np.cumprod(np.where((rows[1:] * rows[:-1]).sum(axis=1) < 0.0, -1.0, 1.0))
    rows[1:] *= flips[:, None]
    return np.asarray(rows, np.float32)


def _unit(normals: Floats) -> Floats:
    """Unit normals: where a vertex has none, straight ahead."""
    rows = np.asarray(normals, np.float64)
    length = np.linalg.norm(rows, axis=1, keepdims=True)
    return np.where(length > 1e-6, rows / np.maximum(length, 1e-6), [0.0, 0.0, 1.0]).astype(np.float32)


def moved_between(rest: tuple[Floats, Floats], there: tuple[Floats, Floats]) -> Target:
    """The target that brings a mesh at ``rest`` to where it is ``there``."""
    return Target(there[0] - rest[0], _unit(there[1]) - _unit(rest[1]))
