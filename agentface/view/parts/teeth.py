"""Where a vertex lies on its tooth, for shading that goes from tooth to tooth."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.mesh.smoothstep import smoothstep

_EVENED = 0.55  # of the way from a crown's own normals to those of the row
_TONES = 0.10, 0.22, 0.75, 0.50, 0.55, 0.65, 0.70  # from the middle incisor to the last molar
_UNLIKE, _ANY = 0.10, 12.9  # how far a tooth is from the tone of its kind, by a sine no two share


def evened_facing(positions: Floats, facing: Floats, tooth: Floats) -> Floats:
    """``(P, 3)``: the normals ``facing (P, 3)`` of a row's front, nearer to those of the row as a whole.

    Light goes a way through enamel before it comes back: it makes less of the bulge of each crown than a hard
    surface's would. ``tooth (P,)`` above 0.5 on teeth.
    """
    crowns = tooth > 0.5
    if not crowns.any():
        return facing
    flat = positions[:, [0, 2]] - [0.0, positions[crowns, 2].min()]
    row = np.zeros_like(facing)
    row[:, [0, 2]] = flat / np.maximum(np.abs(flat[crowns]).max(0), 1e-6) ** 2  # of the ellipse that the row stands on
    row /= np.maximum(np.linalg.norm(row, axis=1, keepdims=True), 1e-6)
    share = _EVENED * crowns * smoothstep(0.0, 0.4, (row * facing).sum(1))
    mixed = facing + share[:, None] * (row - facing)
    return np.asarray(mixed / np.maximum(np.linalg.norm(mixed, axis=1, keepdims=True), 1e-6), np.float32)


def crown_places(positions: Floats, triangles: Indices, tooth: Floats) -> Floats:
    """``(P, 2)`` for the vertices of a row of teeth: across -1..1 and up 0 (biting edge)..1 (gum) on each crown.

    ``positions (P, 3)``, ``tooth (P,)`` above 0.5 on teeth; each tooth is one connected piece. Elsewhere 0.
    """
    places = np.zeros((len(positions), 2), np.float32)
    piece = _pieces(len(positions), triangles)
    gum = positions[tooth <= 0.5, 1]
    for label in np.unique(piece[tooth > 0.5]):
        mine = np.flatnonzero(piece == label)
        crown = positions[mine].astype(np.float64)
        flat = crown[:, [0, 2]] - crown[:, [0, 2]].mean(0)
        # a tooth stands across the way from the middle of the mouth to it, which the arch's ellipse gives
        middle = crown[:, [0, 2]].mean(0) - [0.0, positions[:, 2].min()]
        across = np.array([middle[1], -middle[0]]) / np.linalg.norm(middle)
        aside = flat @ across
        aside -= 0.5 * (aside.min() + aside.max())
        up = crown[:, 1] - crown[:, 1].min()
        up /= up.max()
        roots_above = not len(gum) or gum.mean() > crown[:, 1].mean()
        places[mine, 0] = aside / np.abs(aside).max()
        places[mine, 1] = up if roots_above else 1 - up
    return places


def _pieces(count: int, triangles: Indices) -> Indices:
    """``(count,)``: the smallest vertex that each is connected with."""
    piece = np.arange(count, dtype=np.int32)
    while True:
        least = piece[triangles].min(1)
        before = piece.copy()
        for corner in range(3):
            np.minimum.at(piece, triangles[:, corner], least)
        piece = piece[piece]
        if np.array_equal(piece, before):
            return piece


def meeting_places(positions: Floats, triangles: Indices, tooth: Floats) -> Floats:
    """``(P, 2)``: as :func:`crown_places`, but -1 and 1 across where the next tooth meets it: crowns overlap."""
    places = crown_places(positions, triangles, tooth)
    row, flat = _row(positions, triangles, tooth), positions[:, [0, 2]]
    middles = [flat[mine].mean(0) for mine in row]
    for here, mine in enumerate(row):
        beside = [_towards(flat, middles, row, here, there) for there in (here - 1, here + 1) if 0 <= there < len(row)]
        sides = [way * np.sign(way @ places[mine, 0]) for way in beside]
        for way, side in zip(beside, sides, strict=True):
            nearest = (way > 0) & (way >= np.max(beside, axis=0))
            places[mine[nearest], 0] = side[nearest]
    return places


def _towards(flat: Floats, middles: list[Floats], row: list[Indices], here: int, there: int) -> Floats:
    """How far the vertices of tooth ``here`` lie from its middle to where ``there`` meets it, 1."""
    way = middles[there] - middles[here]
    apart = float(np.linalg.norm(way))
    own, other = (flat[row[here]] - middles[here]) @ way, (middles[there] - flat[row[there]]) @ way
    meets = own.max() * apart**2 / (own.max() + other.max())
    return np.asarray(own / meets)


def tones(positions: Floats, triangles: Indices, tooth: Floats) -> Floats:
    """``(P,)`` how dark and yellow the tooth of a vertex is, 0..1: canines most, and no two alike."""
    tone = np.zeros(len(positions), np.float32)
    row = _row(positions, triangles, tooth)
    for here, mine in enumerate(row):
        from_middle = min(abs(here + 0.5 - 0.5 * len(row)), len(_TONES) - 0.5)
        tone[mine] = _TONES[int(from_middle)] + _UNLIKE * np.sin(_ANY * here)
    return np.clip(tone, 0.0, 1.0)


def _row(positions: Floats, triangles: Indices, tooth: Floats) -> list[Indices]:
    """The vertices of each tooth, from one end of the row to the other."""
    piece = _pieces(len(positions), triangles)
    row = [np.flatnonzero(piece == label).astype(np.int32) for label in np.unique(piece[tooth > 0.5])]
    back = float(positions[:, 2].min())
    return sorted(row, key=lambda mine: float(np.arctan2(positions[mine, 0].mean(), positions[mine, 2].mean() - back)))
