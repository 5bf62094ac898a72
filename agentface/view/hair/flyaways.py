"""Single hairs beside long hair: those that leave their card, most at the face, and short ones at the hairline."""

from __future__ import annotations

import numpy as np

from agentface.conventions import SIDES, Doubles
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep
from agentface.view.hair.groom import smoothed
from agentface.view.hair.hairline import Hairline, HairRoots
from agentface.view.hair.ribbons import unit_rows
from agentface.view.hair.sheets import Sheet, resampled
from agentface.view.hair.strand_set import StrandSet, paints
from agentface.view.hair.strands import nearest_vertices
from agentface.view.hair.styles import Amount

_AWAY = 0.004
"""Metres that they leave it."""
_LOOSE, _LOOSE_AWAY = 0.08, 1.8
"""The part of them that leaves it farther, and how much farther."""
_AT_FACE, _TO_THE_FRONT = 0.6, 5.0
"""The part of them that gathers at the face, and the exponent with which it does."""
_BABIES, _BABY_LENGTH, _BABY_WIDTH, _BABY_DEPTH = 1.2, (0.005, 0.013), 0.7, 0.005
"""Short hairs for each flyaway; metres; their width beside that of flyaways; the most metres behind the hairline."""
_EDGES, _EDGE_LENGTH, _EDGE_WIDTH = 2.0, (0.012, 0.050), (0.4, 0.85)
"""Hairs before the edge of the hair at the face for each flyaway; metres; their widths beside that of flyaways."""
_EDGE_AHEAD, _EDGE_NEARER, _EDGE_BEHIND = 0.0065, 1.8, 0.007
"""Metres before it at most where they are rooted, the exponent with which they gather at it, and how far they go in."""
_EDGE_SPAN, _EDGE_TO_ROOT, _EDGE_POINTS = 0.062, 1.4, 90
"""Metres from the parting to where the last of them is rooted, the exponent with which they grow fewer to there; points
of the edge that they follow."""
_ON_SKIN, _OVER_EDGE, _JOINED = 0.0003, 0.002, 0.55
"""Metres over the skin at their roots, over the edge at their ends; the part of their length in which they rise."""
_SMOOTHINGS = 4
"""Of the card's course, which has fewer points."""
_ACROSS = 1.8
"""Half widths of a card within which they start."""


def flyaways(cards: list[Sheet], amount: Amount, look: HairLook, rng: np.random.Generator) -> StrandSet:
    """Single hairs that start on ``cards`` and leave them."""
    count, t = amount.hairs, np.linspace(0.0, 1.0, amount.points)
    grids = np.stack([card.points for card in cards]).astype(np.float64)
    rows, each_side = grids.shape[2], len(cards) // len(SIDES)
    place = rng.random(count) ** np.where(rng.random(count) < _AT_FACE, _TO_THE_FRONT, 1.0)
    chosen = rng.integers(0, len(SIDES), count) * each_side + np.floor(each_side * place).astype(int)
    middle, aside = grids[chosen].mean(axis=1), grids[chosen, -1] - grids[chosen, 0]
    lines = middle + 0.5 * _ACROSS * rng.uniform(-1.0, 1.0, (count, 1, 1)) * aside
    from_row, share = np.floor(rng.random(count) * 0.55 * rows), rng.uniform(0.3, 0.7, count)
    row = np.minimum(from_row[:, None] + share[:, None] * rows * t, rows - 1.001)
    low, part = row.astype(int), (row % 1.0)[..., None]
    each = np.arange(count)[:, None]
    points = (1.0 - part) * lines[each, low] + part * lines[each, low + 1]
    points = smoothed(points, _SMOOTHINGS)
    away = unit_rows(points - cards[0].centre)
    far = _AWAY * np.where(rng.random(count) < _LOOSE, _LOOSE_AWAY, 1.0)[:, None]
    off = rng.uniform(0.0, 1.0, (count, 1)) * far * np.sin(np.pi * t * rng.uniform(0.4, 1.0, (count, 1)))
    drift = rng.normal(0.0, 0.5, (count, 1, 3)) * (far * t**2)[..., None]
    points = points + off[..., None] * away + drift
    paint = paints(look, np.full(count, 1.3), np.full(count, 0.7), rng, 0.4)
    return StrandSet(points, amount.radius * rng.uniform(0.6, 1.2, count), paint, np.ones((count, len(t))),
                  np.ones(count), np.ones(count))  # fmt: skip


