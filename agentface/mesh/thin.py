"""Thins out triangles where detail is not needed: half-edge collapses, quadric errors (Garland, Heckbert 1997)."""

from __future__ import annotations

import heapq

import numpy as np

from agentface.conventions import Doubles, Indices

_SMALLEST_ANGLE = 0.12
_LARGEST_TURN = 0.6


class Thinner:
    """Half-edge collapses on one half of a symmetric mesh; vertices never move, so the mesh stays a subset."""

    def __init__(self, positions: Doubles, triangles: Indices, free: np.typing.NDArray[np.bool_]) -> None:
        self.positions = positions
        self.free = free
        self.faces = {i: tuple(map(int, face)) for i, face in enumerate(triangles)}
        self.at: dict[int, set[int]] = {}
        for i, face in self.faces.items():
            for corner in face:
                self.at.setdefault(corner, set()).add(i)
        self.quadrics = np.zeros((len(positions), 4, 4))
        for face in self.faces.values():
            a, b, c = positions[list(face)]
            normal = np.cross(b - a, c - a)
            area = np.linalg.norm(normal)
            plane = np.append(normal, -normal @ a) / max(area, 1e-12)
            self.quadrics[list(face)] += area * np.outer(plane, plane)

    def run(self, count: int) -> Indices:
        """Remove up to ``count`` free vertices, cheapest first; returns the triangles left."""
        heap = [cost for vertex in np.flatnonzero(self.free) if vertex in self.at for cost in self._costs(int(vertex))]
        heapq.heapify(heap)
        removed = 0
        while heap and removed < count:
            cost, vertex, target = heapq.heappop(heap)
            if vertex not in self.at or target not in self._neighbours(vertex):
                continue
            now = self._cost(vertex, target)
            if now > cost * 1.0001 + 1e-15:
                heapq.heappush(heap, (now, vertex, target))
            elif self._allowed(vertex, target):
                self._collapse(vertex, target)
                removed += 1
                for other in self._neighbours(target):
                    if self.free[other]:
                        for item in self._costs(other):
                            heapq.heappush(heap, item)
        return np.array(list(self.faces.values()), np.int32)

    def _neighbours(self, vertex: int) -> set[int]:
        return {corner for face in self.at[vertex] for corner in self.faces[face]} - {vertex}

    def _costs(self, vertex: int) -> list[tuple[float, int, int]]:
        return [(self._cost(vertex, target), vertex, target) for target in sorted(self._neighbours(vertex))]

    def _cost(self, vertex: int, target: int) -> float:
        point = np.append(self.positions[target], 1.0)
        length = float(np.linalg.norm(self.positions[vertex] - self.positions[target]))
        return float(point @ (self.quadrics[vertex] + self.quadrics[target]) @ point) + 1e-6 * length

    def _allowed(self, vertex: int, target: int) -> bool:
        faces = self.at[vertex]
        ring = self._neighbours(vertex)
        if len(faces) != len(ring) or len(ring & self._neighbours(target)) != 2:
            return False  # an open border, or a collapse that would pinch the surface
        for face in faces:
            old = self.faces[face]
            if target in old:
                continue
            before = self.positions[list(old)]
            after = self.positions[[target if corner == vertex else corner for corner in old]]
            turn = _unit_normal(before) @ _unit_normal(after)
            if turn < _LARGEST_TURN or smallest_angle(after) < _SMALLEST_ANGLE:
                return False
        return True

    def _collapse(self, vertex: int, target: int) -> None:
        self.quadrics[target] += self.quadrics[vertex]
        for face in self.at.pop(vertex):
            old = self.faces[face]
            if target in old:
                del self.faces[face]
                for corner in set(old) - {vertex}:
                    self.at[corner].discard(face)
            else:
                self.faces[face] = tuple(target if corner == vertex else corner for corner in old)
                self.at[target].add(face)


def _unit_normal(corners: Doubles) -> Doubles:
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    return normal / (np.linalg.norm(normal) + 1e-12)


def smallest_angle(corners: Doubles) -> float:
    """The smallest angle of a triangle ``(3, 3)`` in radians."""
    sides = corners[[1, 2, 0]] - corners
    sides /= np.sqrt((sides * sides).sum(1, keepdims=True)) + 1e-12
    cosines = -(sides * sides[[2, 0, 1]]).sum(1)
    return float(np.arccos(min(max(cosines.max(), -1.0), 1.0)))
