"""Neighbouring muscles do not squash the skin between them flat.

Two muscles that pull towards each other, or one that pulls towards skin which it may not move, shorten the skin between
them; real skin bulges there, a surface would turn over. For a corner p of a triangle with the opposite edge a b, let
h = p − (1−w) a − w b be its height, with w the foot's place on the edge at rest, h₀ the height at rest, and
q = h·h₀ / |h₀|² what is left of it. Where q falls below q₀ it is raised to

    q' = q₀ − (q₀ − q₁) s / (1 + s),     s = (q₀ − q) / (q₀ − q₁),

smooth in value and slope and above q₁, by moving p, a and b along h₀ by least squares, as 1, w − 1 and −w; what no
muscle moves stays. Heights follow each other in groups without a common vertex, outward from where the skin is held; a
height and its mirror image move at the same time, so that a mirrored face stays mirrored.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.muscles.vector_muscle import pull
from agentface.head.model import HeadModel

Numbers = npt.NDArray[np.int64]
Masks = npt.NDArray[np.bool_]
_PASSES = 3
_LEAST, _FLAT = 0.35, 0.02
_MOVED = 1e-5
_STIFF = 0.1  # of a whole give: a height of which no vertex has more stays as it is


class SquashTables(NamedTuple):
    """The heights that the face's muscles can squash, each beside its mirror image.

    Attributes:
        vertices: ``(K, 2, 3)`` int32, corner and edge of each height and of its image.
        foot: ``(K, 2)`` float32, where the height stands on the edge, from its first end to its second.
        height: ``(K, 2, 3)`` float32 m, from foot to corner at rest.
        measure: ``(K, 2, 3)`` float32 1/m, the height over its square.
        gives: ``(K, 2, 3)`` float32, how far the three vertices go along the height to restore the whole of it.
        groups: ``(G + 1,)`` int32, where each group begins.
        least: q₀, the part left of a height below which it is raised.
        flat: q₁, the part to which it is raised from any depth.
        passes: how often all groups have their turn.
    """

    vertices: Indices
    foot: Floats
    height: Floats
    measure: Floats
    gives: Floats
    groups: Indices
    least: float
    flat: float
    passes: int


def prepare(model: HeadModel) -> SquashTables:
    """The heights that all vector muscles together could bring below ``least``."""
    names = model.muscles.names
    points = model.vertices.astype(np.float64)
    moves = [pull(model.muscles, i, points, 1.0) for i, name in enumerate(names) if name.endswith("_l")]
    moved = np.any([np.linalg.norm(move, axis=1) > _MOVED for move in moves], axis=0)
    free = (moved | moved[model.mirror]).astype(np.float64)
    every = np.ones(len(points), np.bool_)
    return tables_of(model, moves, free, every, outward=np.zeros(len(points)), lost=1.0 - _LEAST, passes=_PASSES)


def tables_of(
    model: HeadModel, moves: list[Doubles], free: Doubles, near: Masks, *, outward: Doubles, lost: float, passes: int
) -> SquashTables:
    """The heights of which ``moves`` and their mirror images together could take ``lost`` or more.

    Triangles with a flat angle at the corner are left out.

    Args:
        model: the face.
        moves: displacements ``(V, 3)`` m from rest, each of which can come with all the others.
        free: ``(V,)`` 0..1, mirror-symmetric, how readily each vertex gives way.
        near: ``(V,)`` mirror-symmetric, the vertices of which a height needs one.
        outward: ``(V,)`` mirror-symmetric: heights where its sum is least have their turn first.
        lost: part of a height.
        passes: how often all groups have their turn.
    """
    points = model.vertices.astype(np.float64)
    corners = np.concatenate([np.roll(model.triangles, -i, axis=1) for i in range(3)])
    corners = corners[near[corners].any(axis=1) & (free[corners] > _STIFF).any(axis=1)]
    foot, height = _heights(points, corners)
    # a foot far outside its edge is another corner's business
    inside = (foot > -0.3) & (foot < 1.3)
    corners, foot, height = corners[inside], foot[inside], height[inside]
    image = _images(model, corners)
    loss = _largest_loss(moves, corners, foot, height)
    chosen = np.flatnonzero((loss + loss[image] > lost) & (np.arange(len(corners)) <= image))
    chosen = chosen[np.argsort(outward[corners[chosen]].sum(axis=1), kind="stable")]
    groups, order = _groups(corners[chosen], corners[image[chosen]])
    chosen = chosen[order]
    pair = np.stack([chosen, image[chosen]], axis=1)
    parts = np.stack([np.ones(pair.shape), foot[pair] - 1.0, -foot[pair]], axis=2)
    gives = parts * free[corners[pair]]
    gives /= (gives * parts).sum(axis=2, keepdims=True)
    gives[pair[:, 0] == pair[:, 1]] *= 0.5
    square = (height[pair] ** 2).sum(axis=2, keepdims=True)
    return SquashTables(
        vertices=np.ascontiguousarray(corners[pair], np.int32),
        foot=foot[pair].astype(np.float32),
        height=height[pair].astype(np.float32),
        measure=(height[pair] / square).astype(np.float32),
        gives=gives.astype(np.float32),
        groups=groups,
        least=_LEAST,
        flat=_FLAT,
        passes=passes,
    )


def apply(tables: SquashTables, points: Floats) -> None:
    """Raise the squashed heights of ``points (P, 3)`` m in place; points without any stay as they are."""
    least, reach = np.float32(tables.least), np.float32(tables.least - tables.flat)
    for _ in range(tables.passes):
        for first, last in zip(tables.groups[:-1], tables.groups[1:], strict=True):
            group = slice(first, last)
            corner, a, b = np.moveaxis(tables.vertices[group], 2, 0)
            foot = tables.foot[group][..., None]
            height = points[corner] - points[a] - foot * (points[b] - points[a])
            left = (height * tables.measure[group]).sum(axis=2)
            s = np.maximum(least - left, 0.0) / reach
            push = reach * s * s / (1.0 + s)
            along = push[..., None] * tables.height[group]
            for i, vertices in enumerate((corner, a, b)):
                np.add.at(points, vertices, tables.gives[group, :, i, None] * along)


def _heights(points: Doubles, corners: Indices) -> tuple[Doubles, Doubles]:
    p, a, b = np.moveaxis(points[corners], 1, 0)
    edge = b - a
    foot = ((p - a) * edge).sum(axis=1) / (edge**2).sum(axis=1)
    return foot, p - a - foot[:, None] * edge


def _images(model: HeadModel, corners: Indices) -> Numbers:
    """``(N,)`` for each height the number of its mirror image."""

    def keys(vertices: Numbers) -> Numbers:
        count = np.int64(len(model.vertices))
        ends = np.sort(vertices[:, 1:], axis=1)
        return (vertices[:, 0] * count + ends[:, 0]) * count + ends[:, 1]

    own = keys(corners.astype(np.int64))
    order = np.argsort(own)
    return order[np.searchsorted(own[order], keys(model.mirror.astype(np.int64)[corners]))]


def _largest_loss(moves: list[Doubles], corners: Indices, foot: Doubles, height: Doubles) -> Doubles:
    """What ``moves``, each for itself, take from each height ``(N,)``, as parts of it, summed."""
    loss = np.zeros(len(corners))
    measure = height / (height**2).sum(axis=1, keepdims=True)
    for moved in moves:
        touched = np.flatnonzero((moved[corners] != 0.0).any(axis=(1, 2)))
        p, a, b = np.moveaxis(moved[corners[touched]], 1, 0)
        change = p - a - foot[touched, None] * (b - a)
        loss[touched] += np.maximum(-(change * measure[touched]).sum(axis=1), 0.0)
    return loss


def _groups(corners: Indices, images: Indices) -> tuple[Indices, Numbers]:
    """Where each group begins, and the order of the heights by group; each comes after those that it shares with."""
    last: dict[int, int] = {}
    group = np.zeros(len(corners), np.int64)
    for i, vertices in enumerate(np.concatenate([corners, images], axis=1).tolist()):
        group[i] = 1 + max(last.get(vertex, -1) for vertex in vertices)
        last.update(dict.fromkeys(vertices, int(group[i])))
    order = np.argsort(group, kind="stable")
    return np.searchsorted(group[order], np.arange(group.max(initial=-1) + 2)).astype(np.int32), order
