"""What is free at a place in the mouth, and places held there."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.deform.tongue import passage
from agentface.deform.tongue.passage import BACK, COLUMNS, DEPTH, EDGE, FRONT, MIDDLE, Places
from agentface.deform.tongue.sections import (
    AHEAD,
    FAN,
    FORCE,
    HEEDLESS,
    LEFT,
    OUT,
    OVER,
    RIGHT,
    SPREADS,
    UNLIMITED,
    Sections,
)
from agentface.deform.tongue.tables import PLUMPER, STATIONS, TongueTables

_CARRIES = 0.95  # of what lifts a station, what lifts the next one: it does not hang down at once
_PALATE, _FLOOR = 0.012, 0.0062  # m from the edges of the teeth
_CROSSES, _SETS_IN = 0.66, 0.25
"""Of the arch's depth: where it is as wide as the tongue between the teeth, and over which its edges set in."""
_SOFT = 0.0006  # m, over which a limit sets in
_STEEP = 2.0  # how fast floor and palate fall away before the teeth
_SPREADS = 0.15  # how much wider a place before the lips is, a metre of its way
_LIPS_FROM, _LIPS_WHOLE = 0.012, 0.004
"""m behind the lips, where their opening begins to tell, and from where it tells whole."""
_PASSES = 0.0015  # m under the upper teeth, which count where the lower lip would push the tongue into them


def posed(jaw: Floats, x: Places, y: Places, z: Places) -> tuple[Places, Places, Places]:
    """Places in the jaw's axes, in the head's."""
    return (
        jaw[0, 0] * x + jaw[0, 1] * y + jaw[0, 2] * z + jaw[0, 3],
        jaw[1, 0] * x + jaw[1, 1] * y + jaw[1, 2] * z + jaw[1, 3],
        jaw[2, 0] * x + jaw[2, 1] * y + jaw[2, 2] * z + jaw[2, 3],
    )


def lips_at(now: Sections, x: float) -> tuple[float, float, float, float, float, float]:
    """The lips at ``x`` m: a column of ``now.lips``."""
    column = 1
    while column < COLUMNS - 1 and now.across[column] > x:
        column += 1
    first, last = now.across[column - 1], now.across[column]
    part = min(max((first - x) / max(first - last, 1e-6), 0.0), 1.0)
    one, other = now.lips[:, column - 1], now.lips[:, column]
    return (
        one[0] + part * (other[0] - one[0]),
        one[1] + part * (other[1] - one[1]),
        one[2] + part * (other[2] - one[2]),
        one[3] + part * (other[3] - one[3]),
        one[4] + part * (other[4] - one[4]),
        one[5] + part * (other[5] - one[5]),
    )


def floor(lower: Doubles, x: Places, z: Places, over: float) -> Places:
    """The least height over the lower teeth, m; ``over`` m less where nothing passes over them."""
    beside = (z - lower[BACK]) / lower[DEPTH]  # behind the canines the walls alone hold it: it need not lie over them
    beside = np.minimum(np.maximum((_CROSSES - beside) / _SETS_IN, 0.0), 1.0)
    ground = lower[EDGE] - _FLOOR - _STEEP * np.maximum(z - lower[FRONT], 0.0) - np.maximum(lower[BACK] + 0.01 - z, 0.0)
    return np.maximum(lower[EDGE] - passage.beyond_edge(lower, x, z) - over - UNLIMITED * beside, ground)


def ceiling(upper: Doubles, x: Places, z: Places, over: float) -> Places:
    """The greatest height under the upper teeth and the palate, m."""
    palate = upper[EDGE] + _PALATE + _STEEP * np.maximum(z - upper[FRONT], 0.0)
    beside = np.minimum(np.maximum((_CROSSES - (z - upper[BACK]) / upper[DEPTH]) / _SETS_IN, 0.0), 1.0)
    return np.minimum(upper[EDGE] + passage.beyond_edge(upper, x, z) + over + UNLIMITED * beside, palate)


def room(tables: TongueTables, jaw: Floats, now: Sections, x: float, y: float, z: float) -> tuple[float, float]:
    """How far a place, in the jaw's axes and m, may go down and up along the height of the head, m."""
    walls, over = tables.passage.walls, UNLIMITED * (1.0 - now.limits[OVER])
    at_x, at_y, at_z = posed(jaw, x, y, z)
    bottom, top, inner_lower, outer_lower, inner_upper, outer_upper = lips_at(now, at_x)
    below = bottom - passage.beyond_lip(inner_lower, outer_lower, at_z) - now.limits[HEEDLESS]
    above = top + passage.beyond_lip(inner_upper, outer_upper, at_z) + now.limits[HEEDLESS]
    down = (y - floor(walls[0], x, z, over)) * jaw[1, 1]
    teeth = ceiling(walls[1], at_x, at_z, over)
    return min(down, at_y - min(below, teeth - _PASSES)), min(teeth, above) - at_y


