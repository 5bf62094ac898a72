"""Hair cards: narrow locks that lie over the sheets, each with its own way, height, length and end."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import SIDES, Doubles
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep
from agentface.view.hair.drape import draped
from agentface.view.hair.groom import smoothed
from agentface.view.hair.hull import Hull
from agentface.view.hair.ribbons import unit_rows
from agentface.view.hair.sheets import FIRST_CARD, Sheet, parts_along, resampled, risen, volume
from agentface.view.hair.styles import thickness_of
from agentface.view.hair.visible import Flags

_CARDS, _ROWS = 36, 25
"""On each side; points along each."""
_ACROSS = np.array([-1.0, 1.0])
_TO_THE_FRONT = 1.25
"""The exponent with which they gather at the face."""
_JITTER = 0.8
"""Of the space between cards, by which they stand off their places."""
_OVERLAP, _WIDTHS, _NARROWEST, _NARROWED = 1.76, (0.80, 1.25), 0.0022, 0.40
"""A card's width in spaces between cards, and how it differs; its least half width, metres; the part its end loses."""
_SHORTEST, _LONGEST, _MOSTLY_LONG, _ALIKE = 0.88, 1.04, 0.6, 0.35
"""Parts of the whole length, and the exponent of chance between them; up to where along it all lie side by side."""
_NUMBERS, _OWN = 24, 40.0
"""What the shader draws hairs by, few enough for its arithmetic."""
_LOW = 0.70
"""How high the lowest lie, as a part of the hair's thickness."""
_GOLDEN = 0.618
"""Turns from the height of a card to the next one's, so that neighbours lie apart."""
_SINKING = 0.05, 0.22
"""Metres from the root between which they come to do so: the outline of the crown is one."""
_APART, _APART_FROM = 0.0026, 0.040
"""Metres by which the highest lie over the lowest, so that none cut through others, and from the root to there: where
the crown is seen against the light nothing is seen between them."""
_WISPS, _WISP_WIDTH, _WISP_DRIFT = 4, 0.7, 1.2
"""Every how many cards at the face one is a wisp; how wide, and how far off its way, beside the others."""
_TUCKED = 0.58
"""How high the first of them lies, as a part of the hair's thickness."""
_AT_FACE = 0.30
"""The part of the columns that are at the face."""
_WAVE, _WAVE_LENGTH, _WAVY = 0.0080, (0.115, 0.150), 0.09
"""Metres to and fro of the curliest hair, from wave to wave, and from the root to where they are whole."""
_ROLL, _OUT_OF_STEP = 1.6, 0.35
"""Turns of the waves from the face to the nape, and by how much cards differ from that."""
_OUTWARD = 0.12
"""How far waves go outward beside how far they go aside: more, and cards cut through each other."""
_DRIFT, _TWIST = 0.0040, 0.08
"""Metres that ends leave their course, and how steeply cards lie across it: of most of them at most."""
_LOWEST = 0.0036
"""Metres over the hull, which is smoother than the head: above the sheets below."""
_EASED = 2, 2
"""Cards, and points of each, by which what lifts one of them goes farther."""
_TURNED_IN = 0.014
"""Metres that ends turn in at most, besides all of them."""
_OVER_PARTING, _OVER_PARTING_REACH = 0.0022, 0.006
"""Metres by which roots lie over the parting at most, and along the hair in which that falls to a third."""
_EVEN = 6
"""Smoothings of the way across them, so that none folds over."""
_ROOT_LIGHT = 0.60
"""At the root, as a part of that at the end."""


_SHADED, _LAYERED = 0.14, 0.5
"""How much light the highest keep off the lowest, and up to which part of the length it comes to that."""


