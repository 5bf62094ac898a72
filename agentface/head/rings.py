"""``lips.yaml`` and ``eyelids.yaml``: rings of vertices round the mouth and each eye, held against the mesh."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Annotated, Any, TypeVar

import numpy as np
from pydantic import Field

from agentface.config import Document, Table
from agentface.conventions import SIDES
from agentface.head.lids import LidMotion
from agentface.head.orbicularis_oris import LipsMotion
from agentface.mesh.glb import MeshArrays

LIP_RINGS = 9
_Half = Annotated[list[int], Field(min_length=3)]
_HALVES = ("upper", "lower")


class RingHalves(Table):
    """One ring of vertices: the upper and the lower half, each from +x to -x with both ends."""

    upper: _Half
    lower: _Half


class LipsFile(LipsMotion):
    """``lips.yaml``: rings round the mouth, from the seam outward, and the ring muscle of the mouth."""

    rings: Annotated[list[RingHalves], Field(min_length=LIP_RINGS, max_length=LIP_RINGS)]


class EyelidsFile(LidMotion):
    """``eyelids.yaml``: rings round each eye, from the lid's inner margin outward, and how the lids move."""

    rings: dict[str, Annotated[list[RingHalves], Field(min_length=1)]]


_Rings = TypeVar("_Rings", LipsFile, EyelidsFile)


def load_rings(path: str | Path, model: type[_Rings], skin: MeshArrays) -> _Rings:
    """Read ``lips.yaml`` or ``eyelids.yaml``; raises DataError also for rings that are none on the mesh ``skin``."""
    document = Document(path)
    file = document.collect(model)
    data = document.data if isinstance(document.data, dict) else {}
    edges = _Edges(skin)
    if model is LipsFile:
        rings = data.get("rings")
        _check_rings(document, ("rings",), rings, edges, len(rings) if isinstance(rings, list) else 0)
        _check_sizes(document, rings)
    else:
        _check_lids(document, data, edges)
    document.check()
    assert file is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    return file


class _Edges:
    """The vertices of a mesh and which of them are joined."""

    def __init__(self, skin: MeshArrays) -> None:
        self.count = len(skin.attributes["POSITION"])
        start, end = np.concatenate([skin.triangles[:, [i, (i + 1) % 3]] for i in range(3)]).astype(np.int64).T
        self._keys = np.unique(np.concatenate([start * self.count + end, end * self.count + start]))

    def joined(self, half: list[int]) -> list[bool]:
        """Whether each vertex but the last is joined to the next."""
        vertices = np.array(half, np.int64)
        keys = vertices[:-1] * self.count + vertices[1:]
        nearest = np.searchsorted(self._keys, keys).clip(max=len(self._keys) - 1)
        joined: list[bool] = (self._keys[nearest] == keys).tolist()
        return joined


def _check_lids(document: Document, data: dict[Any, Any], edges: _Edges) -> None:
    sides, edge_ring = data.get("rings"), data.get("edge_ring")
    if not isinstance(sides, dict):
        return
    if set(sides) != set(SIDES):
        document.fault(("rings",), "the keys l and r", ", ".join(map(str, sides)))
    counts = [len(rings) for rings in sides.values() if isinstance(rings, list)]
    moved = edge_ring + 1 if type(edge_ring) is int else 0
    if counts and moved > min(counts):
        document.fault(("edge_ring",), f"a ring in 0..{min(counts) - 1}", str(edge_ring))
        moved = 0
    for side, rings in sides.items():
        _check_rings(document, ("rings", side), rings, edges, moved)


def _check_rings(document: Document, where: tuple[str, ...], rings: Any, edges: _Edges, woven: int) -> None:
    """Check rings as they were read; the first ``woven`` of them run along edges of the mesh."""
    for i, ring in enumerate(rings if isinstance(rings, list) else []):
        halves = [_half(ring, half) for half in _HALVES]
        good = [
            _check_half(document, (*where, i, name), half, edges, woven=i < woven)
            for name, half in zip(_HALVES, halves, strict=True)
        ]
        upper, lower = halves
        if all(good) and (upper[0], upper[-1]) != (lower[0], lower[-1]):
            got = f"{upper[0]} and {upper[-1]} above, {lower[0]} and {lower[-1]} below"
            document.fault((*where, i), "halves with the same two ends", got)


def _check_half(
    document: Document, where: tuple[str | int, ...], half: list[int], edges: _Edges, *, woven: bool
) -> bool:
    """Whether the vertices are on the mesh and more than one: whether the half has ends."""
    bad = [i for i, vertex in enumerate(half) if not 0 <= vertex < edges.count]
    if bad:
        got = ", ".join(str(half[i]) for i in bad[:4])
        document.fault((*where, bad[0]), f"vertices in 0..{edges.count - 1}", got)
        return False
    twice = [vertex for vertex, count in Counter(half).items() if count > 1]
    if twice:
        document.fault((*where, half.index(twice[0])), "each vertex once", f"{twice[0]} again")
    elif woven and not all(joined := edges.joined(half)):
        i = joined.index(False)
        document.fault((*where, i), "neighbours on the mesh", f"{half[i]}, then {half[i + 1]}")
    return len(half) > 1


def _check_sizes(document: Document, rings: Any) -> None:
    """The lips' surface goes through all rings column by column: they have one size."""
    halves = [[_half(ring, half) for half in _HALVES] for ring in (rings if isinstance(rings, list) else [])]
    sizes = {i: len(upper) + len(lower) - 2 for i, (upper, lower) in enumerate(halves) if upper and lower}
    if not sizes:
        return
    usual = Counter(sizes.values()).most_common(1)[0][0]
    for i, size in sizes.items():
        if size != usual:
            document.fault(("rings", i), f"{usual} vertices, as in the other rings", str(size))


def _half(ring: Any, name: str) -> list[int]:
    """Half a ring as it was read, empty where it is no list of numbers, which its model refuses."""
    half = ring.get(name) if isinstance(ring, dict) else None
    return half if isinstance(half, list) and all(type(vertex) is int for vertex in half) else []
