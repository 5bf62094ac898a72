"""The wrinkle trains of a face spread over its atlas, each at full contraction."""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats, Indices
from agentface.head.model import HeadModel
from agentface.head.trains import relief
from agentface.head.wrinkles import PlacedTrain
from agentface.mesh.smoothstep import smoothstep

Relief = npt.NDArray[np.int16]

SIDE = 512
STEEPEST = 2.0
"""The slope whose root is 1, as in ``shaders/wrinkles.glsl``."""
_AZIMUTH = 1.35  # rad, to both sides of the middle: ATLAS_AZIMUTH of shaders/atlas.glsl
_LOWEST = 2e-6  # m
_UNDER_A_CREASE = 5e-5  # m: both banks of the crease at a train's foot belong to it
_SOFTENINGS = 2  # of a relief, by a texel each
_LOST, _LOST_OF_A_FOLD = 0.5, 0.17  # how much lower the lines of a row are here and there, and a single fold
_PLACES = 16, 32  # texels high and wide: places where lines are deep or not
_CREASE_SHADE = 0.85  # of the light that the bottom of a crease misses: CREASE_SHADE there
_GAMMA = 0.48  # from light to the picture, about
_FAR_ROUND = 2.2  # rad; triangles beyond would cross the atlas where the azimuth jumps
_FLIPPED = np.array([-1, 1, 1], np.float32)


@dataclass(frozen=True, slots=True)
class Patch:
    """One train on the atlas at full contraction.

    Attributes:
        rows, columns: what it covers, ``h`` by ``w`` texels.
        heights: ``(h, w)`` m.
        slopes: ``(h, w, 2)`` signed roots of the slopes to the face's left and up, as parts of the steepest.
        creases: ``(h, w)`` 0..1.
        normals: ``(h, w, 3)`` of the smooth skin.
    """

    rows: slice
    columns: slice
    heights: Floats
    slopes: Floats
    creases: Floats
    normals: Floats

    def mirrored(self) -> Patch:
        """The same train of the other side."""
        columns = slice(SIDE - self.columns.stop, SIDE - self.columns.start)
        heights, slopes, creases, normals = (
            np.ascontiguousarray(image[:, ::-1]) for image in (self.heights, self.slopes, self.creases, self.normals)
        )
        return Patch(self.rows, columns, heights, slopes * _FLIPPED[:2], creases, normals * _FLIPPED)

    def texels(self, towards: Doubles) -> Relief:
        """``(h, w, 4)``, -127..127: slopes, crease, and what it makes of the picture under a light from a direction."""
        light = (1.0 + self.shade(towards)) * (1.0 - _CREASE_SHADE * self.creases)
        change = np.clip(np.maximum(light, 0.0) ** _GAMMA - 1.0, -1.0, 1.0)
        texels = np.concatenate([self.slopes, np.stack([self.creases, change], axis=2)], axis=2)
        return np.asarray(np.round(127.0 * texels), np.int16)

    def broken(self, kept: Floats) -> Patch:
        """As irregular as skin: of its height what ``kept (S, S)`` says."""
        here = kept[self.rows, self.columns]
        slopes = self.slopes * np.sqrt(here)[..., None]
        return replace(self, heights=self.heights * here, slopes=slopes, creases=self.creases * here)

    def shade(self, towards: Doubles) -> Floats:
        """``(h, w)``: by how much its slopes change wrapped light from a direction, as a part of that light."""
        azimuth = _azimuths()[self.columns]
        slope = STEEPEST * self.slopes * np.abs(self.slopes)
        along = np.cos(azimuth) * towards[0] - np.sin(azimuth) * towards[2]
        leftward = np.cos(azimuth) * self.normals[..., 0] - np.sin(azimuth) * self.normals[..., 2]
        facing = self.normals @ towards
        risen = slope[..., 0] * (along - leftward * facing) + slope[..., 1] * (
            towards[1] - self.normals[..., 1] * facing
        )
        return np.asarray(-risen / (np.maximum(facing, -0.2) + 0.8), np.float32)


def _outermost(model: HeadModel, height: tuple[float, float]) -> tuple[Indices, Indices, Doubles]:
    """The texels ``(N,)`` that skin covers, in their order, the outermost triangle ``(N,)`` there, and the shares
    ``(N, 3)`` of its corners in the middle of the texel.
    """
    radius, azimuth = np.hypot(*model.vertices[:, [0, 2]].T), np.arctan2(*model.vertices[:, [0, 2]].T)
    share = (model.vertices[:, 1] - height[0]) / (height[1] - height[0])
    place = np.stack([0.5 + 0.5 * azimuth / _AZIMUTH, share], axis=1).astype(np.float64) * SIDE - 0.5
    ahead = np.flatnonzero(np.abs(azimuth[model.triangles]).max(axis=1) < _FAR_ROUND)
    corners = place[model.triangles[ahead]]
    low = np.clip(np.ceil(corners.min(axis=1)), 0, SIDE).astype(np.int64)
    wide, high = np.clip(np.floor(corners.max(axis=1)).astype(np.int64) + 1 - low, 0, SIDE - low).T
    # every texel of the box round every triangle
    mine = np.repeat(np.arange(len(ahead)), wide * high)
    within = np.arange(len(mine)) - np.repeat(np.cumsum(wide * high) - wide * high, wide * high)
    column, row = low[mine, 0] + within % wide[mine], low[mine, 1] + within // wide[mine]
    a, b, c = (corners[mine, corner] for corner in range(3))
    area = _cross(b - a, c - a)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = np.stack([column, row], axis=1)
        sides = [_cross(b - at, c - at), _cross(c - at, a - at), _cross(a - at, b - at)]
        shares = np.stack(sides, axis=1) / area[:, None]
    inside = np.flatnonzero((shares >= 0.0).all(axis=1) & (area != 0.0))
    texel, shares, mine = (row * SIDE + column)[inside], shares[inside], ahead[mine[inside]]
    outward = (shares * radius[model.triangles[mine]]).sum(axis=1)
    order = np.lexsort((-outward, texel))
    texel, first = np.unique(texel[order], return_index=True)
    return texel, mine[order][first].astype(np.int32), shares[order][first]


