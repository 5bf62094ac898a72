"""Which of the skin is tissue, which is carried by it, and which stays where it is."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from agentface.conventions import SIDES, Doubles, Indices
from agentface.head.model import HeadModel
from agentface.head.regions import REGIONS, REST
from agentface.mesh.graph import Mask, adjacency, harmonic_weights, laplacian, rim_of

_INSIDE, _WET, _EAR = 0.02, 0.5, 0.05
_SEAM_RINGS = 4
"""Rings of the lips, from the seam, that the lips' own surface has."""
_ROUNDS = 2
_IN_THE_MOUTH = 0.03
"""What an edge there counts beside one of the skin."""
_LEAST_WEIGHT = 1e-4


class Members(NamedTuple):
    """Masks ``(V,)`` over the skin; a vertex of none of them is in the lattice and moves.

    Attributes:
        fixed: in the lattice, and stays: neck, scalp, ears.
        carried: not in the lattice; follows the tissue round it (:class:`Carried`).
        still: neither; stays: the lids' margins, the depth of the mouth.
    """

    fixed: Mask
    carried: Mask
    still: Mask

    @property
    def absent(self) -> Mask:
        """Not in the lattice."""
        return self.carried | self.still


def members(model: HeadModel, edges: Indices, carried_mm: dict[str, float]) -> Members:
    """What moves how: the lids, the inside of the mouth, the lips' seam and sharp corners are no tissue.

    As nodes of the lattice they fold, and folds are where one load has several equilibria. ``carried_mm`` gives the
    radius round paired landmarks.
    """
    inside, wet, ear = (model.material[:, 1:] > [_INSIDE, _WET, _EAR]).T
    rest = model.regions.region_of == REGIONS.index(REST)
    fixed = (rest | ear) & ~inside
    carried = (inside & ~rest) | model.regions.mask(["lower_eyelid", "upper_eyelid"])
    still = wet | (inside & rest)
    fixed, carried, still = (mask | mask[model.mirror] for mask in (fixed, carried, still))
    for ring in model.lips.rings[:_SEAM_RINGS]:
        carried[ring.upper + ring.lower] = True
    for name, radius in carried_mm.items():
        for side in SIDES:
            away = np.linalg.norm(model.vertices - model.landmarks[f"{name}_{side}"], axis=1)
            carried |= 1e3 * away < radius
    beside = adjacency(edges, len(carried))
    around = np.maximum(np.asarray(beside.sum(1)).ravel(), 1.0)
    for _ in range(_ROUNDS):  # a column that juts into a hole flaps
        carried |= ~fixed & (beside @ (carried | still) > 0.5 * around)
    carried |= carried[model.mirror]
    fixed[rim_of(model.triangles)] = True
    still &= ~fixed
    carried &= ~(still | fixed)
    return Members(fixed, carried, still)


class Carried(NamedTuple):
    """The vertices that follow: ``u[vertices] = weights u[carriers]``, as rows of a sparse matrix.

    Attributes:
        vertices: ``(F,)``.
        first: ``(F + 1,)`` where each one's terms begin.
        carriers: ``(N,)`` the vertices of the lattice.
        weights: ``(N,)`` float32.
    """

    vertices: Indices
    first: Indices
    carriers: Indices
    weights: npt.NDArray[np.float32]

    def apply(self, moved: Any) -> None:
        """Moves the carried rows of ``moved (V, 3)`` in place."""
        terms = self.weights[:, None] * moved[self.carriers]
        ends = np.concatenate([np.zeros((1, 3)), np.cumsum(terms, axis=0, dtype=np.float64)])
        moved[self.vertices] = ends[self.first[1:]] - ends[self.first[:-1]]

    def hand_on(self, forces: Doubles) -> None:
        """Gives what pulls on the carried rows of ``forces (V, 3)`` to those that carry them, in place."""
        pulled = np.repeat(self.vertices, np.diff(self.first))
        for axis in range(3):
            handed = self.weights * forces[pulled, axis]
            forces[:, axis] += np.bincount(self.carriers, handed, len(forces))
        forces[self.vertices] = 0.0


def carried_by(model: HeadModel, edges: Indices, where: Members) -> Carried:
    """The carried vertices, harmonic between the tissue's and those that stay; lips go with the skin, not the mouth."""
    inside = (model.material[:, 1] > _INSIDE)[edges].any(axis=1)
    matrix = laplacian(edges, len(model.vertices), np.where(inside, _IN_THE_MOUTH, 1.0))
    carriers, weights = harmonic_weights(matrix, where.carried)
    moving = ~(where.fixed | where.still)[carriers]
    carriers, weights = carriers[moving], np.asarray(weights[:, moving])
    rows, columns = np.nonzero(np.abs(weights) > _LEAST_WEIGHT)
    first = np.searchsorted(rows, np.arange(len(weights) + 1))
    return Carried(
        vertices=np.flatnonzero(where.carried).astype(np.int32),
        first=first.astype(np.int32),
        carriers=carriers[columns].astype(np.int32),
        weights=weights[rows, columns].astype(np.float32),
    )
