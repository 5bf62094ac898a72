"""Grows the strands of a style: guides that follow a flow over the head, and locks of strands round each guide."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.view.hair.curls import bun, crop
from agentface.view.hair.hairline import Hairline, HairRoots
from agentface.view.hair.hull import Hull
from agentface.view.hair.ribbons import unit_rows
from agentface.view.hair.strand_set import StrandSet, paints
from agentface.view.hair.strands import Strands
from agentface.view.hair.styles import (
    GUIDE_STEP,
    REFERENCE_EYES,
    STYLES,
    Amount,
    Flow,
    Style,
    flow_of,
    lengths_of,
    parting_of,
)

_GUIDES, _GUIDE_POINTS = 420, 60
_GUIDE_SEED = 7
_WAVE = 0.090
"""Metres from wave to wave of wavy hair."""
_LOCKS_BEHIND = 0.0035
"""Metres behind the hairline where locks begin; single hairs stand before them."""
_HAIRS_ELSEWHERE = 0.05
_OVER_EAR = 0.002
"""Metres that hair may lie over the bare skin round an ear: from before it none is combed over it."""
_STRAY = 0.16
"""The part of the single hairs that leave their lock."""
_FULL = 0.050
"""Metres of locks that are as wide as locks get."""
_JOIN = 0.032
"""Metres of single hairs that do not."""


def groom(model: HeadModel, normals: Floats, look: HairLook, quality: str, rng: np.random.Generator) -> Strands:
    """The strands of ``look.style``, any but ``none``, for a quality; the same generator gives the same strands."""
    style = STYLES[look.style]
    amount = style.amounts[quality]
    line = Hairline(model, look.hairline)
    if look.style == "cropped":
        roots = HairRoots.drawn(model, normals, line, amount.hairs, rng)
        return crop(roots, line, style, amount, look, rng).in_order(model)
    hull = Hull(model, ears=style.over_ears)
    # the guides are the same for every quality, so that they show the same hair
    starts = HairRoots.drawn(model, normals, line, _GUIDES, np.random.default_rng(_GUIDE_SEED))
    thickness = style.thickness * look.volume * line.unit / REFERENCE_EYES
    guides = guides_from(starts, flow_of(model, look), hull, style, thickness)
    locks = _Locks(starts, guides, lengths_of(model, look, guides), hull, style, thickness, parting_of(model, look))
    roots = HairRoots.drawn(model, normals, line, amount.locks, rng, behind=_LOCKS_BEHIND)
    strands = locks.grown(roots, amount, look, rng)
    roots = HairRoots.drawn(model, normals, line, amount.hairs, rng, elsewhere=_HAIRS_ELSEWHERE)
    strands = strands.joined(locks.grown(roots, amount, look, rng, single=True))
    if not style.over_ears:
        between = 0.5 * (strands.points[:, 1:] + strands.points[:, :-1])
        dense = np.concatenate([strands.points, between], axis=1)
        off_ear = line.off_ear(dense.reshape(-1, 3)).reshape(dense.shape[:2])
        strands = strands.chosen(off_ear.min(axis=1) > -_OVER_EAR)
    if look.style == "bun":
        strands = strands.joined(bun(model, amount, strands.points.shape[1] - 1, look, rng))
    return strands.in_order(model)


def guides_from(starts: HairRoots, flow: Flow, hull: Hull, style: Style, thickness: float) -> Doubles:
    """``(G, K, 3)``: a point every ``GUIDE_STEP`` metres."""
    at = starts.places
    heading = unit_rows(0.7 * starts.normals + flow(at, 0.0))
    line = [at]
    for k in range(1, _GUIDE_POINTS):
        pull = unit_rows(flow(at, k * GUIDE_STEP) - [0.0, style.weight * min(1.0, k / 4), 0.0])
        heading = unit_rows(style.stiff * heading + (1 - style.stiff) * pull)
        reached = hull.hold(at + GUIDE_STEP * heading, 0.35 * thickness * min(1.0, k / 4), 0.004)
        heading, at = unit_rows(reached - at), reached
        line.append(at)
    return smoothed(np.stack(line, axis=1), 4)


class _Locks:
    """Locks, and single hairs on them, that follow the guide nearest to their root."""

    def __init__(
        self,
        starts: HairRoots,
        guides: Doubles,
        lengths: Doubles,
        hull: Hull,
        style: Style,
        thickness: float,
        parting: float,
    ) -> None:
        self.starts, self.guides, self.lengths = starts, guides, lengths
        self.hull, self.style, self.thickness, self.parting = hull, style, thickness, parting

    def grown(
        self, roots: HairRoots, amount: Amount, look: HairLook, rng: np.random.Generator, *, single: bool = False
    ) -> StrandSet:
        """The locks of ``roots``, or ``single`` hairs outside of the locks."""
        count = len(roots)
        mine = self._nearest(roots.places)
        lock = np.random.default_rng(_GUIDE_SEED).random(_GUIDES)[mine]
        layer, stray = rng.random(count), single * (rng.random(count) < _STRAY).astype(float)
        layer = 1.0 + 0.1 * layer if single else layer
        # they turn most near the root, waves turn everywhere
        t = np.linspace(0.0, 1.0, round(amount.points * (1 + 1.5 * look.curl))) ** (1.6 - 0.5 * look.curl)
        cut = self.style.blunt + (1.02 - self.style.blunt) * rng.random(count) ** 0.6
        along = (self.lengths[mine] * cut)[:, None] * t
        if single:  # those of the hairline soon join the locks
            along *= np.where(stray == 0, np.minimum(1.0, _JOIN / along[:, -1]), 1.0)[:, None]
        closing = self.style.clump * (0.5 + lock)[:, None] * np.clip((t - 0.15) / 0.85, 0, 1) ** 1.3
        points = followed(self.guides, mine, along)
        points = points + (roots.places - self.starts.places[mine])[:, None] * (1 - closing)[..., None]
        points = points + _wander(count, t, rng, np.minimum(0.0010, 0.02 * along[:, -1]) * (1 + 2 * stray))
        points = self._layered(roots, points, along, layer)
        if look.curl:
            points = points + (0.006 * look.curl) * waves(self.hull, points, along, lock)
            points[:, 1:] = self.hull.push_out(points[:, 1:], 0.0010)
        fine = np.clip(roots.depth / 0.012, 0.30, 1.0)
        opacity = 0.95 * np.clip(roots.depth / 0.010, 0.30, 1.0)
        paint = paints(look, 0.96 + 0.16 * lock, opacity, rng, 0.3, single=single)
        cover = (0.65 + 0.35 * layer[:, None] ** 0.7) * (0.72 + 0.28 * np.clip(along / 0.015, 0, 1))
        fine = fine if single else fine * np.clip(along[:, -1] / _FULL, 0.7, 1.0)
        radii = (amount.radius if single else amount.width) * fine * (0.7 + 0.6 * rng.random(count))
        return StrandSet(points, radii, paint, np.clip(cover, 0, 1), layer, np.full(count, float(single)))

    def _nearest(self, places: Doubles) -> np.typing.NDArray[np.intp]:
        """The nearest guide on the same side of the parting."""
        guides = self.starts.places
        apart = ((places[:, None] - guides[None]) ** 2).sum(2)
        across = (places[:, None, 0] > self.parting) != (guides[None, :, 0] > self.parting)
        return np.asarray((apart + across).argmin(1))

    def _layered(self, roots: HairRoots, points: Doubles, along: Doubles, layer: Doubles) -> Doubles:
        """Each strand at its own height in the hair, from its root on the skin."""
        # short hair cannot stand as high as long hair
        most = np.minimum(self.thickness * np.clip(roots.depth / 0.016, 0.25, 1.0), 0.22 * along[:, -1])
        lifted = np.clip((along + 0.001) / self.style.rise, 0, 1) ** 0.6
        # most strands lie near the outside, so that no single one stands out of it
        height = 0.0008 + most[:, None] * (0.12 + 0.88 * layer[:, None] ** 0.35) * lifted
        points = self.hull.hold(points, height, 0.0015)
        points[:, 0] = roots.places
        points = smoothed(points, 4)
        points[:, 1:] = self.hull.push_out(points[:, 1:], 0.6 * height[:, 1:])
        return points


def followed(guides: Doubles, mine: np.typing.NDArray[np.intp], along: Doubles) -> Doubles:
    """``(N, P, 3)``: the points ``along (N, P)`` metres down the guides ``mine (N,)`` of ``guides (G, K, 3)``."""
    at = np.clip(along / GUIDE_STEP, 0, _GUIDE_POINTS - 1.001)
    low = at.astype(int)
    part = (at - low)[..., None]
    return np.asarray((1 - part) * guides[mine[:, None], low] + part * guides[mine[:, None], low + 1])


def waves(hull: Hull, points: Doubles, along: Doubles, lock: Doubles) -> Doubles:
    """``(N, P, 3)``: how wavy hair goes to and fro, in heights of the waves; neighbouring locks wave together."""
    out, across = hull.outward(points), hull.sideways(points)
    phase = 60.0 * points[:, 0, 0] + 45.0 * points[:, 0, 2] + 0.5 * lock
    turn = 2 * np.pi * along / _WAVE + phase[:, None]
    grown = np.clip(along / _WAVE, 0, 1)[..., None]
    return np.asarray(grown * (across * np.sin(turn)[..., None] + 0.25 * out * np.cos(turn)[..., None]))


def smoothed(lines: Doubles, times: int) -> Doubles:
    """``(N, P, 3)`` with every inner point drawn to its neighbours."""
    for _ in range(times):
        lines = lines.copy()
        lines[:, 1:-1] = 0.5 * lines[:, 1:-1] + 0.25 * (lines[:, :-2] + lines[:, 2:])
    return lines


def _wander(count: int, t: Doubles, rng: np.random.Generator, size: Doubles) -> Doubles:
    """``(N, P, 3)``: each hair's own slow way off its lock, none at the root."""
    a, b = rng.normal(size=(2, count, 1, 3))
    turn = np.pi * t[None, :, None]
    return np.asarray(size[:, None, None] * (a * np.sin(turn * 0.9) + 0.6 * b * np.sin(2.3 * turn)) * t[None, :, None])
