"""MPEG-4's feature points (ISO/IEC 14496-2, Annex C) by rule on the base head: the same vertices on every face.

Left ones are found, right ones are their mirror images. Decimetres, as in the base mesh.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Doubles
from agentface.head.build import mouth_parts
from agentface.head.build.head_topology import HeadTopology
from agentface.head.build.source import BaseMesh
from agentface.head.ring_names import LipRing

_LANDMARKS = {
    "2.1": "menton", "2.10": "pogonion", "2.13": "gonion_l", "3.1": "lid_upper_l", "3.3": "lid_lower_l",
    "3.7": "outer_canthus_l", "3.11": "inner_canthus_l", "4.1": "brow_inner_l", "4.3": "brow_middle_l",
    "4.5": "brow_outer_l", "5.1": "cheek_l", "5.3": "cheekbone_l", "9.1": "alare_l", "9.3": "nose_tip",
    "9.15": "subnasale", "11.1": "hairline_middle",
}  # fmt: skip
_RIGHT_OF = {
    "2.4": "2.5", "2.6": "2.7", "2.8": "2.9", "2.11": "2.12", "2.13": "2.14", "3.1": "3.2", "3.3": "3.4", "3.7": "3.12",
    "3.9": "3.10", "3.11": "3.8", "3.13": "3.14", "4.1": "4.2", "4.3": "4.4", "4.5": "4.6", "5.1": "5.2", "5.3": "5.4",
    "8.3": "8.4", "8.5": "8.6", "8.7": "8.8", "8.10": "8.9", "9.1": "9.2", "9.5": "9.4", "9.7": "9.6", "9.13": "9.14",
    "10.1": "10.2", "10.3": "10.4", "10.5": "10.6", "10.7": "10.8", "10.9": "10.10", "11.3": "11.2",
}  # fmt: skip
_PLACES = {"3.5": "pupil_l", "3.6": "pupil_r", "7.1": "neck"}
_ABSENT = {"11.5": "the thickness of the hair over 11.4: hair is a style that the head wears, and no part of it"}
_LID_OUTER = 6
"""The ring where the lid's plate ends and its soft skin begins: the outer points of the lids."""
_EAR = {
    "10.1": (0.837, 7.326, 0.484), "10.3": (0.851, 7.156, 0.358), "10.5": (0.721, 6.841, 0.578),
    "10.7": (0.692, 6.880, 0.641), "10.9": (0.754, 7.266, 0.600),
}  # fmt: skip
"""Places on the left ear."""
_BRIDGE, _BONE_END = 0.06, 0.38
"""Half the width of the bridge of the nose; the end of its bone, of the way from nasion to tip."""
_FRONT = 0.06  # of what is seen from the front, how far behind the foremost a vertex may lie


def feature_points(topology: HeadTopology) -> dict[str, dict[str, Any]]:
    """The rows of ``feature_points.yaml``, by the number of the point."""
    skin = _Skin(topology)
    found = skin.mouth() | skin.lids() | skin.ears() | {key: skin.mark(name) for key, name in _LANDMARKS.items()}
    skin.complete(found)
    found |= {right: int(topology.skin.mirror[found[left]]) for left, right in _RIGHT_OF.items()}
    rows: dict[str, dict[str, Any]] = {key: {"vertex": vertex} for key, vertex in found.items()}
    rows |= {key: {"mesh": mesh, "vertex": vertex} for key, (mesh, vertex) in _mouth_parts(topology.mesh).items()}
    rows |= {key: {"place": name} for key, name in _PLACES.items()}
    rows |= {key: {"absent": reason} for key, reason in _ABSENT.items()}
    return dict(sorted(rows.items(), key=lambda row: tuple(map(int, row[0].split(".")))))


