"""Eyebrows and eyelashes, placed by landmarks and lid rings."""

from __future__ import annotations

import numpy as np

from agentface.conventions import SIDES, Doubles, Floats, Indices
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.head.ring_names import LidRing
from agentface.view.hair.ribbons import Hairs, Roots, roots_along, roots_in_front, unit_rows

_BROW_HAIRS = 700
_PALEST = 1.2
"""By how much of the colour the few palest hairs of brows are lighter."""
_UPPER_LASHES, _LOWER_LASHES = 150, 60
_FLAT_RISE, _TAPERED, _INWARD = 0.5, 0.62, 1.0
"""How high a straight brow lies between the ends and the middle of the arch; the part of its height that its tail
loses; the exponent with which hairs gather at the inner end."""
_BROW_OPACITY, _INNER_OPACITY = (0.85, 1.0), 0.55
"""And its part at the inner end, where brows begin softly."""
_BROW_RADII = 0.00009, 0.00013
"""Metres of half a hair's width."""
_LEANING = 30
"""Degrees by which the outermost hairs turn to the brow's middle line."""
_STRAY, _STRAYING = 0.10, 1.1
"""The part of the hairs that stand anywhere at the inner end, none at the tail; half heights up to which they do."""
_LASH_LINE, _GATHERED = 0.030, 0.9
"""Metres of lid that lashes stand on; how far the tips of a bundle come together."""
_UPPER_UNEQUAL, _LOWER_UNEQUAL = (0.55, 1.15), (0.96, 1.12)
"""How long the bundles of the upper and lower lashes are."""
_LASH_TINTS = {LidRing.LASHES: (0.75, 0.25), LidRing.EDGE: (0.5, 0.12), LidRing.EDGE + 1: (0.22, 0.0)}
"""How much of the skin's colour they cover round the upper and the lower row, by ring."""
_REFERENCE_EYES = 0.0525
"""The distance between the pupils, metres, that the sizes below are meant for."""


class BrowLine:
    """The left eyebrow's middle line: x and y in metres over ``s``, 0 at the inner end and 1 at the tail."""

    def __init__(self, model: HeadModel, arch: float = 1.0) -> None:
        """``arch`` 0..1: how much of the landmarks' arch it has."""
        at, self._arch = model.landmarks, arch
        self.scale = at.eye_separation / _REFERENCE_EYES
        self.inner, self.outer = (
            float(at["brow_inner_l"][0]) - 0.0015 * self.scale,
            float(at["brow_outer_l"][0]) + 0.001 * self.scale,
        )
        points = np.array([at[f"brow_{name}_l"] for name in ("inner", "middle", "outer")], np.float64)
        self.curve = np.polyfit(points[:, 0], points[:, 1], 2)
        # a flatter one is as high on the whole
        ends = np.polyfit(points[[0, 2], 0], points[[0, 2], 1], 1)
        level = np.polyadd(ends, [_FLAT_RISE * float(points[1, 1] - np.polyval(ends, points[1, 0]))])
        self.curve = np.polyadd(arch * self.curve, (1.0 - arch) * level)

    def place(self, s: Doubles) -> tuple[Doubles, Doubles]:
        """The middle line's x and y."""
        x = self.inner + (self.outer - self.inner) * s
        # the arch is highest two thirds out, and the tail comes down to a point
        return x, np.polyval(self.curve, x) - self.scale * (
            0.0012 * (1 - s) ** 2 - 0.0008 * self._arch * np.sin(np.pi * s)
        )

    def direction(self, s: Doubles) -> Doubles:
        """``(N, 2)`` unit tangents towards the tail."""
        (x0, y0), (x1, y1) = self.place(s - 0.01), self.place(s + 0.01)
        return unit_rows(np.stack([x1 - x0, y1 - y0], axis=1))

    def half_height(self, s: Doubles) -> Doubles:
        """Half of the brow's height, metres."""
        return np.asarray(0.0043 * self.scale * (1 - _TAPERED * s**1.5) * (0.6 + 0.4 * np.minimum(6 * s, 1)))

    def density(self, vertices: Floats) -> Floats:
        """``(V,)`` 0..1: how much brow covers each vertex, for the tint of the skin below."""
        x, y = np.abs(vertices[:, 0]).astype(np.float64), vertices[:, 1]
        s = np.clip((x - self.inner) / (self.outer - self.inner), 0, 1)
        over = (y - self.place(s)[1]) / (1.1 * self.half_height(s))
        beyond = (x - self.place(s)[0]) / (0.002 * self.scale)
        return np.asarray(np.exp(-(over**2) - beyond**2) * (vertices[:, 2] > 0), np.float32)


