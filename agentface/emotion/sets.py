"""The fuzzy sets: five of intensity, which overlap to one everywhere, and five of contraction.

A contraction set is a symmetric triangle that lies whole inside 0..1, so clipping it does not move its
centroid, and a rule that fires weakly alone says the same as one that fires fully. The triangles are twice
as wide as they are apart: the centroid then follows the rules with slopes near one. The price is that
centroids lie between the centres of VerySmall and VeryBig; :func:`rescale` stretches that range to 0..1.
"""

from __future__ import annotations

from typing import Literal, NamedTuple, TypeAlias, get_args

import numpy as np

from agentface.conventions import Doubles

IntensitySet: TypeAlias = Literal["VeryLow", "Low", "Medium", "High", "VeryHigh"]
ContractionSet: TypeAlias = Literal["VerySmall", "Small", "Medium", "Big", "VeryBig"]
INTENSITY_SETS: tuple[str, ...] = get_args(IntensitySet)
CONTRACTION_SETS: tuple[str, ...] = get_args(ContractionSet)

INTENSITY_CENTRES: Doubles = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
INTENSITY_HALF_WIDTH = 0.25
CONTRACTION_CENTRES: Doubles = np.array([0.25, 0.375, 0.5, 0.625, 0.75])
CONTRACTION_HALF_WIDTH = 0.25
UNIVERSE: Doubles = np.linspace(0.0, 1.0, 33)
"""Where aggregated sets are sampled, beside the points where a rule's strength cuts its set."""


class Sets(NamedTuple):
    """All fuzzy sets as the kernel takes them; a kernel that read them as globals would be cached with old ones."""

    intensity_centres: Doubles
    intensity_half_width: float
    contraction_centres: Doubles
    contraction_half_width: float
    universe: Doubles


SETS = Sets(INTENSITY_CENTRES, INTENSITY_HALF_WIDTH, CONTRACTION_CENTRES, CONTRACTION_HALF_WIDTH, UNIVERSE)


def intensity_membership(intensity: float) -> Doubles:
    """How much an intensity in 0..1 belongs to each intensity set: five values in 0..1 that sum to one."""
    return np.maximum(0.0, 1.0 - np.abs(intensity - INTENSITY_CENTRES) / INTENSITY_HALF_WIDTH)


def contraction_membership(points: Doubles) -> Doubles:
    """How much each of ``(P,)`` points belongs to each contraction set, ``(5, P)``."""
    return np.maximum(0.0, 1.0 - np.abs(points - CONTRACTION_CENTRES[:, None]) / CONTRACTION_HALF_WIDTH)


def rescale(centroid: float) -> float:
    """A contraction from a centroid, linearly: the centre of VerySmall gives 0, that of VeryBig 1."""
    low, high = float(CONTRACTION_CENTRES[0]), float(CONTRACTION_CENTRES[-1])
    return min(1.0, max(0.0, (centroid - low) / (high - low)))