class _Skin:
    """Finds vertices of the skin."""

    def __init__(self, topology: HeadTopology) -> None:
        self._topology, self._at = topology, topology.points

    def mark(self, landmark: str) -> int:
        return int(self._topology.landmarks[landmark]["vertices"][0])

    def mouth(self) -> dict[str, int]:
        """The points of two rings of the lips: where they touch, and the border of the red."""
        found: dict[str, int] = {}
        rings = self._topology.loops.lips
        inner, outer = (self._topology.halves(rings[ring]) for ring in (LipRing.CONTACT, LipRing.BORDER))
        for (upper, lower), keys in (
            (inner, ("2.2", "2.3", "2.4", "2.6", "2.8")),
            (outer, ("8.1", "8.2", "8.3", "8.5", "8.7")),
        ):
            ends = self._middle(upper), self._middle(lower), upper[0], self._halfway(upper), self._halfway(lower)
            found |= dict(zip(keys, ends, strict=True))
        border = self._at[outer[0]]
        bow = (border[:, 0] > 0.001) & (border[:, 0] < self._at[found["8.5"], 0])
        found["8.10"] = int(np.array(outer[0])[bow][border[bow, 1].argmax()])
        return found

    def lids(self) -> dict[str, int]:
        """The outer points, straight above and below the middles of the lids' edges."""
        halves = self._topology.lid_rings("l")[_LID_OUTER]
        marks = self.mark("lid_upper_l"), self.mark("lid_lower_l")
        found = {}
        for key, half, mark in zip(("3.13", "3.9"), halves, marks, strict=True):
            found[key] = int(half[np.abs(self._at[half, 0] - self._at[mark, 0]).argmin()])
        return found

    def ears(self) -> dict[str, int]:
        """The left ear's extremes, and where it joins the face."""
        return {key: int(np.linalg.norm(self._at - place, axis=1).argmin()) for key, place in _EAR.items()}

    def complete(self, found: dict[str, int]) -> None:
        """Add the points that are told by others: sides of chin and nose, the nose's bone, hairline and skull."""
        nasion, tip = self._at[self.mark("nasion")], self._at[found["9.3"]]
        found["2.11"] = self._seen(0.65 * self._at[found["2.4"], 0], self._at[found["2.10"], 1])
        found["9.12"] = self._seen(0.0, nasion[1] + _BONE_END * (tip[1] - nasion[1]))
        found["9.13"] = self._seen(_BRIDGE, self._at[found["9.12"], 1])
        found["9.7"] = self._seen(_BRIDGE, nasion[1])
        found["9.5"] = self._seen(0.75 * self._at[found["9.1"], 0], self._at[found["9.15"], 1])
        ear, hairline = self._at[self.mark("ear_front_l")], self._at[found["11.1"]]
        found["11.3"] = self._seen(0.68 * ear[0], hairline[1] - 0.12)
        found["11.4"] = int(self._at[:, 1].argmax())
        found["11.6"] = int(np.where(self._at[:, 1] > ear[1], self._at[:, 2], np.inf).argmin())

    def _middle(self, half: list[int]) -> int:
        return int(half[np.abs(self._at[half, 0]).argmin()])

    def _halfway(self, half: list[int]) -> int:
        """The vertex in the middle of the way along a half from its left end to the middle of the mouth."""
        left = half[: half.index(self._middle(half)) + 1]
        steps = np.linalg.norm(np.diff(self._at[left], axis=0), axis=1)
        way = np.concatenate([[0.0], steps.cumsum()])
        return int(left[np.abs(way - 0.5 * way[-1]).argmin()])

    def _seen(self, x: float, y: float) -> int:
        """The vertex nearest to a place of the face that is seen from the front."""
        away = np.hypot(self._at[:, 0] - x, self._at[:, 1] - y)
        nearest = np.argsort(away, kind="stable")[:6]
        ahead = self._at[nearest, 2]
        nearest = nearest[ahead > ahead.max() - _FRONT]
        return int(nearest[away[nearest].argmin()])


def _mouth_parts(mesh: BaseMesh) -> dict[str, tuple[str, int]]:
    """Points of tongue and teeth, of the base mesh's: the parts of every face have the same vertices."""
    tongue = mouth_parts.tongue(mesh.positions, mesh.quads["helper-tongue"]).positions
    x, y, z = tongue.T
    tip = int((z - np.abs(x)).argmax())
    half = np.abs(z - 0.5 * (z.max() + z.min())) < 0.15 * np.ptp(z)  # the middle of its length
    body = int(np.where(half, y - np.abs(x), -np.inf).argmax())
    left = int(np.where(half, x - np.abs(z - z[body]), -np.inf).argmax())
    right = int(np.linalg.norm(tongue - tongue[left] * [-1, 1, 1], axis=1).argmin())
    found = {f"6.{i + 1}": ("tongue", vertex) for i, vertex in enumerate((tip, body, left, right))}
    for row, edge_key, neck_key in (("upper", "9.10", "9.8"), ("lower", "9.11", "9.9")):
        strip = mesh.positions[np.unique(mesh.quads[f"helper-{row}-teeth"])]
        edge, neck = _incisor(mouth_parts.dental_arch(strip, upper=row == "upper"), upper=row == "upper")
        found |= {edge_key: (f"teeth_{row}", edge), neck_key: (f"teeth_{row}", neck)}
    return found


def _incisor(arch: mouth_parts.PartMesh, *, upper: bool) -> tuple[int, int]:
    """The edge of a first incisor, and the front of its neck, which lies in the gum."""
    x, y, z = arch.positions.T
    height = (1.0 if upper else -1.0) * y + np.where(arch.material[:, 0] > 0.0, 0.0, np.nan)
    aside: Doubles = np.abs(x) - 0.1 * z
    return int(np.nanargmin(height + aside)), int(np.nanargmax(height - 5.0 * aside))
