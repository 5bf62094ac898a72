"""Ambient occlusion of the head at rest: how much of the surroundings' light reaches each vertex.

A cloud of points on the surface is looked at from many directions; in each, a picture of depths says which
vertices something covers. Plain numpy, so that the same mesh gives the same bytes everywhere.
"""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Indices

_DIRECTIONS = 56
_PIXEL = 0.0023
_SPACING = 0.0019
_CLEARANCE = 0.0030


def ambient_light(
    vertices: Doubles, triangles: Indices, mirror: Indices, blockers: list[tuple[Doubles, Indices]]
) -> Doubles:
    """``(V,)`` 0..1: the part of a cosine-weighted sky that the skin's vertices see.

    Args:
        vertices: ``(V, 3)`` metres, the skin.
        triangles: ``(T, 3)``, the skin's.
        mirror: ``(V,)``, each vertex's image in the median plane; the result is symmetric.
        blockers: other meshes that take light away: eyeballs, teeth.
    """
    cloud = np.concatenate([_surface_points(*mesh) for mesh in [(vertices, triangles), *blockers]])
    normals = _normals(vertices, triangles)
    lifted = vertices + normals * _CLEARANCE
    seen, due = np.zeros(len(vertices)), np.zeros(len(vertices))
    for direction in half_sphere(_DIRECTIONS):
        cosine = np.maximum(normals @ direction, 0.0)
        seen += cosine * _uncovered(lifted, cloud, direction)
        due += cosine
    # what the other half of the sphere gives a vertex, this half gives its mirror image
    return np.asarray((seen + seen[mirror]) / np.maximum(due + due[mirror], 1e-9))


def half_sphere(count: int) -> Doubles:
    """``(count, 3)`` unit vectors with x > 0; with their mirror images they cover the sphere evenly."""
    steps = np.arange(count) + 0.5
    polar, turn = np.arccos(1 - 2 * steps / count), np.pi * (1 + 5**0.5) * steps
    points = np.stack([np.cos(turn) * np.sin(polar), np.cos(polar), np.sin(turn) * np.sin(polar)], axis=1)
    points[:, 0] = np.abs(points[:, 0])
    return points


def _normals(vertices: Doubles, triangles: Indices) -> Doubles:
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    faces, corners = np.tile(np.cross(b - a, c - a), (3, 1)), triangles.T.ravel()
    sums = np.stack([np.bincount(corners, faces[:, axis], len(vertices)) for axis in range(3)], axis=1)
    return np.asarray(sums / np.maximum(np.linalg.norm(sums, axis=1, keepdims=True), 1e-15))


def _surface_points(vertices: Doubles, triangles: Indices) -> Doubles:
    """Points at most ``_SPACING`` apart on every triangle: a lattice as fine as its longest edge needs."""
    corners = vertices[triangles]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(1)
    steps = np.maximum(np.ceil(longest / _SPACING).astype(int), 1)
    points = []
    for count in np.unique(steps):
        i, j = (grid.ravel() for grid in np.meshgrid(np.arange(count + 1), np.arange(count + 1)))
        inside = i + j <= count
        weights = np.stack([i, j, count - i - j], axis=1)[inside] / count
        points.append((weights @ corners[steps == count]).reshape(-1, 3))
    return np.concatenate(points)


def _uncovered(points: Doubles, cloud: Doubles, direction: Doubles) -> np.typing.NDArray[np.bool_]:
    right = np.cross(direction, [0.0, 0.0, 1.0] if abs(direction[2]) < 0.9 else [1.0, 0.0, 0.0])
    right /= np.linalg.norm(right)
    plane = np.stack([right, np.cross(direction, right)], axis=1)
    at, onto = cloud @ plane, points @ plane
    low = at.min(0) - 2 * _PIXEL
    width, height = np.ceil((at.max(0) - low) / _PIXEL).astype(int) + 3
    nearest = np.full(width * height, -np.inf)
    cells = ((at - low) / _PIXEL).astype(int)
    np.maximum.at(nearest, cells[:, 0] * height + cells[:, 1], cloud @ direction)
    mine = np.clip(((onto - low) / _PIXEL).astype(int), 0, [width - 1, height - 1])
    return np.asarray(points @ direction >= nearest[mine[:, 0] * height + mine[:, 1]])
