"""Hair that does not follow guides: the tight curls of a short crop, and the bun of tied hair."""

from __future__ import annotations

import numpy as np

from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.view.hair.hairline import HairRoots
from agentface.view.hair.ribbons import unit_rows
from agentface.view.hair.strand_set import StrandSet, paints
from agentface.view.hair.styles import REFERENCE_EYES, Amount, Style, knot_of

_BUN_SHARE = 0.35


def crop(roots: HairRoots, style: Style, amount: Amount, look: HairLook, rng: np.random.Generator) -> StrandSet:
    """Small coils that stand up from the scalp, wider with ``look.curl``."""
    count, t = len(roots), np.linspace(0.0, 1.0, amount.points)
    layer = rng.random(count)
    n = roots.normals
    x = unit_rows(np.cross(n, rng.normal(size=(count, 3))))
    y = np.cross(n, x)
    short = np.clip(roots.depth / 0.018, 0.16, 1.0)
    height = look.volume * look.length * style.thickness * short * (0.45 + 0.55 * layer)
    radius = 0.0011 * look.curl * (0.6 + 0.8 * rng.random(count)) * (0.4 + 0.6 * short)
    turn = 2 * np.pi * (rng.random(count)[:, None] + (0.8 + 0.5 * rng.random(count)[:, None]) * t)
    lean = rng.normal(0, 0.0012, (count, 2)) * short[:, None]
    side = radius[:, None] * np.clip(3 * t, 0, 1)
    points = roots.places[:, None] + n[:, None] * (height[:, None] * t)[..., None]
    points = points + x[:, None] * (side * np.cos(turn) + lean[:, :1] * t)[..., None]
    points = points + y[:, None] * (side * np.sin(turn) + lean[:, 1:] * t)[..., None]
    paint = paints(look, np.full(count, 1.7), 1.0 * np.clip(roots.depth / 0.012, 0.25, 1.0), rng, 0.6)
    cover = (0.25 + 0.75 * layer[:, None]) * (0.4 + 0.6 * t)
    radii = amount.radius * (0.7 + 0.6 * rng.random(count)) * np.clip(short + 0.2, 0, 1)
    return StrandSet(points, radii, paint, cover, layer, np.ones(count))


def bun(model: HeadModel, amount: Amount, pieces: int, look: HairLook, rng: np.random.Generator) -> StrandSet:
    """Locks of ``pieces`` pieces wound round a ball where tied hair ends."""
    count, scale = round(_BUN_SHARE * amount.locks), model.landmarks.eye_separation / REFERENCE_EYES
    t = np.linspace(0.0, 1.0, pieces + 1)
    layer = rng.random(count)
    # circles about axes near the one that points back, each at its own latitude
    axis = unit_rows(np.array([0.0, 0.25, -1.0]) + 0.28 * rng.normal(size=(count, 3)))
    x = unit_rows(np.cross(axis, [0.3, 1.0, 0.0]))
    y = np.cross(axis, x)
    latitude = rng.uniform(-0.7, 1.25, count)[:, None]
    turn = 2 * np.pi * rng.random(count)[:, None] + (1.1 + 0.9 * rng.random(count)[:, None]) * np.pi * t
    winding = latitude + 0.5 * (t - 0.5)
    ball = 0.026 * scale * look.volume * (0.86 + 0.14 * layer)[:, None]
    flat, back = ball * np.cos(winding), 0.8 * ball * np.sin(winding)
    points = (flat * np.cos(turn))[..., None] * x[:, None] + (flat * np.sin(turn))[..., None] * y[:, None]
    points = points + back[..., None] * axis[:, None] + knot_of(model) - [0.0, 0.0, 0.010 * scale]
    paint = paints(look, np.ones(count), np.full(count, 0.95), rng, 0.7)
    cover = np.repeat((0.35 + 0.65 * layer)[:, None], pieces + 1, axis=1)
    radii = amount.width * (0.7 + 0.6 * rng.random(count))
    return StrandSet(points, radii, paint, cover, layer, np.zeros(count))
