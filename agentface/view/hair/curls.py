"""Hair that does not follow guides: the tight curls of a short crop, and the bun of tied hair."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Indices
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.view.hair.hairline import Hairline, HairRoots
from agentface.view.hair.ribbons import unit_rows
from agentface.view.hair.strand_set import StrandSet, paints
from agentface.view.hair.strands import nearest_vertices
from agentface.view.hair.styles import REFERENCE_EYES, Amount, Style, knot_of

_WHOLE = 0.016
"""Metres behind the hairline of the forehead where a crop has its whole length."""
_UNEVEN = 0.6, 1.35
"""How long its hairs are there, beside their place: some are half as short, some twice as long."""
_FADE, _FAINTEST = 1.5, 0.12
"""The exponent with which short hairs fade, and how faint the shortest are."""
_COIL = 0.0013
"""Metres from a coil's axis to its hair where hair is as curly as it gets."""
_IN_A_CLUMP, _CLUMPED, _CLUMP_TINT = 9, 0.40, (0.9, 3.0)
"""Coils that gather, by how much of the way, and how dark or light clumps are."""
_BUN_SHARE = 0.35


def crop(
    roots: HairRoots, line: Hairline, style: Style, amount: Amount, look: HairLook, rng: np.random.Generator
) -> StrandSet:
    """Small coils that stand up from the scalp, wider with ``look.curl``."""
    count, t = len(roots), np.linspace(0.0, 1.0, amount.points)
    layer = rng.random(count)
    n = roots.normals
    x = unit_rows(np.cross(n, rng.normal(size=(count, 3))))
    y = np.cross(n, x)
    short = np.clip(roots.depth / line.taper(roots.places, _WHOLE) * rng.uniform(*_UNEVEN, count), 0.10, 1.0)
    height = look.volume * look.length * style.thickness * short * (0.62 + 0.38 * layer)
    radius = _COIL * look.curl * (0.6 + 0.8 * rng.random(count)) * (0.4 + 0.6 * short)
    turn = 2 * np.pi * (rng.random(count)[:, None] + (1.15 + 0.5 * rng.random(count)[:, None]) * t)
    lean = rng.normal(0, 0.0008, (count, 2)) * short[:, None]
    side = radius[:, None] * np.clip(3 * t, 0, 1)
    points = roots.places[:, None] + n[:, None] * (height[:, None] * t)[..., None]
    points = points + x[:, None] * (side * np.cos(turn) + lean[:, :1] * t)[..., None]
    points = points + y[:, None] * (side * np.sin(turn) + lean[:, 1:] * t)[..., None]
    clump = _clumps(roots, rng)
    points = points + _CLUMPED * (roots.places[clump] - roots.places)[:, None] * t[:, None] * short[:, None, None]
    tint = rng.uniform(*_CLUMP_TINT, count)[clump]
    paint = paints(look, tint, np.clip(1.2 * short**_FADE, _FAINTEST, 1.0), rng, 0.6)
    cover = (0.25 + 0.75 * layer[:, None]) * (0.4 + 0.6 * t)
    radii = amount.radius * (0.7 + 0.6 * rng.random(count)) * np.clip(short + 0.2, 0, 1)
    return StrandSet(points, radii, paint, cover, layer, np.ones(count))


def _clumps(roots: HairRoots, rng: np.random.Generator) -> Indices:
    """``(N,)``: the root that each curl's clump gathers about."""
    middle = rng.choice(len(roots), max(len(roots) // _IN_A_CLUMP, 1), replace=False)
    return np.asarray(middle[nearest_vertices(roots.places, roots.places[middle].astype(np.float32))], np.int32)


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