def baby_hairs(model: HeadModel, amount: Amount, look: HairLook, beside: float, rng: np.random.Generator) -> StrandSet:
    """Short hairs of the hairline, combed away from a parting ``beside`` metres from the middle of the head."""
    line = Hairline(model, look.hairline)
    roots = HairRoots.drawn(model, model.normals, line, round(_BABIES * amount.hairs), rng, elsewhere=0.0)
    roots = roots.before(line, _BABY_DEPTH)
    count, t = len(roots), np.linspace(0.0, 1.0, amount.points)[:, None]
    n = roots.normals
    side = np.sign(roots.places[:, :1] - beside)
    combed = side * [0.8, 0.0, 0.0] + [0.0, 0.35, -0.5] + 0.45 * rng.normal(size=(count, 3))
    combed = unit_rows(combed - n * (combed * n).sum(1, keepdims=True))
    length = rng.uniform(*_BABY_LENGTH, (count, 1, 1))
    fall = np.array([0.0, -0.35, 0.0])
    points = roots.places[:, None] + length * (t * combed[:, None] + 0.2 * np.sin(2.0 * t) * n[:, None] + t**2 * fall)
    paint = paints(look, np.full(count, 1.1), np.full(count, 0.45), rng, 0.4)
    return StrandSet(points, _BABY_WIDTH * amount.radius * rng.uniform(0.6, 1.2, count), paint,
                  np.ones((count, len(t))), np.ones(count), np.ones(count))  # fmt: skip


def edge_hairs(
    model: HeadModel, beneath: list[Sheet], amount: Amount, look: HairLook, rng: np.random.Generator
) -> StrandSet:
    """Single hairs that are rooted before the front edges of the sheets ``beneath``, fewer and fewer, and join them."""
    count, t = round(_EDGES * amount.hairs), np.linspace(0.0, 1.0, amount.points)
    grown = []
    for sheet in beneath:
        lines = sheet.points[[0, 1]].astype(np.float64)
        (edge, inner), (along, _) = resampled(lines, np.tile(np.linspace(0.0, 1.0, _EDGE_POINTS), (2, 1)))
        way = _EDGE_SPAN * rng.random((count, 1)) ** _EDGE_TO_ROOT + rng.uniform(*_EDGE_LENGTH, (count, 1)) * t
        at, aside = (
            np.stack([np.interp(way, along, rows[:, axis]) for axis in range(3)], axis=2)
            for rows in (edge, unit_rows(inner - edge))
        )
        ahead = _EDGE_AHEAD * rng.random((count, 1)) ** _EDGE_NEARER * (1.0 - t) ** 1.2
        at = at + (_EDGE_BEHIND * rng.random((count, 1)) * t - ahead)[..., None] * aside
        away = unit_rows(at - sheet.centre)
        joined = smoothstep(0.0, _JOINED, t)[:, None]
        grown.append((1.0 - joined) * _on_skin(model, at) + joined * (at + _OVER_EDGE * away))
    points = smoothed(np.concatenate(grown), 2)
    total = len(points)
    paint = paints(look, np.full(total, 1.1), np.full(total, 0.75), rng, 0.4)
    return StrandSet(points, amount.radius * rng.uniform(*_EDGE_WIDTH, total), paint, np.ones((total, len(t))),
                  np.ones(total), np.ones(total))  # fmt: skip


def _on_skin(model: HeadModel, points: Doubles) -> Doubles:
    """``points (N, P, 3)`` m moved onto the plane of the nearest vertex of the skin."""
    nearest = nearest_vertices(points.reshape(-1, 3), model.vertices)
    normals = model.normals[nearest].reshape(points.shape)
    off = ((points - model.vertices[nearest].reshape(points.shape)) * normals).sum(axis=2, keepdims=True)
    return np.asarray(points - (off - _ON_SKIN) * normals)