@dataclass(frozen=True, slots=True)
class _Course:
    """Where the cards of a side run on the hull.

    ``place (N,)`` 0 at the face to 1 at the nape, ``t (R,)`` 0..1 along each; ``middle (N, R, 3)`` m, ``along (N, R)``
    m from the root, and ``aside (N, R, 3)`` m to the next card.
    """

    place: Doubles
    t: Doubles
    middle: Doubles
    along: Doubles
    aside: Doubles

    @classmethod
    def drawn(cls, paths: Doubles, rng: np.random.Generator) -> _Course:
        """On ``paths (C, K, 3)`` m, one in each of equal parts of them."""
        last, t = len(paths) - 1.0, parts_along(_ROWS)
        place = (np.arange(_CARDS) + rng.uniform(0.0, _JITTER, _CARDS)) / _CARDS
        column = last * place**_TO_THE_FRONT
        share = _SHORTEST + (_LONGEST - _SHORTEST) * rng.random(_CARDS)[:, None] ** _MOSTLY_LONG
        lines = _between(paths, column)
        lengths = np.linalg.norm(np.diff(lines, axis=1), axis=2).sum(axis=1)
        # side by side as far as they lie on the head, so that none cuts through another
        alike = np.median(lengths) / lengths[:, None]
        parts = alike * t + (share - alike) * np.clip((t - _ALIKE) / (1.0 - _ALIKE), 0.0, 1.0) ** 1.5
        middle, along = resampled(lines, parts)
        before, behind = (
            resampled(_between(paths, np.clip(column + step, 0.0, last)), parts)[0] for step in (-1.0, 1.0)
        )
        columns = len(paths) / _CARDS * _TO_THE_FRONT * place ** (_TO_THE_FRONT - 1.0)
        aside = 0.5 * columns[:, None, None] * (behind - before)
        return cls(place, t, middle, along, _sheared(aside, unit_rows(np.gradient(middle, axis=1))))

    def wisps(self) -> Flags:
        """``(N,)``: which of them are wisps."""
        return np.asarray((self.place < _AT_FACE) & (np.arange(_CARDS) % _WISPS == _WISPS - 1))


def cards(model: HeadModel, look: HairLook, hull: Hull, rng: np.random.Generator) -> list[Sheet]:
    """The cards of both sides, each side's from the face to the nape."""
    thickness, grown = thickness_of(model, look), []
    for side in SIDES:
        course = _Course.drawn(draped(model, look, hull, 1.0 if side == SIDES[0] else -1.0), rng)
        layer: Doubles = np.mod(_GOLDEN * np.arange(_CARDS), 1.0)[:, None]
        points = _lying(hull, look, course, thickness, layer, rng)
        grown += _woven(hull, course, points, layer, rng)
    return grown


def _lying(
    hull: Hull, look: HairLook, course: _Course, thickness: float, layer: Doubles, rng: np.random.Generator
) -> Doubles:
    """``(N, R, 3)`` m: the middle line of each card, off the ``hull`` and a little off its course."""
    t, along, middle = course.t, course.along, course.middle
    tucked = _TUCKED + (1.0 - _TUCKED) * smoothstep(0.0, _AT_FACE, course.place)[:, None]
    apart = _APART * layer * smoothstep(0.0, _APART_FROM, along)
    sunk = (1.0 - _LOW) * (1.0 - layer) * smoothstep(*_SINKING, along)
    whole = thickness * tucked * risen(along) * volume(hull, middle)
    height = whole * (1.0 - sunk) + apart
    height = height - _TURNED_IN * rng.random((_CARDS, 1)) ** 2 * smoothstep(0.75, 1.0, t) ** 1.5
    out = hull.outward(middle)
    across = unit_rows(np.cross(np.gradient(middle, axis=1), out))
    waves = along / rng.uniform(*_WAVE_LENGTH, (_CARDS, 1))
    turn = 2.0 * np.pi * (waves + _ROLL * course.place[:, None] + _OUT_OF_STEP * rng.random((_CARDS, 1)))
    grown = look.curl * _WAVE * np.clip(along / _WAVY, 0.0, 1.0)
    drift = _DRIFT * np.where(course.wisps(), _WISP_DRIFT, 1.0) * rng.normal(size=_CARDS).clip(-1.3, 1.3)
    sway = grown * rng.uniform(0.4, 1.0, (_CARDS, 1)) * np.sin(turn) + drift[:, None] * t**1.5
    height = height + _OUTWARD * grown * np.cos(turn)
    points = middle + sway[..., None] * across + height[..., None] * out
    rootward = _OVER_PARTING * rng.random((_CARDS, 1)) * np.exp(-along / _OVER_PARTING_REACH)
    points = points - rootward[..., None] * unit_rows(np.gradient(middle, axis=1))
    # where the lowest have to be lifted all are, so that they stay in their order
    lowest = middle + (_LOW * whole)[..., None] * out
    lifted = hull.push_out(lowest, 0.001 + _LOWEST * smoothstep(0.0, 0.03, along)) - lowest
    lift = _eased(np.linalg.norm(lifted, axis=2))
    return smoothed(points + lift[..., None] * hull.outward(points), 2)