def brow_hairs(model: HeadModel, normals: Floats, look: HairLook, rng: np.random.Generator) -> Hairs:
    """Both eyebrows."""
    line = BrowLine(model, look.brow_arch)
    count = round(_BROW_HAIRS * look.brow_density)
    near = _brow_triangles(model)
    places, flats, clear = [], [], []
    for side in (1.0, -1.0):
        s, off = rng.random(count) ** _INWARD, rng.normal(0, 0.45, count).clip(-1, 1)
        stray = rng.random(count) < _STRAY * (1 - s)
        off = np.where(stray, rng.uniform(-_STRAYING, _STRAYING, count), off)
        clear.append(_INNER_OPACITY + (1.0 - _INNER_OPACITY) * np.minimum(4 * s, 1))
        x, y = line.place(s)
        places.append(np.stack([side * x, y + off * line.half_height(s)], axis=1))
        # hairs stand up at the inner end and lie along the brow farther out, leaning to its middle line
        inward = -_LEANING * off.clip(-1, 1) * np.minimum(4 * s, 1)
        lean = np.radians(34 * np.exp(-7 * s) + 7 * (1 - s) + inward + rng.normal(0, 6, count))
        length = (
            0.0064 * line.scale * (0.6 + 0.5 * rng.random(count)) * (0.7 + 0.3 * np.minimum(5 * s, 1)) * (1 - 0.25 * s)
        )
        halfway, end = (_turned(line.direction(s), lean * part) * length[:, None] for part in (1.0, 0.55))
        flats.append(np.stack([0.5 * halfway, 0.25 * halfway + 0.75 * end], axis=1) * [side, 1.0])
    flat = np.concatenate(flats)
    left = model.vertices[near, 0].max(1) > 0
    roots = joined_roots(
        [roots_in_front(places[0], model.vertices, near[left]), roots_in_front(places[1], model.vertices, near[~left])]
    )
    n = roots.frames(model.vertices, normals)[1][:, :, 2]
    up = unit_rows(np.array([0.0, 1.0, 0.0]) - n * n[:, 1:2])
    x = np.cross(up, n)
    lift = np.array([0.0007, 0.0005]) * line.scale * (0.5 + rng.random((2 * count, 1)))
    curves = flat[..., :1] * x[:, None] + flat[..., 1:] * up[:, None] + lift[..., None] * n[:, None]
    radii = rng.uniform(*_BROW_RADII, 2 * count) * line.scale
    opacity = rng.uniform(*_BROW_OPACITY, 2 * count) * np.concatenate(clear)
    paint = np.column_stack([_shades(look.brow_colour, 0.4 * look.grey, 2 * count, rng), opacity])
    return Hairs.grown(roots, (model.vertices, normals), curves[:, 0], curves[:, 1], radii, paint)


def lash_hairs(model: HeadModel, normals: Floats, look: HairLook, rng: np.random.Generator) -> Hairs:
    """Upper and lower lashes of both eyes."""
    length = 0.001 * look.lash_length_mm
    rng = rng.spawn(1)[0]  # the same lashes however many hairs brows have
    parts = [
        _lash_row(model, normals, side, upper=upper, count=count, length=length * share, rng=rng)
        for side in SIDES
        for upper, count, share in ((True, _UPPER_LASHES, 1.0), (False, _LOWER_LASHES, 0.45))
    ]
    return joined(parts)


