"""Expression mode selection: how much of each single expression and of each blend of two a state shows.

Bui, Heylen, Poel and Nijholt (2001) select one mode, a single expression or a blend of the two strongest emotions.
A switch would make the face jump, so the choice is fuzzy here; formula and gap are ours.
An emotion e takes part, beside the strongest one, to the degree

    r(e) = max(0, 1 - (top - x(e)) / min(2 gap, top)),    top = max x

which is 1 for the strongest, 1/2 where it trails by ``gap``, and 0 for an absent emotion.
Each alpha-cut {e: r(e) >= alpha} is a plain set of emotions. One emotion calls for its single expression, two for
their blend, more for the mean of the blends of every two of them; the weight of a mode is the share of
alpha in 0..1 that calls for it. The weights sum to one, are continuous, and do not depend on how ties are ranked.
"""

from __future__ import annotations

from itertools import combinations

from agentface.conventions import Doubles
from agentface.emotion.state import EMOTIONS

MODES: tuple[tuple[str, ...], ...] = (*((emotion,) for emotion in EMOTIONS), *combinations(EMOTIONS, 2))
"""The six single expressions, then the fifteen blends, each by its emotions in the order of ``EMOTIONS``."""


def participation(intensities: Doubles, gap: float) -> Doubles:
    """The degree r in 0..1 to which each of the six emotions takes part; all zero for a neutral state."""
    top = intensities.max()
    if top <= 0.0:
        return intensities * 0.0
    degrees: Doubles = (1.0 - (top - intensities) / min(2.0 * gap, top)).clip(0.0, 1.0)
    return degrees


def mode_weights(intensities: Doubles, gap: float) -> dict[tuple[str, ...], float]:
    """The weight of each mode that takes part; they sum to one, or there are none for a neutral state.

    Args:
        intensities: (6,) float64 in 0..1, in the order of ``EMOTIONS``.
        gap: by how much an emotion trails the strongest when it takes part by one half, above 0.
    """
    degrees = participation(intensities, gap)
    weights = dict.fromkeys(MODES, 0.0)
    upper = 1.0
    for lower in sorted({*degrees.tolist(), 0.0} - {1.0}, reverse=True):
        cut = tuple(emotion for emotion, degree in zip(EMOTIONS, degrees, strict=True) if degree > lower)
        called: list[tuple[str, ...]] = [*combinations(cut, 2)] or [cut]
        for mode in called if cut else ():
            weights[mode] += (upper - lower) / len(called)
        upper = lower
    return {mode: weight for mode, weight in weights.items() if weight > 0.0}
