"""The skin beyond the lips' surface that follows its edge when orbicularis oris contracts."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.deform.mouth.lip_grid import LipGrid
from agentface.deform.mouth.lip_surface import COLUMNS, ROWS
from agentface.head.model import HeadModel
from agentface.mesh import bspline


def skirt(model: HeadModel, grid: LipGrid, points: Doubles, across: Doubles) -> tuple[Indices, Indices, Doubles]:
    """The vertices beyond the patch that follow its edge: skin by their distance, the bag of the mouth by its rings."""
    outside = np.flatnonzero(_is_outside(model, grid)).astype(np.int32)
    place = _places_round(points[grid.vertices[-1]], across, points[outside])
    fade = _fade_of(model, grid, points, across, outside, place)
    near = fade > 1e-3
    outside, place, fade = outside[near], place[near], fade[near]
    inside, rings = grid.bag.ravel(), len(grid.bag)
    sinking = np.repeat(np.arange(rings, 0, -1) / (rings + 1.0), grid.bag.shape[1])
    index_out, weight_out = bspline.closed(place, COLUMNS)
    index_in, weight_in = bspline.closed(np.tile(across, rings), COLUMNS)
    return (
        np.concatenate([outside, inside]).astype(np.int32),
        np.concatenate([index_out * ROWS + ROWS - 1, index_in * ROWS]).astype(np.int32),
        np.concatenate([weight_out * fade[:, None], weight_in * _smooth(sinking)[:, None]]),
    )


def _is_outside(model: HeadModel, grid: LipGrid) -> np.typing.NDArray[np.bool_]:
    outside = model.material[:, 1] == 0.0
    outside[grid.vertices.ravel()] = False
    outside[grid.bag.ravel()] = False
    return outside


def _places_round(edge: Doubles, across: Doubles, places: Doubles) -> Doubles:
    """Where on the closed scale the direction of each place from the middle of the mouth meets the patch's edge."""
    middle = 0.5 * (edge.max(0) + edge.min(0))
    half = 0.5 * (edge.max(0) - edge.min(0))

    def turn(at: Doubles) -> Doubles:
        return np.arctan2((at[:, 1] - middle[1]) / half[1], at[:, 0] / half[0])

    angles = turn(edge)
    order = np.argsort(angles)
    known = np.unwrap(across[order], period=COLUMNS)
    known += COLUMNS * np.round((across[order][0] - known[0]) / COLUMNS)
    angle = angles[order]
    angle = np.concatenate([angle - 2 * np.pi, angle, angle + 2 * np.pi])
    known = np.concatenate([known - COLUMNS, known, known + COLUMNS])
    return np.asarray(np.interp(turn(places), angle, known) % COLUMNS)


def _fade_of(
    model: HeadModel, grid: LipGrid, points: Doubles, across: Doubles, outside: Indices, place: Doubles
) -> Doubles:
    """1 at the patch's edge, 0 farther from it than the contraction reaches: by columns, with soft transitions."""
    edge = points[grid.vertices[-1]]
    order = np.argsort(across)
    period = {"period": float(COLUMNS)}
    foot = np.stack([np.interp(place, across[order], edge[order, axis], **period) for axis in range(3)], axis=1)
    distance = np.linalg.norm(points[outside] - foot, axis=1)
    reach = model.lips.orbicularis_oris.reach.at(2 * np.pi * place / COLUMNS) * model.landmarks.eye_separation
    return _smooth(np.clip(1.0 - distance / reach, 0.0, 1.0))


def _smooth(t: Doubles) -> Doubles:
    return t * t * (3.0 - 2.0 * t)