def _eased(lift: Doubles) -> Doubles:
    """``(N, R)``: what lifts a card over an ear lifts its neighbours too, less and less."""
    for axis, times in ((0, _EASED[0]), (1, _EASED[1])):
        size = lift.shape[axis]
        before, behind = np.maximum(np.arange(size) - 1, 0), np.minimum(np.arange(size) + 1, size - 1)
        for _ in range(times):
            lift = np.maximum(lift, np.maximum(lift.take(before, axis), lift.take(behind, axis)))
        for _ in range(2 * times):
            lift = 0.5 * lift + 0.25 * (lift.take(before, axis) + lift.take(behind, axis))
    return lift


def _woven(hull: Hull, course: _Course, points: Doubles, layer: Doubles, rng: np.random.Generator) -> list[Sheet]:
    """The cards about their middle lines ``points (N, R, 3)`` m: two edges each, at the roots side by side."""
    t, out = course.t, hull.outward(points)
    half = 0.5 * _OVERLAP * np.linalg.norm(course.aside, axis=2) * rng.uniform(*_WIDTHS, (_CARDS, 1))
    half = np.maximum(half, _NARROWEST) * (1.0 - _NARROWED * smoothstep(0.55, 1.0, t))
    half *= np.where(course.wisps(), _WISP_WIDTH, 1.0)[:, None]
    across = unit_rows(np.cross(np.gradient(points, axis=1), out))
    across *= np.sign((across * course.aside).sum(2, keepdims=True))
    across = unit_rows(smoothed(across, _EVEN))
    at_root = (1.0 - smoothstep(0.0, 0.25, t))[:, None]
    across = unit_rows(at_root * unit_rows(course.aside) + (1.0 - at_root) * across)
    edges = points[:, None] + _ACROSS[:, None, None] * (half[..., None] * across)[:, None]
    # on the head's round both lie as high as the middle, but for the card's own twist
    twist = half * _TWIST * rng.normal(size=(_CARDS, 1)) * smoothstep(0.25, 0.7, t)
    rise = hull.height(points)[:, None] - hull.height(edges) + _ACROSS[:, None] * twist[:, None]
    edges = edges + rise[..., None] * hull.outward(edges)
    apart = smoothstep(0.0, _LAYERED, t)
    light = (1.0 - _SHADED * (1.0 - layer) * apart) * (_ROOT_LIGHT + (1.0 - _ROOT_LIGHT) * smoothstep(0.0, 0.30, t))
    own = _OWN * rng.random(_CARDS)
    grown = []
    for k, grid in enumerate(edges):
        number = FIRST_CARD + (1 + (k - 1) % _NUMBERS if k else 0) + 0.5 + 0.498 * _ACROSS
        places = np.stack(np.broadcast_arrays(number[:, None], t, light[k], own[k]), axis=2)
        grown.append(Sheet(grid.astype(np.float32), places.astype(np.float32), hull.centre))
    return grown


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
