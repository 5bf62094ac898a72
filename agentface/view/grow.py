"""Grows the strands of a style: guides that follow a flow over the head, and locks of strands round each guide."""

from __future__ import annotations

import numpy as np

from agentface.anatomy.model import HeadModel
from agentface.conventions import Doubles, Floats
from agentface.view.curls import bun, crop
from agentface.view.growth import Growth, paints
from agentface.view.hair import Hairline, HairRoots
from agentface.view.hull import Hull
from agentface.view.look import HairLook
from agentface.view.ribbons import unit_rows
from agentface.view.strands import Strands
from agentface.view.styles import (
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
_STRAY = 0.03
"""The part of the strands that leave their lock."""


def grow(model: HeadModel, normals: Floats, look: HairLook, quality: str, rng: np.random.Generator) -> Strands:
    """The strands of ``look.style``, any but ``none``, for a quality; the same generator gives the same strands."""
    style = STYLES[look.style]
    amount = style.amounts[quality]
    line = Hairline(model, look.hairline)
    if look.style == "cropped":
        roots = HairRoots.drawn(model, normals, line, amount.strands, rng)
        return crop(roots, style, amount, look, rng).strands(model)
    hull = Hull(model, ears=style.over_ears)
    # the guides are the same for every quality, so that they show the same hair
    starts = HairRoots.drawn(model, normals, line, _GUIDES, np.random.default_rng(_GUIDE_SEED))
    thickness = style.thickness * look.volume * line.unit / REFERENCE_EYES
    guides = _guides(starts, flow_of(model, look), hull, style, thickness)
    locks = _Locks(starts, guides, lengths_of(model, look, guides), hull, style, thickness, parting_of(model, look))
    growth = locks.grown(HairRoots.drawn(model, normals, line, amount.strands, rng), amount, look, rng)
    if look.style == "bun":
        growth = growth.joined(bun(model, amount, look, rng))
    return growth.strands(model)


def _guides(starts: HairRoots, flow: Flow, hull: Hull, style: Style, thickness: float) -> Doubles:
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
    return _smoothed(np.stack(line, axis=1), 4)


class _Locks:
    """Strands that follow the guide nearest to their root."""

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

    def grown(self, roots: HairRoots, amount: Amount, look: HairLook, rng: np.random.Generator) -> Growth:
        """The strands of ``roots``."""
        count = len(roots)
        mine = self._nearest(roots.places)
        lock = np.random.default_rng(_GUIDE_SEED).random(_GUIDES)[mine]
        layer, stray = rng.random(count), (rng.random(count) < _STRAY).astype(float)
        t = np.linspace(0.0, 1.0, amount.points) ** 1.3  # they turn most near the root
        along = (self.lengths[mine] * (0.84 + 0.20 * rng.random(count) ** 0.6))[:, None] * t
        closing = self.style.clump * (0.5 + lock)[:, None] * np.clip((t - 0.15) / 0.85, 0, 1) ** 1.3
        points = self._followed(mine, along)
        points = points + (roots.places - self.starts.places[mine])[:, None] * (1 - closing)[..., None]
        points = points + _wander(count, t, rng, np.minimum(0.0010, 0.02 * along[:, -1]) * (1 + 2 * stray))
        points = self._layered(roots, points, along, layer)
        if look.curl:
            points = points + (0.006 * look.curl) * self._waves(points, along, lock)
            points[:, 1:] = self.hull.push_out(points[:, 1:], 0.0010)
        fine = np.clip(roots.depth / 0.012, 0.30, 1.0)
        paint = paints(look, 0.92 + 0.24 * lock, 0.95 * np.clip(roots.depth / 0.010, 0.45, 1.0), rng, 0.6)
        cover = (0.45 + 0.55 * layer[:, None] ** 0.7) * (0.72 + 0.28 * np.clip(along / 0.015, 0, 1))
        radii = amount.radius * fine * (0.7 + 0.6 * rng.random(count)) * (1 - 0.5 * stray)
        return Growth(points, radii, paint, cover, layer, np.maximum(stray, roots.depth < 0.007))

    def _nearest(self, places: Doubles) -> np.typing.NDArray[np.intp]:
        """The nearest guide on the same side of the parting."""
        guides = self.starts.places
        apart = ((places[:, None] - guides[None]) ** 2).sum(2)
        across = (places[:, None, 0] > self.parting) != (guides[None, :, 0] > self.parting)
        return np.asarray((apart + across).argmin(1))

    def _followed(self, mine: np.typing.NDArray[np.intp], along: Doubles) -> Doubles:
        """``(N, P, 3)``: the points ``along`` metres down the guides."""
        at = np.clip(along / GUIDE_STEP, 0, _GUIDE_POINTS - 1.001)
        low = at.astype(int)
        part = (at - low)[..., None]
        return np.asarray((1 - part) * self.guides[mine[:, None], low] + part * self.guides[mine[:, None], low + 1])

    def _layered(self, roots: HairRoots, points: Doubles, along: Doubles, layer: Doubles) -> Doubles:
        """Each strand at its own height in the hair, from its root on the skin."""
        # short hair cannot stand as high as long hair
        most = np.minimum(self.thickness * np.clip(roots.depth / 0.016, 0.25, 1.0), 0.4 * along[:, -1])
        lifted = np.clip((along + 0.001) / self.style.rise, 0, 1) ** 0.6
        # most strands lie near the outside, so that no single one stands out of it
        height = 0.0008 + most[:, None] * (0.12 + 0.88 * layer[:, None] ** 0.35) * lifted
        points = self.hull.hold(points, height, 0.0015)
        points[:, 0] = roots.places
        points = _smoothed(points, 4)
        points[:, 1:] = self.hull.push_out(points[:, 1:], 0.6 * height[:, 1:])
        return points

    def _waves(self, points: Doubles, along: Doubles, lock: Doubles) -> Doubles:
        out = self.hull.outward(points)
        across = unit_rows(np.cross(np.gradient(points, axis=1), out))
        # neighbouring locks wave together
        phase = 60.0 * points[:, 0, 0] + 45.0 * points[:, 0, 2] + 1.2 * lock
        turn = 2 * np.pi * along / _WAVE + phase[:, None]
        grown = np.clip(along / _WAVE, 0, 1)[..., None]
        return np.asarray(grown * (across * np.sin(turn)[..., None] + 0.6 * out * np.cos(turn)[..., None]))


def _smoothed(lines: Doubles, times: int) -> Doubles:
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
