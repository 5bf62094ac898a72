"""How far each vertex of the skin follows the jaw: the artists' jawOpen, but for the lips, which open to an oval."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import Field

from agentface.config import Table
from agentface.conventions import Doubles, Indices
from agentface.head.build.head_topology import HeadTopology
from agentface.mesh.evening import evened
from agentface.mesh.smoothstep import falloff

_FINEST = 1e-4
_INNER_RINGS = 3
_EVENINGS = 4
_BONE = 0.18, 0.4
"""Eye separations from the tip of the chin within which skin lies on the bone, and beyond which it does not."""
_Share = Annotated[float, Field(ge=0, le=1)]


class LipShare(Table):
    """The part of the jaw's turn that the middle of a lip makes, and its outline's shape: 1 straight, 2 a parabola."""

    middle: _Share
    roundness: Annotated[float, Field(ge=1, le=3)]


class JawShares(Table):
    """The section ``jaw`` of ``anatomy.yaml``: parts of the jaw's turn.

    Over ``fade`` eye separations round the lips the skin's shares go over into the artists'.
    """

    upper_lip: LipShare
    lower_lip: LipShare
    corner: _Share
    fade: Annotated[float, Field(gt=0, le=2)]


def jaw_shares(topology: HeadTopology, points: Doubles, guide: Doubles, shares: JawShares, unit: float) -> Doubles:
    """``(V,)`` 0..1, the part of the jaw's turn that each vertex makes (Bui et al., section 3.4).

    On the lips, from the vermilion's edge to the mucosa, what ``shares`` says; elsewhere ``guide (V,)`` plus a
    correction that starts at the lips with theirs and dies out over ``shares.fade`` times ``unit``, smooth in value
    and slope: it solves (L M^-1 L + fade^-4 M) c = 0 with the mesh's Laplacian L and the vertices' areas M.
    """
    fixed, wanted = _on_the_lips(topology, points, shares)
    correction = np.zeros(len(points))
    correction[fixed] = wanted[fixed] - guide[fixed]
    correction = _spread(points, topology.skin.triangles, fixed, correction, shares.fade * unit)
    found = np.clip(guide + correction, 0.0, 1.0)
    from_chin = np.linalg.norm(points - points[topology.landmarks["pogonion"]["vertices"]].mean(0), axis=1)
    found += np.where(fixed, 0.0, falloff(from_chin / unit, *_BONE)) * (1.0 - found)
    found = evened(found, topology.skin.triangles, _EVENINGS, _under_the_chin(topology, points, unit))
    # coarser than what the solver's rounding can change, so that every machine writes the same
    return np.round(0.5 * (found + found[topology.skin.mirror]) / _FINEST) * _FINEST


def _under_the_chin(topology: HeadTopology, points: Doubles, unit: float) -> np.typing.NDArray[np.bool_]:
    """``(V,)`` true where an opening jaw presses the skin together, between the chin and the throat."""
    below = points - points[topology.landmarks["menton"]["vertices"]].mean(0)
    return np.asarray((below[:, 1] < 0.1 * unit) & (below[:, 2] < -0.3 * unit))


def _on_the_lips(
    topology: HeadTopology, points: Doubles, shares: JawShares
) -> tuple[np.typing.NDArray[np.bool_], Doubles]:
    """Which vertices the lips' shares hold for, and the shares ``(V,)``.

    A lip's middle and the corner have theirs; between them they follow a parabola over the way along the lip, so that
    the opening is an oval; its round ends are the lips' own (``deform.lip_surface.moved_with``).
    """
    wanted, fixed = np.zeros(len(points)), np.zeros(len(points), np.bool_)
    rings = [*topology.loops.lips[:-1], *topology.loops.mouth[:_INNER_RINGS]]
    for ring in rings:
        for vertices, lip in zip(topology.halves(ring), (shares.upper_lip, shares.lower_lip), strict=True):
            steps = np.linalg.norm(np.diff(points[vertices], axis=0), axis=1)
            way = np.concatenate([[0.0], np.cumsum(steps)])
            t = np.abs(2.0 * way / way[-1] - 1.0)
            round_off = 1.0 - t**lip.roundness
            wanted[vertices] = shares.corner + (lip.middle - shares.corner) * round_off
            fixed[vertices] = True
    return fixed, wanted


def _spread(
    points: Doubles, triangles: Indices, fixed: np.typing.NDArray[np.bool_], values: Doubles, fade: float
) -> Doubles:
    from scipy import sparse
    from scipy.sparse.linalg import spsolve

    count = len(points)
    rows, columns, weights = [], [], []
    mass = np.zeros(count)
    for i in range(3):
        a, b, c = (triangles[:, (i + k) % 3] for k in range(3))
        u, v = points[b] - points[a], points[c] - points[a]
        double_area = np.linalg.norm(np.cross(u, v), axis=1)
        cotangent = np.clip(0.5 * (u * v).sum(1) / double_area, 0.0, 5.0)
        rows += [b, c]
        columns += [c, b]
        weights += [cotangent, cotangent]
        np.add.at(mass, a, double_area / 6.0)
    adjacent = sparse.coo_matrix(
        (np.concatenate(weights), (np.concatenate(rows), np.concatenate(columns))), shape=(count, count)
    ).tocsr()
    laplacian = sparse.diags(np.asarray(adjacent.sum(1)).ravel()) - adjacent
    system = (laplacian @ sparse.diags(1.0 / mass) @ laplacian + sparse.diags(mass / fade**4)).tocsr()
    free = np.flatnonzero(~fixed)
    result = values.copy()
    right = -(system[free][:, np.flatnonzero(fixed)] @ values[fixed])
    result[free] = spsolve(system[free][:, free].tocsc(), right)
    return result
