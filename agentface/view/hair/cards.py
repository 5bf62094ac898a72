"""Hair cards: narrow locks that lie over the sheets, each with its own way, height, length and end."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep
from agentface.view.hair.card_ways import CARDS, CardWays
from agentface.view.hair.drape import draped
from agentface.view.hair.groom import smoothed
from agentface.view.hair.hull import Hull
from agentface.view.hair.locks import Locks
from agentface.view.hair.mantle import LOW, Mantle, least_height
from agentface.view.hair.ribbons import unit_rows
from agentface.view.hair.sheets import FIRST_CARD, SIGNS, WAVE, Sheet
from agentface.view.hair.styles import thickness_of

_ACROSS = np.array([-1.0, 0.0, 1.0])
"""A card's columns: it is bent over the head."""
_OVERLAP, _WIDTHS, _NARROWEST, _NARROWED = 1.62, (0.75, 1.35), 0.0024, 0.25
"""A card's width in spaces between cards, and how it differs; its least half width, metres; the part its end loses, for
there its lock has clumped."""
_NUMBERS, _OWN = 24, 40.0
"""What the shader draws hairs by, few enough for its arithmetic."""
_GOLDEN = 0.618
"""Turns from the height of a card to the next one's, so that neighbours lie apart."""
_SINKING = 0.035, 0.20
"""Metres from the root between which they come to do so: the outline of the crown is one."""
_APART, _APART_AT_ROOT, _APART_FROM = 0.0022, 0.30, (0.040, 0.120)
"""Metres by which the highest lie over the lowest, so that none cut through others, and from the root to there: where
the crown is seen against the light nothing is seen between them."""
_WISP_WIDTH, _WISP_DRIFT = 0.7, 1.2
"""How wide wisps are, and how far off their way, beside the others."""
_DRIFT, _TWIST = 0.0040, 0.02
"""Metres that ends leave their ways, and how steeply cards lie across it: of most of them at most."""
_TURNED_IN, _TURNING = 0.010, (0.72, 1.0)
"""Metres that the lowest turn in at their ends, besides all of them, and between which parts of their length."""
_OVER_PARTING, _OVER_PARTING_REACH = 0.0022, 0.006
"""Metres by which roots lie over the parting at most, and along the hair in which that falls to a third."""
_EVEN = 6
"""Smoothings of the way across them, so that none folds over."""
_ROUND = 0.55
"""How far their sides face aside."""
_ROOT_LIGHT, _FROM_ROOT = 0.60, 0.30
"""At the root, as a part of that at the end; up to which part of the length it gets lighter."""
_SHADED, _LAYERED = 0.30, 0.5
"""How much light the highest keep off the lowest, and up to which part of the length it comes to that."""


def cards(model: HeadModel, look: HairLook, hull: Hull, rng: np.random.Generator) -> list[Sheet]:
    """The cards of both sides, each side's from the face to the nape."""
    thickness, grown = thickness_of(model, look), []
    for sign in SIGNS:
        locks, paths = Locks.of_side(sign), draped(model, look, hull, sign)
        mantle = Mantle.drawn(hull, look, paths, locks, thickness)
        ways = CardWays.drawn(paths, locks, rng)
        layer: Doubles = np.mod(_GOLDEN * np.arange(CARDS), 1.0)[:, None]
        points, off = _lying(hull, look, ways, locks, rng)
        edges = _edges(hull, ways, mantle, points, off, layer, rng)
        grown += _woven(hull, ways, edges, layer, rng)
    return grown