def settle(tables: TongueTables, jaw: Floats, now: Sections) -> None:
    """Move and flatten the sections into what is free where they are."""
    shift, flat = np.zeros(STATIONS), np.ones(STATIONS)
    for k in range(STATIONS):
        x, y, z = now.place[k]
        half, wide = (
            tables.thick[k] * (1.0 + PLUMPER * now.limits[OUT]),
            tables.wide[k] + now.limits[OUT] * tables.wide_out[k],
        )
        down, up = room(tables, jaw, now, x, y, z)
        free = max(down + up, 0.0)
        flat[k] = min(1.0, 0.5 * free / half)
        half = half * flat[k]
        if down < half:
            shift[k] = half - down
        elif up < half:
            shift[k] = up - half
        turn = max(now.curl[k] * wide, 1e-9)
        rolled = wide * (1.0 - np.cos(turn)) / turn
        if rolled > 1e-6:
            now.curl[k] *= min(1.0, max(free - 2.0 * half, 0.0) / rolled)
    for _ in range(3):
        before, thinner = shift[0], flat[0]
        for k in range(1, STATIONS - 1):
            here, height = shift[k], flat[k]
            shift[k] = 0.25 * before + 0.5 * here + 0.25 * shift[k + 1]
            flat[k] = min(height, 0.25 * thinner + 0.5 * height + 0.25 * flat[k + 1])
            before, thinner = here, height
    for k in range(1, STATIONS):
        shift[k] = max(shift[k], _CARRIES * shift[k - 1])
    for k in range(STATIONS):
        now.place[k, 1] += now.limits[FORCE] * shift[k]
        now.flat[k] = 1.0 + now.limits[FORCE] * (flat[k] - 1.0)


def at_least(value: Places) -> Places:
    """0 below, ``value`` above, and over ``_SOFT`` m a parabola that joins both with their slopes."""
    near = np.minimum(np.maximum(value + _SOFT, 0.0), 2.0 * _SOFT)
    return near * near / (4.0 * _SOFT) + np.maximum(value - _SOFT, 0.0)


def held_within(low: Places, high: Places, value: Places) -> Places:
    """``value`` between two limits; halfway where these have changed places."""
    value = low + at_least(value - low)
    value = high - at_least(high - value)
    return np.maximum(value, np.minimum(low, 0.5 * (low + high)))


def held_aside(
    walls: Doubles, limits: Doubles, jaw: Floats, lip: tuple[Places, ...], x: Places, y: Places, z: Places
) -> tuple[Places, Places]:
    """The x and z of places held inside the rows of teeth, and in the opening of the lips."""
    _, _, ahead = posed(jaw, x, y, z)
    behind_lower = walls[0, BACK] + walls[0, DEPTH] + limits[AHEAD]
    far = np.maximum(z - (behind_lower - at_least(behind_lower - z)), 0.0)
    behind_upper = walls[1, BACK] + walls[1, DEPTH] + limits[AHEAD]
    far = np.maximum(far, np.maximum(ahead - (behind_upper - at_least(behind_upper - ahead)), 0.0))
    z = z - limits[FORCE] * far
    ahead = ahead - limits[FORCE] * far
    shifted = jaw[0, 3]
    _, _, inner_lower, _, inner_upper, _ = lip
    inner, spread = np.minimum(inner_lower, inner_upper), _SPREADS * np.maximum(ahead - limits[SPREADS], 0.0)
    lower = np.maximum(passage.half_width(walls[0], z), limits[FAN]) + spread
    upper = np.maximum(passage.half_width(walls[1], ahead), limits[FAN]) + spread
    high = np.minimum(walls[0, MIDDLE] + lower, walls[1, MIDDLE] - shifted + upper)
    low = np.maximum(walls[0, MIDDLE] - lower, walls[1, MIDDLE] - shifted - upper)
    mouth = np.minimum(np.maximum((ahead - inner + _LIPS_FROM) / (_LIPS_FROM - _LIPS_WHOLE), 0.0), 1.0)
    free = UNLIMITED * (1.0 - mouth) + spread
    high = np.minimum(high, limits[LEFT] - shifted - passage.LIP_CLEAR + free)
    low = np.maximum(low, limits[RIGHT] - shifted + passage.LIP_CLEAR - free)
    return x + limits[FORCE] * (held_within(low, high, x) - x), z


def lifted(walls: Doubles, limits: Doubles, x: Places, y: Places, z: Places) -> Places:
    """The heights of places held over the lower teeth."""
    low = floor(walls[0], x, z, UNLIMITED * (1.0 - limits[OVER]))
    return y + limits[FORCE] * (low + at_least(y - low) - y)


def lowered(walls: Doubles, limits: Doubles, lip: tuple[Places, ...], x: Places, y: Places, z: Places) -> Places:
    """How far places, in the head's axes, must go up to lie under the upper teeth and between the lips, m."""
    bottom, top, inner_lower, outer_lower, inner_upper, outer_upper = lip
    low = bottom - passage.beyond_lip(inner_lower, outer_lower, z) - limits[HEEDLESS]
    above = top + passage.beyond_lip(inner_upper, outer_upper, z) + limits[HEEDLESS]
    teeth = ceiling(walls[1], x, z, UNLIMITED * (1.0 - limits[OVER]))
    return limits[FORCE] * (held_within(np.minimum(low, teeth - _PASSES), np.minimum(teeth, above), y) - y)
