"""What all faces made from the base mesh share: triangles, vertex order, regions, rings and landmarks."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.head.build.partition import Loops, base_labels, find_loops, halves, order_by_region, partition, ranges
from agentface.head.build.source import BaseMesh
from agentface.head.build.splits import WHOLE, across_rings, between_rings
from agentface.head.build.topology import SkinTopology
from agentface.head.regions import REGIONS, REST
from agentface.head.ring_names import LidRing, LipRing
from agentface.mesh.thin import Thinner

_FACE, _BAG, _BODY, _SOCKETS = 0, 1, 2, {"r": 3, "l": 6}
_NECK_BOTTOM = 5.6
_THINNED, _THINNED_EARS = 140, 30
_LID_SPLITS = (6, 7)
"""Base rings of the lids behind which another one is put in: the crease above the upper lid is deep and narrow."""
_CORNER_SPLITS = (0, 1, 2)
"""Edges of the lower lip from its corner on through which another column is put in, where the base mesh is coarse."""

# Landmarks that are vertices of the base mesh; left ones, whose mirror images are the right ones.
_EXACT = {
    "nasion": 132, "nose_tip": 5054, "subnasale": 343, "upper_lip_middle": 455, "lower_lip_middle": 492,
    "pogonion": 733,
    "brow_inner_l": 6983, "brow_middle_l": 6996, "brow_outer_l": 6999, "inner_canthus_l": 6850, "outer_canthus_l": 6805,
    "mouth_corner_l": 7272, "ear_front_l": 12324,
}  # fmt: skip
# The others, as the vertex nearest to a place on the base head, in decimetres.
_NEAREST = {
    "glabella": (0, 7.44, 1.50), "hairline_middle": (0, 7.98, 1.30), "chin_fold": (0, 6.45, 1.50),
    "menton": (0, 6.27, 1.42),
    "infraorbital_l": (0.29, 7.08, 1.40), "cheekbone_l": (0.46, 7.05, 1.27), "zygion_l": (0.60, 7.12, 1.05),
    "alare_l": (0.135, 6.87, 1.50), "upper_lip_side_l": (0.13, 6.705, 1.56), "lower_lip_side_l": (0.13, 6.53, 1.53),
    "cheek_l": (0.42, 6.75, 1.30), "jaw_side_l": (0.35, 6.36, 1.25), "gonion_l": (0.58, 6.50, 0.85),
}  # fmt: skip


class HeadTopology:
    """What all faces of the base mesh share: triangles, vertex order, regions, rings, landmarks."""

    def __init__(self, mesh: BaseMesh) -> None:
        self.mesh = mesh
        quads, island = mesh.quads["body"], mesh.islands()
        at = mesh.positions[quads]
        neck = (island == _BODY) & (at[..., 1].min(1) > _NECK_BOTTOM) & (np.abs(at[..., 0]).max(1) < 0.9)
        chosen = (island == _FACE) | (island == _BAG) | neck
        self.quads = quads[chosen]
        sockets = {side: quads[island == number] for side, number in _SOCKETS.items()}
        self.loops: Loops = find_loops(quads[island == _FACE], quads[island == _BAG], sockets)
        self.bag_vertices = np.setdiff1d(quads[island == _BAG], self.loops.lips[0])
        levels = self._levels(island[chosen])
        self.skin = SkinTopology(self.quads, levels, mesh.positions, mesh.mirror, self._splits(levels))
        self.points: Doubles
        self.region: Indices
        self.sub: Indices
        self._partition()
        self._thin()
        self._partition()
        order = order_by_region(self.region, self.sub, self.points)
        self.skin.reorder(order)
        self.region, self.sub, self.points = self.region[order], self.sub[order], self.points[order]
        self.regions, self.sub_regions = ranges(self.region, self.sub)

    def _levels(self, island: Indices) -> Indices:
        """How often to subdivide each quad: finest on the forehead, where furrows are narrow; never across a ring."""
        corners = self.mesh.positions[self.quads]
        middle = corners.mean(1)
        x, y, z = np.abs(middle[:, 0]), middle[:, 1], middle[:, 2]
        wanted = np.full(len(corners), np.float64(1e3))
        wanted[(y > 6.3) & (y < 7.15) & (x > 0.12) & (x < 0.50) & (z > 1.0)] = 0.040
        wanted[(y > 7.12) & (y < 7.40) & (x > 0.43) & (x < 0.64) & (z > 0.85)] = 0.030
        wanted[(y > 7.18) & (y <= 7.46) & (x < 0.14) & (z > 1.2)] = 0.026
        wanted[(y > 7.44) & (y < 7.94) & (z > 0.92) & (x < 0.60)] = 0.036
        wanted[(y > 7.44) & (y < 7.86) & (z > 0.92) & (x < 0.50)] = 0.0195
        whole = [*self.loops.lips[: LipRing.SKIN], *(ring for rings in self.loops.lids.values() for ring in rings[:8])]
        wanted[(island == _BAG) | np.isin(self.quads, np.concatenate(whole)).any(1)] = 1e3
        edge = np.linalg.norm(corners - np.roll(corners, 1, 1), axis=2).mean(1)
        return np.clip(np.round(np.log2(edge / wanted)), 0, 2).astype(np.int32)

    def _splits(self, levels: Indices) -> Indices:
        """How to halve each quad that is not subdivided."""
        result = np.zeros(len(self.quads), np.int32)
        for lids in self.loops.lids.values():
            for depth in _LID_SPLITS:
                result = np.maximum(result, between_rings(self.quads, lids[depth], lids[depth + 1]))
        lower = halves(self.loops.lips[0], self.mesh.positions)[1]
        edges = [(lower[i], lower[i + 1]) for i in _CORNER_SPLITS]
        edges += [(lower[-1 - i], lower[-2 - i]) for i in _CORNER_SPLITS]
        result = np.maximum(result, across_rings(self.quads, edges, [set(ring) for ring in self.loops.ends]))
        return np.where(levels == 0, result, WHOLE).astype(np.int32)

    def _partition(self) -> None:
        mesh, skin = self.mesh, self.skin
        labels = {name: skin.place(field) for name, field in base_labels(mesh.positions, self.loops).items()}
        self.points = skin.place(mesh.positions)
        self.region, self.sub = partition(self.points, labels, skin.place(self._indicator(self.bag_vertices)))

    def _thin(self) -> None:
        """Drop vertices of the rest of the head: ears, mouth bag, skull and neck need few."""
        skin, rest = self.skin, self.region == REGIONS.index(REST)
        free = rest & (self.points[:, 0] > 1e-6)
        free[np.unique(skin.triangles[~rest[skin.triangles].all(1)])] = False
        free[[self._index_of(vertex) for vertex in _EXACT.values()]] = False
        half = skin.triangles[: len(skin.triangles) // 2]
        ear = np.abs(self.points[:, 0]) > 0.68
        left = Thinner(self.points, half, free & ~ear).run(_THINNED)
        left = Thinner(self.points, left, free & ear).run(_THINNED_EARS)
        skin.keep(np.concatenate([left, skin.mirror[left[:, ::-1]]]))

    def _indicator(self, vertices: Indices, values: float = 1.0) -> Doubles:
        field = np.zeros((self.mesh.count, 1))
        field[vertices] = values
        return field

    def _index_of(self, base_vertex: int) -> int:
        (where,) = np.flatnonzero(self.skin.kept == base_vertex)
        return int(where)

    def _between(self, inner: list[int], outer: list[int]) -> tuple[list[int], list[int]]:
        """The ring that was put in between two base rings."""
        beside = {a: self.skin.middle(a, b) for a in inner for b in outer if self.skin.middle(a, b) in self._place}
        upper, lower = ([self._place[beside[vertex]] for vertex in half] for half in halves(inner, self.mesh.positions))
        return upper, lower

    @cached_property
    def _place(self) -> dict[int, int]:
        return {int(vertex): place for place, vertex in enumerate(self.skin.kept)}

    def halves(self, base_ring: list[int]) -> tuple[list[int], list[int]]:
        """A ring of base vertices as skin vertices, with those put in between: the upper half and the lower half."""
        upper, lower = (
            [self._place[vertex] for vertex in self.skin.with_middles(half, self._place)]
            for half in halves(base_ring, self.mesh.positions)
        )
        return upper, lower

    def lid_rings(self, side: str) -> list[tuple[list[int], list[int]]]:
        """The rings of an eye in the order of :class:`LidRing`."""
        base = self.loops.lids[side]
        rings = []
        for depth, ring in enumerate(base):
            rings.append(self.halves(ring))
            if depth in _LID_SPLITS:
                rings.append(self._between(ring, base[depth + 1]))
        return rings

    @cached_property
    def landmarks(self) -> dict[str, dict[str, Any]]:
        """The landmarks of ``feature_points.yaml``."""
        found = {name: self._index_of(vertex) for name, vertex in _EXACT.items()}
        for name, place in _NEAREST.items():
            found[name] = int(np.linalg.norm(self.points - place, axis=1).argmin())
        for name, ring_half in (("lid_upper_l", 0), ("lid_lower_l", 1)):
            found[name] = self._lid_middle(ring_half)
        for name in [name for name in found if name.endswith("_l")]:
            found[f"{name[:-2]}_r"] = int(self.skin.mirror[found[name]])
        return {name: {"vertices": [found[name]]} for name in sorted(found)}

    def _lid_middle(self, half: int) -> int:
        ring = self.lid_rings("l")[LidRing.EDGE][half]
        across = self.points[ring, 0]
        return ring[int(np.abs(across - 0.5 * (across.min() + across.max())).argmin())]

    @cached_property
    def material(self) -> Doubles:
        """``(V, 4)`` weights 0..1: lip, inside of the mouth, wet lid margin, ear."""
        lip, mouth, wet = (np.zeros((self.mesh.count, 1)) for _ in range(3))
        mouth[self.bag_vertices] = 1.0
        for depth, ring in enumerate(self.loops.lips):
            lip[ring] = 1.0 if depth <= 6 else (0.45 if depth == 7 else 0.0)
        for depth, ring in enumerate(self.loops.mouth[:3]):
            lip[ring] = 1.0 if depth < 2 else 0.6
            mouth[ring] = (0.30, 0.60, 0.85)[depth]  # their backs lie in the shade of the mouth
        for rings_of_eye in self.loops.lids.values():
            for depth, weight in enumerate((1.0, 1.0, 0.8, 0.25)):
                wet[rings_of_eye[depth]] = weight
        x, y, z = np.abs(self.points[:, :1]), self.points[:, 1:2], self.points[:, 2:]
        ear = np.clip((x - 0.66) / 0.06, 0, 1) * (np.abs(y - 7.05) < 0.5) * (z > 0.1) * (z < 0.85)
        return np.clip(np.hstack([*(self.skin.place(field) for field in (lip, mouth, wet)), ear]), 0, 1)