def _lying(
    hull: Hull, look: HairLook, ways: CardWays, locks: Locks, rng: np.random.Generator
) -> tuple[Doubles, Doubles]:
    """``(N, R, 3)`` m: the middle line of each card, in waves; ``(N, R)`` m: how far off those of all."""
    along, middle = ways.along, ways.middle
    drift = _DRIFT * np.where(ways.wisps(), _WISP_DRIFT, 1.0) * rng.normal(size=CARDS).clip(-1.3, 1.3)
    off = look.curl * WAVE * locks.own(ways.root, along) + drift[:, None] * ways.t**1.5
    sway = look.curl * WAVE * locks.waves(ways.root, along)[0] + off
    across = hull.sideways(middle)
    points = middle + sway[..., None] * across
    rootward = _OVER_PARTING * rng.random((CARDS, 1)) * np.exp(-along / _OVER_PARTING_REACH)
    points = points - rootward[..., None] * unit_rows(np.gradient(middle, axis=1))
    return smoothed(points, 2), off * np.sign((across * ways.aside).sum(axis=2))


def _edges(
    hull: Hull, ways: CardWays, mantle: Mantle, points: Doubles, off: Doubles, layer: Doubles, rng: np.random.Generator
) -> Doubles:
    """``(N, C, R, 3)`` m: the columns of each card about ``points (N, R, 3)`` m, ``off (N, R)`` m its place.

    All follow the ``mantle`` and only their ``layer (N, 1)`` tells them apart, so that none cuts through others.
    """
    t, spaces = ways.t, np.linalg.norm(ways.aside, axis=2)
    half = 0.5 * _OVERLAP * spaces * rng.uniform(*_WIDTHS, (CARDS, 1))
    half = np.maximum(half, _NARROWEST) * (1.0 - _NARROWED * smoothstep(0.40, 1.0, t))
    half *= np.where(ways.wisps(), _WISP_WIDTH, 1.0)[:, None]
    across = hull.sideways(points)
    across *= np.sign((across * ways.aside).sum(2, keepdims=True))
    across = unit_rows(smoothed(across, _EVEN))
    at_root = (1.0 - smoothstep(0.0, 0.25, t))[:, None]
    across = unit_rows(at_root * unit_rows(ways.aside) + (1.0 - at_root) * across)
    side = _ACROSS[:, None]
    edges = points[:, None] + side[..., None] * (half[..., None] * across)[:, None]
    place = ways.place[:, None] + ((off[:, None] + side * half[:, None]) / spaces[:, None]) * ways.space[:, None, None]
    part = np.repeat(ways.part[:, None], len(_ACROSS), axis=1)
    sunk = (1.0 - LOW) * (1.0 - layer) * smoothstep(*_SINKING, ways.along)
    turned = _TURNED_IN * (1.0 - layer) ** 2 * smoothstep(*_TURNING, t)
    apart = _APART * layer * (_APART_AT_ROOT + (1.0 - _APART_AT_ROOT) * smoothstep(*_APART_FROM, ways.along)) - turned
    twist = half * _TWIST * rng.normal(size=(CARDS, 1)) * smoothstep(0.25, 0.7, t)
    height = mantle.at(place, part) - sunk[:, None] * mantle.thickness(place, part) + apart[:, None]
    height = height + side * twist[:, None]
    edges = edges + (height - mantle.ground.height(edges))[..., None] * hull.outward(edges)
    return hull.push_out(edges, least_height(ways.along)[:, None])


def _woven(hull: Hull, ways: CardWays, edges: Doubles, layer: Doubles, rng: np.random.Generator) -> list[Sheet]:
    """The cards of columns ``edges (N, C, R, 3)`` m, the lower the darker."""
    t = ways.t
    apart = smoothstep(0.0, _LAYERED, t)
    rooted = _ROOT_LIGHT + (1.0 - _ROOT_LIGHT) * smoothstep(0.0, _FROM_ROOT, t)
    light = (1.0 - _SHADED * (1.0 - layer) * apart) * rooted
    own = _OWN * rng.random(CARDS)
    grown = []
    for k, grid in enumerate(edges):
        number = FIRST_CARD + (1 + (k - 1) % _NUMBERS if k else 0) + 0.5 + 0.498 * _ACROSS
        places = np.stack(np.broadcast_arrays(number[:, None], t, light[k], own[k]), axis=2)
        grown.append(Sheet(grid.astype(np.float32), places.astype(np.float32), hull.centre, _ROUND))
    return grown