def _lash_row(
    model: HeadModel, normals: Floats, side: str, *, upper: bool, count: int, length: float, rng: np.random.Generator
) -> Hairs:
    ring = model.eyelids.rings[side][LidRing.LASHES]
    half = np.array(ring.upper if upper else ring.lower, np.int32)
    half = half if side == "l" else half[::-1]  # from the temple inward on both sides
    outward = np.linspace(0.95, 0.10, count) + rng.normal(0, 0.006 if upper else 0.016, count)  # 1 at the temple
    roots = roots_along(half, model.vertices, np.clip(1 - outward, 0.0, 1.0))
    lengths = (length * (0.45 + 0.65 * outward) * (0.7 + 0.5 * rng.random(count)))[:, None]
    # lashes stick together by twos to sixes, and are unequal
    bundle = np.repeat(np.arange(count), rng.integers(2, 7, count))[:count]
    middle = (np.bincount(bundle, outward) / np.maximum(np.bincount(bundle), 1))[bundle]
    lengths = lengths * rng.uniform(*(_UPPER_UNEQUAL if upper else _LOWER_UNEQUAL), count)[bundle][:, None]
    together = _GATHERED * _LASH_LINE * (middle - outward)[:, None] / lengths
    fan = (outward - 0.30) * 1.5 + rng.normal(0, 0.16, count)[bundle] + rng.normal(0, 0.05 if upper else 0.10, count)
    fan = (fan[:, None] + together) * (1.0 if side == "l" else -1.0)
    rise = (-0.20, 0.36) if upper else (-0.10, -0.35)
    reach = (0.55, 0.72) if upper else (0.60, 1.05)
    bends = lengths * np.concatenate([0.25 * fan, np.full_like(fan, rise[0]), np.full_like(fan, reach[0])], axis=1)
    tips = lengths * np.concatenate([0.75 * fan, np.full_like(fan, rise[1]), np.full_like(fan, reach[1])], axis=1)
    radii = (0.00013 if upper else 0.00007) * (0.8 + 0.4 * rng.random(count))
    paint = np.tile([0.008, 0.006, 0.005, 0.9 if upper else 0.55], (count, 1))
    return Hairs.grown(roots, (model.vertices, normals), bends, tips, radii, paint)


def lash_line(model: HeadModel) -> Doubles:
    """``(V,)`` 0..1: how much the roots of lashes, and the shade that they cast, darken each vertex of the lids."""
    line = np.zeros(len(model.vertices))
    for rings in model.eyelids.rings.values():
        for number, (above, below) in _LASH_TINTS.items():
            line[np.array(rings[number].upper)] = above
            line[np.array(rings[number].lower[1:-1])] = below
    return line


def joined(parts: list[Hairs]) -> Hairs:
    """Several bundles of hairs as one."""
    roots = joined_roots([part.roots for part in parts])
    fields = (np.concatenate([getattr(p, name) for p in parts]) for name in ("bends", "tips", "radii", "paint"))
    return Hairs(roots, *fields)


def joined_roots(parts: list[Roots]) -> Roots:
    """Several rows of roots as one."""
    return Roots(np.concatenate([part.corners for part in parts]), np.concatenate([part.weights for part in parts]))


def _turned(directions: Doubles, angles: Doubles) -> Doubles:
    c, s = np.cos(angles), np.sin(angles)
    x, y = directions.T
    return np.stack([x * c - y * s, x * s + y * c], axis=1)


def _shades(colour: list[float], grey: float, count: int, rng: np.random.Generator) -> Doubles:
    """A colour with each hair a little lighter or darker, the part ``grey`` of them grey."""
    shades = np.asarray(colour) * (0.7 + 0.5 * rng.random((count, 1)) + _PALEST * rng.random((count, 1)) ** 5)
    return np.where(rng.random((count, 1)) < grey, 0.07 + 0.05 * rng.random((count, 1)), shades)


def _brow_triangles(model: HeadModel) -> Indices:
    """``(T, 3)``: the triangles that brows can grow on, some millimetres more than the brows themselves."""
    at, margin = model.landmarks, 0.012
    x, y = np.abs(model.vertices[:, 0]), model.vertices[:, 1]
    inner, outer, top = at["brow_inner_l"], at["brow_outer_l"], at["brow_middle_l"]
    inside = (x > inner[0] - margin) & (x < outer[0] + margin) & (y < top[1] + margin) & (y > outer[1] - 1.5 * margin)
    inside &= model.vertices[:, 2] > outer[2] - 2 * margin
    return np.asarray(model.triangles[inside[model.triangles].all(1)])
