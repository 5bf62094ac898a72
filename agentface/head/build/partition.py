"""Assigns the skin's vertices to the paper's eleven regions and to the sub-regions, on the symmetric base head.

All coordinates here are those of the undeformed base mesh, in decimetres, so one partition serves every identity.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import SIDES, Doubles, Indices
from agentface.head.build.loops import border_loops, rings
from agentface.head.regions import HALF_REGIONS, REGIONS, REST, SUB_REGIONS
from agentface.head.ring_names import RINGS_BEYOND, RINGS_WITHIN, LipRing

_RINGS_IN = 6
_MUCOSA = 2
_CORNER_FROM = 0.92
_LID_RINGS, _LID_RINGS_IN_REGION = 10, 7
_BROW = ((0.130, 7.455), (0.162, 7.457), (0.337, 7.502), (0.483, 7.452), (0.53, 7.41))
_BROW_HALF_HEIGHT = 0.04


@dataclass(frozen=True, slots=True)
class Loops:
    """Ordered rings of base vertices.

    Attributes:
        lips: the lip seam, then the rings outward over the vermilion to the skin.
        mouth: the rings from the seam inward.
        lids: for each side, the lid's inner margin, then the rings outward.
        ends: the rings on the skin and inside the mouth as far as the lips count on them.
    """

    lips: list[list[int]]
    mouth: list[list[int]]
    lids: dict[str, list[list[int]]]
    ends: tuple[list[int], list[int]]


def find_loops(face: Indices, bag: Indices, sockets: dict[str, Indices]) -> Loops:
    """The rings round the mouth and the eyes, from the quads of the face skin, the mouth bag and the sockets."""
    seam = border_loops(bag)[0]
    lids = {}
    for side, quads in sockets.items():
        margin = border_loops(quads)[0]
        lids[side] = [margin, *rings(margin, face, _LID_RINGS)]
    outward, inward = rings(seam, face, LipRing.SKIN + RINGS_BEYOND), rings(seam, bag, RINGS_WITHIN)
    return Loops([seam, *outward[: LipRing.SKIN]], inward[:_RINGS_IN], lids, (outward[-1], inward[-1]))


def halves(ring: list[int], positions: Doubles) -> tuple[list[int], list[int]]:
    """A ring cut at its two lateral ends: the upper half and the lower half, both from +x to -x, ends included."""
    # of two ends that are equally far the higher one, so that mirrored rings are cut at mirrored vertices
    first = max(range(len(ring)), key=lambda i: tuple(positions[ring[i], :2]))
    turned = ring[first:] + ring[:first]
    last = max(range(len(turned)), key=lambda i: tuple(positions[turned[i], :2] * [-1, 1]))
    one, other = turned[: last + 1], [turned[0], *turned[: last - 1 : -1]]
    return (one, other) if positions[one, 1].mean() > positions[other, 1].mean() else (other, one)


def base_labels(positions: Doubles, loops: Loops) -> dict[str, Doubles]:
    """Fields ``(N, 1)`` over the base vertices that, lifted to the skin, tell lips and lids from the rest.

    ``above`` is positive where a vertex belongs to the upper half of the face, negative to the lower half.
    """
    count = len(positions)
    x, y = np.abs(positions[:, 0]), positions[:, 1]
    above = np.sign(y - (6.585 + 0.35 * np.maximum(x - 0.25, 0.0)))  # the corner of the mouth is the middle face's
    lips, lids, lid_above = np.zeros(count), np.zeros(count), np.sign(y - 7.29)
    for depth, ring in [*enumerate(loops.lips), *((-1 - i, ring) for i, ring in enumerate(loops.mouth))]:
        upper, lower = halves(ring, positions)
        # at the corners, where both lips end, height decides as on the skin beside them
        between = [vertex for vertex in lower if x[vertex] < _CORNER_FROM * x[lower].max()]
        above[between], above[upper] = -1.0, 1.0
        lips[ring] = -_MUCOSA - 1 <= depth <= LipRing.BORDER
    for all_rings in loops.lids.values():
        for depth, ring in enumerate(all_rings):
            upper, lower = halves(ring, positions)
            lid_above[lower], lid_above[upper] = -1.0, 1.0
            lids[ring] = depth < _LID_RINGS_IN_REGION
    named = {"above": above, "lips": lips, "lids": lids, "lid_above": lid_above}
    return {name: values[:, None].astype(np.float64) for name, values in named.items()}


def partition(points: Doubles, labels: dict[str, Doubles], bag: Doubles) -> tuple[Indices, Indices]:
    """The region of each skin vertex, an index into REGIONS, and its sub-region, an index into SUB_REGIONS plus one.

    ``points (V, 3)`` and the labels ``(V, 1)`` are those of the base head at the skin's vertices; ``bag`` is
    near 1 inside the mouth. Vertices on the midline count as the right side's.
    """
    x, y, z = np.abs(points[:, 0]), points[:, 1], points[:, 2]
    above, lips, lids, lid_above = (labels[name][:, 0] for name in ("above", "lips", "lids", "lid_above"))
    half = np.where(above > 0, HALF_REGIONS.index("middle_face"), HALF_REGIONS.index("lower_face"))
    half[(y > 7.27) & ((x > 0.30) | (y > 7.32)) & (bag[:, 0] < 0.5)] = HALF_REGIONS.index("upper_face")
    half[(lids > 0.5) & (lid_above > 0)] = HALF_REGIONS.index("upper_eyelid")
    half[(lids > 0.5) & (lid_above <= 0)] = HALF_REGIONS.index("lower_eyelid")
    rest = (z < 0.70) | (y > 8.06) | (y < 6.10) | ((x > 0.64) & (z < 0.78)) | (z < 0.80) & (y < 6.25)
    rest |= (bag[:, 0] > 0.75) & (z < 1.05)
    right = points[:, 0] < 1e-6
    region = np.where(rest, REGIONS.index(REST), half + np.where(right, 0, len(HALF_REGIONS)))
    sub = np.zeros(len(points), np.int32)
    names = list(SUB_REGIONS)
    is_lip = (lips > 0.5) & ~rest
    sub[is_lip & (half == HALF_REGIONS.index("lower_face"))] = 1 + names.index("lower_lip")
    sub[is_lip & (half == HALF_REGIONS.index("middle_face"))] = 1 + names.index("upper_lip")
    curve = np.array(_BROW)
    on_brow = (x > curve[0, 0]) & (x < curve[-1, 0]) & (np.abs(y - np.interp(x, *curve.T)) < _BROW_HALF_HEIGHT)
    sub[on_brow & ~rest & (half == HALF_REGIONS.index("upper_face"))] = 1 + names.index("eyebrow")
    return region.astype(np.int32), sub


def order_by_region(region: Indices, sub: Indices, points: Doubles) -> Indices:
    """The order that sorts vertices by region, sub-region and place, so that neighbours are near in memory."""
    cells = ((points - points.min(0)) / 0.05).astype(np.int64)
    key = np.zeros(len(points), np.int64)
    for bit in range(8):
        for axis in range(3):
            key |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return np.lexsort((key, sub, region)).astype(np.int32)


def ranges(region: Indices, sub: Indices) -> tuple[dict[str, list[int]], dict[str, list[int]]]:
    """The first and last vertex of each region and sub-region of ordered vertices."""
    regions = {name: _range(region == i) for i, name in enumerate(REGIONS)}
    subs = {}
    for i, name in enumerate(SUB_REGIONS):
        for side in SIDES:
            owner = REGIONS.index(f"{SUB_REGIONS[name]}_{side}")
            subs[f"{name}_{side}"] = _range((region == owner) & (sub == i + 1))
    return regions, subs


def _range(inside: np.typing.NDArray[np.bool_]) -> list[int]:
    where = np.flatnonzero(inside)
    assert len(where) == where[-1] - where[0] + 1, "vertices are not ordered by region"  # noqa: S101 - build tool
    return [int(where[0]), int(where[-1])]