def _cross(one: Doubles, other: Doubles) -> Doubles:
    return np.asarray(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])


def patches(model: HeadModel, height: tuple[float, float]) -> list[Patch]:
    """Those of all trains, on an atlas between two heights in metres."""
    covered, triangles, shares = _outermost(model, height)
    corners = model.triangles[triangles]
    points = np.einsum("nc,ncx->nx", shares, model.vertices[corners])
    normals = np.einsum("nc,ncx->nx", shares, model.normals[corners])
    spread: list[Patch] = []
    for placed in model.trains:
        if placed.name.endswith("_r"):  # the atlas is its own mirror image, and the left train comes first
            spread.append(spread[-1].mirrored())
            continue
        near = np.flatnonzero(_touched(model, placed)[triangles])
        reach = (shares[near] * placed.reach[corners[near]]).sum(axis=1)
        raised = reach[:, None] * np.stack(relief(placed.train, points[near]), axis=1)
        raised[:, 0] = np.maximum(raised[:, 0], _UNDER_A_CREASE * raised[:, 1])
        kept = raised[:, 0] > _LOWEST
        at = near[kept]
        spread.append(_patch(covered[at], raised[kept], np.hypot(points[at, 0], points[at, 2]), normals[at], height))
    deep = deep_places(model.name)
    return [patch.broken(depth_left(placed, deep)) for patch, placed in zip(spread, model.trains, strict=True)]


def depth_left(placed: PlacedTrain, deep: Floats) -> Floats:
    """``(S, S)`` 0..1: the part of a train's height that is left where lines are ``deep (S, S)`` and where not."""
    lost = _LOST if placed.train.count > 1 else _LOST_OF_A_FOLD
    return np.asarray(1.0 - lost * (1.0 - deep), np.float32)


def deep_places(name: str) -> Floats:
    """``(S, S)`` 0..1: where the lines of the face ``name`` are deep; its left half is not the right one's image."""
    rows, columns = (SIDE // size + 1 for size in _PLACES)
    coarse = np.random.default_rng(zlib.crc32(name.encode())).uniform(size=(rows, columns))
    row, column = (np.arange(SIDE) / size for size in _PLACES)
    wide = np.stack([np.interp(column, np.arange(columns), line) for line in coarse])
    return np.asarray(
        smoothstep(0.0, 1.0, np.stack([np.interp(row, np.arange(rows), line) for line in wide.T], axis=1)), np.float32
    )


def _touched(model: HeadModel, placed: PlacedTrain) -> npt.NDArray[np.bool_]:
    """``(T,)`` true for the triangles that a train may raise: those round its vertices and their neighbours."""
    distance, weight = placed.train.place(model.vertices)
    length, width = placed.train.length, placed.train.length / placed.train.count
    near = np.abs(distance - 0.5 * length) < 0.5 * length + width
    raised = np.flatnonzero(near & (placed.reach * weight > 0.0))
    beside = np.unique(model.triangles[np.isin(model.triangles, raised).any(axis=1)])
    return np.asarray(np.isin(model.triangles, beside).any(axis=1))


def _patch(where: Any, raised: Any, radius: Doubles, normals: Any, height: tuple[float, float]) -> Patch:
    """From the texels ``where (N,)`` that are raised: heights and creases ``(N, 2)``, the rest of them."""
    if not len(where):
        where, raised, radius, normals = (np.zeros(shape) for shape in (1, (1, 2), 1, (1, 3)))
        where, radius = where.astype(np.int64), radius + 1.0
    row, column = np.divmod(where, SIDE)
    rows, columns = _around(row), _around(column)
    image = np.zeros((rows.stop - rows.start, columns.stop - columns.start, 6))
    image[..., 2], image[..., 5] = radius.mean(), 1.0
    image[row - rows.start, column - columns.start] = np.column_stack([raised, radius, normals])
    relief, around = image[..., :2], image[..., 2]
    for _ in range(2 * _SOFTENINGS):  # along both axes in turn: skin has rounded valleys, no edges
        before, after = np.pad(relief, [(1, 0), (0, 0), (0, 0)])[:-1], np.pad(relief, [(0, 1), (0, 0), (0, 0)])[1:]
        relief = (0.25 * before + 0.5 * relief + 0.25 * after).swapaxes(0, 1)
    upward, leftward = np.gradient(relief[..., 0])
    slopes = (
        np.stack([leftward / (around * 2 * _AZIMUTH / SIDE), upward / ((height[1] - height[0]) / SIDE)], axis=2)
        / STEEPEST
    )
    roots = np.sign(slopes) * np.sqrt(np.minimum(np.abs(slopes), 1.0))
    relief, roots, normals = (np.ascontiguousarray(part, np.float32) for part in (relief, roots, image[..., 3:]))
    return Patch(rows, columns, relief[..., 0], roots, relief[..., 1], normals)


def _around(places: Any) -> slice:
    return slice(max(int(places.min()) - 2, 0), min(int(places.max()) + 3, SIDE))


def _azimuths() -> Doubles:
    """``(S,)`` rad, of the atlas' columns."""
    return np.asarray(_AZIMUTH * (2.0 * (np.arange(SIDE) + 0.5) / SIDE - 1.0))
