"""Wrinkles finer than the mesh: an atlas of the face with every train's height, combined once a frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.anatomy.model import HeadModel
from agentface.anatomy.trains import relief
from agentface.anatomy.wrinkles import PlacedTrain
from agentface.conventions import Floats, Indices
from agentface.view.context import compile_program

SIDE = 512
_BELOW, _ABOVE = 0.35, 0.3  # eye separations beyond chin and hairline
_LOWEST = 2e-6  # m
_FAR_ROUND = 2.2  # rad; triangles beyond would cross the atlas where the azimuth jumps


@dataclass(frozen=True, slots=True)
class Patch:
    """One train on the atlas: the rows and columns it covers, and ``(h, w, 2)`` heights in metres and creases 0..1."""

    rows: slice
    columns: slice
    texels: Floats

    def mirrored(self) -> Patch:
        """The same train of the other side."""
        columns = slice(SIDE - self.columns.stop, SIDE - self.columns.start)
        return Patch(self.rows, columns, np.ascontiguousarray(self.texels[:, ::-1]))


class WrinkleAtlas:
    """The texture ``wrinkle_atlas`` of ``shaders/wrinkles.glsl``: heights in metres and creases."""

    def __init__(self, context: Any, model: HeadModel) -> None:
        at = model.landmarks
        self.height = (
            float(at["menton"][1]) - _BELOW * at.eye_separation,
            float(at["hairline_middle"][1]) + _ABOVE * at.eye_separation,
        )
        self.patches = _patches(model, *_layers(context, model, self.height))
        self.texels = np.zeros((SIDE, SIDE, 2), np.float32)
        self._levels = np.zeros(len(self.patches), np.float32)
        self._dirty: tuple[int, int] | None = None
        self.texture = context.texture((SIDE, SIDE), 2, self.texels.tobytes(), dtype="f4")
        self.texture.filter = (context.LINEAR, context.LINEAR)
        self.texture.repeat_x = self.texture.repeat_y = False

    def update(self, levels: Floats) -> bool:
        """Combine the trains at ``levels (K,)`` and upload them; false when nothing has risen."""
        if len(levels) != len(self.patches) or not levels.any():
            return False
        if not np.array_equal(levels, self._levels):
            self._levels[:] = levels
            self._combine()
        return True

    def _combine(self) -> None:
        risen = [(patch, level) for patch, level in zip(self.patches, self._levels, strict=True) if level > 0.0]
        low = min(patch.rows.start for patch, _ in risen)
        high = max(patch.rows.stop for patch, _ in risen)
        if self._dirty is not None:
            low, high = min(low, self._dirty[0]), max(high, self._dirty[1])
        self.texels[low:high] = 0.0
        for patch, level in risen:
            part = self.texels[patch.rows, patch.columns]
            np.maximum(part, level * patch.texels, out=part)
        if low < high:
            self.texture.write(self.texels[low:high], viewport=(0, low, SIDE, high - low))
        self._dirty = (min(patch.rows.start for patch, _ in risen), max(patch.rows.stop for patch, _ in risen))


def _layers(context: Any, model: HeadModel, height: tuple[float, float]) -> tuple[Indices, Floats]:
    """``(S, S)`` the triangle at each texel or -1, and ``(S, S, 3)`` the barycentric coordinates in it."""
    program = compile_program(context, "atlas.vert.glsl", "atlas.frag.glsl")
    program["atlas_height"].value = height
    azimuth = np.arctan2(model.vertices[:, 0], model.vertices[:, 2])[model.triangles]
    ahead = np.flatnonzero(np.abs(azimuth).max(axis=1) < _FAR_ROUND)
    corners = np.tile(np.array([[1, 0], [0, 1], [0, 0]], np.float32), (len(ahead), 1))
    rest = context.buffer(model.vertices[model.triangles[ahead].ravel()].tobytes())
    layout = [(rest, "3f", "rest"), (context.buffer(corners.tobytes()), "2f", "corner")]
    target = context.framebuffer(context.texture((SIDE, SIDE), 4, dtype="f4"), context.depth_renderbuffer((SIDE, SIDE)))
    target.use()
    target.clear(0.0, 0.0, 0.0, 0.0)
    context.enable_only(context.DEPTH_TEST)
    context.vertex_array(program, layout).render()
    found = np.frombuffer(target.read(components=4, dtype="f4"), np.float32).reshape(SIDE, SIDE, 4)
    target.release()
    triangle = np.where(found[..., 3] > 0.5, ahead[np.round(found[..., 2]).astype(np.int32)], -1).astype(np.int32)
    shares = np.concatenate([found[..., :2], 1.0 - found[..., 0:1] - found[..., 1:2]], axis=2)
    return triangle, shares


def _patches(model: HeadModel, triangle: Indices, shares: Floats) -> list[Patch]:
    covered = np.flatnonzero(triangle.ravel() >= 0)
    triangles, shares = triangle.ravel()[covered], shares.reshape(-1, 3)[covered]
    corners = model.triangles[triangles]
    points = np.einsum("nc,ncx->nx", shares, model.vertices[corners])
    patches: list[Patch] = []
    for placed in model.trains:
        if placed.name.endswith("_r"):  # the atlas is its own mirror image, and the left train comes first
            patches.append(patches[-1].mirrored())
            continue
        near = np.flatnonzero(_touched(model, placed)[triangles])
        reach = (shares[near] * placed.reach[corners[near]]).sum(axis=1)
        texels = reach[:, None] * np.stack(relief(placed.train, points[near]), axis=1)
        kept = texels[:, 0] > _LOWEST
        patches.append(_patch(covered[near[kept]], texels[kept]))
    return patches


def _touched(model: HeadModel, placed: PlacedTrain) -> npt.NDArray[np.bool_]:
    """``(T,)`` true for the triangles that a train may raise: those round its vertices and their neighbours."""
    distance, weight = placed.train.place(model.vertices)
    length, width = placed.train.length, placed.train.length / placed.train.count
    near = np.abs(distance - 0.5 * length) < 0.5 * length + width
    raised = np.flatnonzero(near & (placed.reach * weight > 0.0))
    beside = np.unique(model.triangles[np.isin(model.triangles, raised).any(axis=1)])
    return np.asarray(np.isin(model.triangles, beside).any(axis=1))


def _patch(where: Any, texels: Any) -> Patch:
    if not len(where):
        return Patch(slice(0, 0), slice(0, 0), np.zeros((0, 0, 2), np.float32))
    row, column = np.divmod(where, SIDE)
    rows, columns = _around(row), _around(column)
    image = np.zeros((rows.stop - rows.start, columns.stop - columns.start, 2))
    image[row - rows.start, column - columns.start] = texels
    for _ in range(2):  # along both axes: a foot as sharp as a texel would show the texels as steps
        before, after = np.pad(image, [(1, 0), (0, 0), (0, 0)])[:-1], np.pad(image, [(0, 1), (0, 0), (0, 0)])[1:]
        image = (0.25 * before + 0.5 * image + 0.25 * after).swapaxes(0, 1)
    return Patch(rows, columns, np.ascontiguousarray(image, np.float32))


def _around(places: Any) -> slice:
    return slice(max(int(places.min()) - 2, 0), min(int(places.max()) + 3, SIDE))
