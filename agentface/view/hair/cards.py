"""Hair cards: narrow locks that lie over the sheets, each with its own way, height, length and end."""

from __future__ import annotations

import numpy as np

from agentface.conventions import SIDES, Doubles
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep
from agentface.view.hair.drape import draped
from agentface.view.hair.groom import smoothed
from agentface.view.hair.hull import Hull
from agentface.view.hair.ribbons import unit_rows
from agentface.view.hair.sheets import FIRST_CARD, ROOTWARD, Sheet, resampled
from agentface.view.hair.styles import REFERENCE_EYES, STYLES

_CARDS, _ROWS = 36, 20
"""On each side; points along each."""
_ACROSS = np.array([-1.0, 1.0])
_TO_THE_FRONT = 1.25
"""The exponent with which they gather at the face."""
_OVERLAP, _NARROWEST = 1.7, 0.0022
"""A card's width in spaces between cards; its least half width, metres."""
_SHORTEST, _ALIKE = 0.84, 0.35
"""How long the shortest is, and up to where along it none is shorter than its neighbours: parts of the whole length."""
_NUMBERS, _OWN = 24, 40.0
"""What the shader draws hairs by, few enough for its arithmetic."""
_AT_PARTING, _RISE = 0.22, 0.050
"""How high cards lie where they start, as a part of the hair's thickness, and the metres over which they rise."""
_LOW = 0.45
"""How high the lowest lie, as a part of the hair's thickness."""
_GOLDEN = 0.618
"""Turns from the height of a card to the next one's, so that neighbours lie apart."""
_APART = 0.0015
"""Metres by which the highest lie over the lowest from the root on, so that none cut through others."""
_WISPS, _WISP_WIDTH, _WISP_DRIFT = 4, 0.4, 1.8
"""Every how many cards at the face one is a wisp; how wide, and how far off its way, beside the others."""
_TUCKED = 0.45
"""How high the first of them lies, as a part of the hair's thickness."""
_AT_FACE = 0.30
"""The part of the columns that are at the face."""
_WAVE, _WAVE_LENGTH = 0.0060, (0.10, 0.17)
_DRIFT = 0.0040
_TURNED_IN = 0.014
"""Metres that ends turn in at most, besides all of them."""
_ROOT_LIGHT = 0.70


def cards(model: HeadModel, look: HairLook, hull: Hull, rng: np.random.Generator) -> list[Sheet]:
    """The cards of both sides."""
    thickness = STYLES[look.style].thickness * look.volume * model.landmarks.eye_separation / REFERENCE_EYES
    grown = []
    for side in SIDES:
        paths = draped(model, look, hull, 1.0 if side == SIDES[0] else -1.0)
        grown += _row(hull, look, paths, thickness, rng)
    return grown


def _row(hull: Hull, look: HairLook, paths: Doubles, thickness: float, rng: np.random.Generator) -> list[Sheet]:
    count = _CARDS
    place = (np.arange(count) + rng.uniform(0.0, 0.7, count)) / count
    column = (len(paths) - 1) * place**_TO_THE_FRONT
    t = np.linspace(0.0, 1.0, _ROWS) ** ROOTWARD
    share = _SHORTEST + (1.04 - _SHORTEST) * rng.random(count) ** 0.6
    # side by side as far as they lie on the head, so that they do not cut through each other
    lines = _between(paths, column)
    alike = np.median(lengths := _lengths(lines)) / lengths[:, None]
    parts = alike * t + (share[:, None] - alike) * np.clip((t - _ALIKE) / (1.0 - _ALIKE), 0.0, 1.0) ** 1.5
    middle, along = resampled(lines, parts)
    gap = len(paths) / count * _TO_THE_FRONT * place ** (_TO_THE_FRONT - 1.0)
    aside = resampled(_between(paths, np.minimum(column + 1.0, len(paths) - 1.0)), parts)[0]
    aside -= resampled(_between(paths, np.maximum(column - 1.0, 0.0)), parts)[0]
    aside = _sheared(aside, unit_rows(np.gradient(middle, axis=1)))
    half = 0.25 * _OVERLAP * gap[:, None] * np.linalg.norm(aside, axis=2) * rng.uniform(0.7, 1.35, (count, 1))
    half = np.maximum(half, _NARROWEST) * (1.0 - 0.40 * smoothstep(0.55, 1.0, t))
    wisp = (place < _AT_FACE) & (np.arange(count) % _WISPS == _WISPS - 1)
    half *= np.where(wisp, _WISP_WIDTH, 1.0)[:, None]
    layer = (_GOLDEN * np.arange(count))[:, None] % 1.0
    drift = _DRIFT * np.where(wisp, _WISP_DRIFT, 1.0) * rng.normal(size=count).clip(-1.3, 1.3)
    tucked = _TUCKED + (1.0 - _TUCKED) * smoothstep(0.0, _AT_FACE, place)
    points = _lying(hull, look, middle, along, t, thickness * tucked[:, None], layer, drift, rng)
    return _woven(hull, points, aside, half, t, layer, rng)


