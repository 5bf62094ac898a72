"""Hair as meshes that lie still: flat strips instead of ribbons that turn to the camera."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.mesh.smoothstep import smoothstep
from agentface.view.hair.ribbons import Hairs, unit_rows
from agentface.view.hair.strands import Strands

_STEPS = np.linspace(0.0, 1.0, 4)
_FORWARD = np.array([0.0, 0.0, 1.0])
_LIGHTER_TIP = 1.2
_OPAQUE = 0.9
_HELD = 0.25
"""Of the distance from the vertical axis: a strand lower than that is lit as if it hung this low."""


@dataclass(frozen=True, slots=True)
class StrandMesh:
    """Strands as strips that lie on the head.

    Attributes:
        offsets: ``(N, 3)`` m from the skin's vertices ``anchors (N,)``.
        normals: ``(N, 3)``, those of the head under them: hair is lit as a whole.
        triangles: ``(T, 3)``.
        colours: ``(N, 3)`` float32, linear.
    """

    offsets: Floats
    anchors: Indices
    normals: Floats
    triangles: Indices
    colours: Floats


def strand_mesh(strands: Strands, skin: Floats, centre: Doubles) -> StrandMesh:
    """Strips of ``strands`` on the ``skin (V, 3)`` round the head's ``centre (3,)`` m."""
    points = strands.points.astype(np.float64)
    count, each = points.shape[:2]
    t = np.linspace(0.0, 1.0, each)
    outward = points - centre
    outward[..., 1] = np.maximum(outward[..., 1], -_HELD * np.hypot(outward[..., 0], outward[..., 2]))
    outward = unit_rows(outward)
    sideways = unit_rows(np.cross(np.gradient(points, axis=1), outward))
    taper = (1.0 - 0.96 * smoothstep(0.62, 1.0, t)) * (0.08 + 0.92 * smoothstep(0.0, 0.12, t))
    reach = sideways * (strands.radii[:, None] * taper)[..., None]
    rows = np.stack([points - reach, points + reach], axis=2) - skin[strands.anchors][:, None, None]
    shade = strands.cover[..., None] * (1.0 + (_LIGHTER_TIP - 1.0) * smoothstep(0.4, 1.0, t))[:, None]
    colours = np.clip(strands.paint[:, None, :3] * shade, 0.0, 1.0)
    return StrandMesh(
        rows.reshape(-1, 3).astype(np.float32),
        np.repeat(strands.anchors, 2 * each),
        np.repeat(outward.reshape(-1, 3), 2, axis=0).astype(np.float32),
        strips(count, each),
        np.repeat(colours.reshape(-1, 3), 2, axis=0).astype(np.float32),
    )


def hair_strips(hairs: Hairs, vertices: Floats, normals: Floats) -> tuple[Floats, Floats]:
    """Places and normals ``(8 H, 3)`` of hairs on a skin, as strips that are seen best from the front.

    The normals are the skin's, as hair is lit as a whole.
    """
    lines = np.stack([hairs.curve(vertices, normals, float(t)) for t in _STEPS], axis=1)
    sideways = unit_rows(np.cross(np.gradient(lines, axis=1), _FORWARD))
    taper = (1.0 - 0.85 * _STEPS**1.6) * np.minimum(1.0, 0.8 + 1.5 * _STEPS)
    reach = sideways * (hairs.radii[:, None] * taper)[..., None]
    facing = hairs.roots.frames(vertices, normals)[1][:, :, 2]
    return (
        np.stack([lines - reach, lines + reach], axis=2).reshape(-1, 3).astype(np.float32),
        np.repeat(facing, 2 * len(_STEPS), axis=0).astype(np.float32),
    )


def hair_triangles(hairs: Hairs) -> Indices:
    """The triangles of :func:`hair_strips`."""
    return strips(len(hairs), len(_STEPS))


def hair_colours(hairs: Hairs, under: Sequence[float]) -> Floats:
    """``(8 H, 3)`` linear, of the same vertices: what of the colour ``under`` them hairs let through is theirs."""
    opaque = _OPAQUE * hairs.paint[:, 3:]
    colours = opaque * hairs.paint[:, :3] + (1.0 - opaque) * np.asarray(under)
    return np.repeat(colours, 2 * len(_STEPS), axis=0).astype(np.float32)


def strips(count: int, each: int) -> Indices:
    """``(T, 3)``: the triangles of ``count`` strips of two vertices at each of ``each`` points."""
    first = (np.arange(count)[:, None] * 2 * each + 2 * np.arange(each - 1)).reshape(-1, 1)
    return np.asarray((first + np.array([0, 1, 2, 1, 3, 2])).reshape(-1, 3), np.int32)
