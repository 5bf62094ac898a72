"""Mamdani inference with the semantics of scikit-fuzzy, in numpy: the oracle of the kernel, and what explains it.

And is the minimum, a rule clips its set, the clipped sets are joined by the maximum, and the centroid of the result
is taken over the universe refined where a strength cuts a set, linear in between.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles
from agentface.emotion.sets import (
    CONTRACTION_CENTRES,
    CONTRACTION_HALF_WIDTH,
    CONTRACTION_SETS,
    UNIVERSE,
    contraction_membership,
    intensity_membership,
    rescale,
)


def rule_strengths(intensities: Doubles) -> Doubles:
    """How strongly the rules of a mode fire: ``(5,)`` for one intensity, ``(5, 5)`` for two."""
    memberships = [intensity_membership(float(intensity)) for intensity in intensities]
    if len(memberships) == 1:
        return memberships[0]
    first, second = memberships
    return np.minimum(first[:, None], second[None, :])


def cuts_of(strengths: Doubles, consequents: npt.NDArray[np.int8]) -> Doubles:
    """The height ``(5,)`` at which each contraction set is cut, given the set that each rule concludes."""
    cuts = np.zeros(len(CONTRACTION_SETS))
    np.maximum.at(cuts, consequents.ravel(), strengths.ravel())
    return cuts


def centroid(cuts: Doubles) -> float:
    """The centroid of the joined, clipped sets; at least one cut must be above 0."""
    active = np.flatnonzero(cuts)
    if active.size == 1:
        return float(CONTRACTION_CENTRES[active[0]])  # exact: rounding must not move a face at rest
    reach = CONTRACTION_HALF_WIDTH * (1.0 - cuts[active])
    points = np.union1d(
        UNIVERSE, np.concatenate([CONTRACTION_CENTRES[active] - reach, CONTRACTION_CENTRES[active] + reach])
    )
    heights = np.minimum(cuts[:, None], contraction_membership(points)).max(axis=0)
    left, right, low, high = points[:-1], points[1:], heights[:-1], heights[1:]
    width = right - left
    area = width * (low + high) / 2
    moment = width * (low * (2 * left + right) + high * (left + 2 * right)) / 6
    return float(moment.sum() / area.sum())


def contraction(cuts: Doubles) -> float:
    """The contraction in 0..1 that the cuts call for."""
    return rescale(centroid(cuts))