def _lying(
    hull: Hull, look: HairLook, middle: Doubles, along: Doubles, t: Doubles, thickness: Doubles, layer: Doubles,
    drift: Doubles, rng: np.random.Generator,
) -> Doubles:  # fmt: skip
    """``(N, R, 3)`` m: the middle line of each card, off the ``hull`` and a little off its way."""
    count = len(middle)
    risen = _AT_PARTING + (1.0 - _AT_PARTING) * np.sin(0.5 * np.pi * np.clip(along / _RISE, 0.0, 1.0))
    height = thickness * (1.0 - (1.0 - _LOW) * (1.0 - layer) * smoothstep(0.02, 0.15, along)) * risen
    apart = _APART * layer * smoothstep(0.0, 0.015, along)
    height = height + apart
    height = height - _TURNED_IN * rng.random((count, 1)) ** 2 * smoothstep(0.75, 1.0, t) ** 1.5
    out = hull.outward(middle)
    across = unit_rows(np.cross(np.gradient(middle, axis=1), out))
    turn = 2.0 * np.pi * (along / rng.uniform(*_WAVE_LENGTH, (count, 1)) + rng.random((count, 1)))
    grown = np.clip(along / 0.09, 0.0, 1.0)
    sway = look.curl * _WAVE * rng.uniform(0.4, 1.0, (count, 1)) * grown * np.sin(turn)
    sway = sway + drift[:, None] * t**1.5
    height = height + 0.35 * look.curl * _WAVE * grown * np.cos(turn)
    least = 0.002 + 0.0055 * smoothstep(0.0, 0.03, along) + apart
    points = hull.push_out(middle + sway[..., None] * across + height[..., None] * out, least)
    return smoothed(points, 1)


def _woven(
    hull: Hull, points: Doubles, aside: Doubles, half: Doubles, t: Doubles, layer: Doubles, rng: np.random.Generator
) -> list[Sheet]:
    """Their two edges, at the roots side by side as their neighbours are, ``aside (N, R, 3)``."""
    out = hull.outward(points)
    across = unit_rows(np.cross(np.gradient(points, axis=1), out))
    across *= np.sign((across * aside).sum(2, keepdims=True))
    side_by_side = (1.0 - smoothstep(0.0, 0.25, t))[:, None]
    across = unit_rows(side_by_side * unit_rows(aside) + (1.0 - side_by_side) * across)
    count = len(points)
    twist = 0.35 * rng.normal(size=(count, 1)) * smoothstep(0.25, 0.7, t)
    light = (0.78 + 0.22 * layer) * (_ROOT_LIGHT + (1.0 - _ROOT_LIGHT) * smoothstep(0.0, 0.30, t))
    own = _OWN * rng.random(count)
    edges = points[:, None] + _ACROSS[:, None, None] * (half[..., None] * across)[:, None]
    # on the head's round both lie as high as the middle, but for the card's own twist
    rise = hull.height(points)[:, None] - hull.height(edges) + _ACROSS[:, None] * (half * twist)[:, None]
    edges = edges + rise[..., None] * hull.outward(edges)
    grown = []
    for k, grid in enumerate(edges):
        number = FIRST_CARD + (1 + (k - 1) % _NUMBERS if k else 0) + 0.5 + 0.498 * _ACROSS
        places = np.stack(np.broadcast_arrays(number[:, None], t, light[k], own[k]), axis=2)
        grown.append(Sheet(grid.astype(np.float32), places.astype(np.float32), hull.centre))
    return grown


def _lengths(lines: Doubles) -> Doubles:
    """``(N,)`` m: of ``lines (N, K, 3)``."""
    return np.asarray(np.linalg.norm(np.diff(lines, axis=1), axis=2).sum(axis=1))


def _sheared(aside: Doubles, along: Doubles) -> Doubles:
    """``aside (..., 3)`` with no more of it ``along (..., 3)`` the hair than across."""
    part = (aside * along).sum(-1, keepdims=True)
    across = aside - part * along
    most = np.linalg.norm(across, axis=-1, keepdims=True)
    return np.asarray(across + np.clip(part, -most, most) * along)


def _between(paths: Doubles, column: Doubles) -> Doubles:
    """``(N, K, 3)``: the paths at ``column (N,)`` of ``paths (C, K, 3)``."""
    low = np.minimum(column.astype(int), len(paths) - 2)
    part = (column - low)[:, None, None]
    return np.asarray((1.0 - part) * paths[low] + part * paths[low + 1])
