"""What a mouth does, in millimetres: what phonetics says of speech sounds, read off the face."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.deform import tables
from agentface.deform.geometry import FaceGeometry
from agentface.deform.mouth import lip_parting
from agentface.deform.mouth.lip_grid import SEAM_RING, VERMILION_RING, lip_grid
from agentface.head.model import HeadModel
from agentface.kernel import can_compile

_CLEAR_WIDTH = 0.6  # of the mouth's, over which its gap is read
_BITE_WIDTH = 0.013  # m from the middle
_MIDDLE_TEETH = 0.006  # m from the middle, where the incisors are
_FINE = 6  # parts of an edge of a tooth
_MM = 1e3


class MouthMeasures(NamedTuple):
    """Of one face, in mm.

    Attributes:
        gap: the largest clear height between the lips over the middle 60 % of the mouth.
        width: from corner to corner, more than at rest.
        protrusion: how far the lips have come forward, in the mean of both, as if the jaw had not turned.
        jaw: how far the lower incisors have come down.
        teeth: how much of the upper incisors shows below the upper lip; negative where it covers their edges.
        bite: from the lower lip's surface to the upper teeth, no more than 13 mm from the middle; NaN if not asked for.
    """

    gap: float
    width: float
    protrusion: float
    jaw: float
    teeth: float
    bite: float


class MouthRuler:
    """Measures the mouth of one face, whichever deformer moved it."""

    def __init__(self, model: HeadModel) -> None:
        self._model, self._contact = model, tables.of(model).skin.contact
        grid = lip_grid(model)
        middle, rings = np.arange(-1, 2), slice(SEAM_RING - 1, VERMILION_RING + 1)
        self._upper, self._lower = (grid.vertices[rings][:, c + middle].ravel() for c in (grid.upper, grid.lower))
        self._corners = grid.vertices[SEAM_RING, [0, 2 * grid.upper]]
        self._seam = self._contact.grid[SEAM_RING, self._contact.upper]
        self._inner = grid.vertices[1 : VERMILION_RING - 1][:, self._contact.lower]
        self._edge = _middle(model, "teeth_upper")[:, 1].min()
        below = _middle(model, "teeth_lower")
        self._incisor = below[below[:, 1].argmax()]
        self._pivot = np.array(model.jaw.pivot, np.float64)
        self._crowns = _Crowns(model)
        self._gaps: Callable[..., Floats] = lip_parting.gaps
        if can_compile():
            from agentface.deform.mouth import lip_parting_compiled

            self._gaps = lip_parting_compiled.gaps
        self._rest = np.zeros(3)
        self._rest = self._width_and_fronts(FaceGeometry.at_rest(model))

    def measure(self, geometry: FaceGeometry, *, bite: bool = False) -> MouthMeasures:
        """The mouth of one face, not of a batch; ``bite`` takes several times as long as all else."""
        points = geometry.vertices
        width, upper, lower = self._width_and_fronts(geometry) - self._rest
        dropped = self._incisor[1] - (geometry.jaw[1, :3] @ self._incisor + geometry.jaw[1, 3])
        return MouthMeasures(
            gap=_MM * self._gap(points),
            width=_MM * float(width),
            protrusion=_MM * float(0.5 * (upper + lower)),
            jaw=_MM * float(dropped),
            teeth=_MM * float(points[self._upper, 1].min() - self._edge),
            bite=_MM * self._crowns.distance(points[self._inner]) if bite else math.nan,
        )

    def _gap(self, points: Floats) -> float:
        table = self._contact
        clear = self._gaps(table, table.upper, table.lower, np.float32(1.0), points)
        x = points[self._seam, 0]
        half = 0.5 * (x[0] - x[-1])
        return float(clear[: len(x)][np.abs(x - 0.5 * (x[0] + x[-1])) < _CLEAR_WIDTH * half].max())

    def _width_and_fronts(self, geometry: FaceGeometry) -> Doubles:
        """``(3,)`` m: the mouth's width, and how far forward each lip reaches, the lower one as with the jaw shut."""
        points = geometry.vertices
        left, right = points[self._corners, 0]
        below = points[self._lower].astype(np.float64) - self._pivot
        return np.array([left - right, points[self._upper, 2].max(), (below @ geometry.jaw[:3, 2]).max()])


class _Crowns:
    """The surface of the upper front teeth, as points a fraction of a millimetre apart."""

    def __init__(self, model: HeadModel) -> None:
        self._part = model.parts["teeth_upper"]
        self._tree: object | None = None

    def distance(self, lip: Floats) -> float:
        """Metres from the nearest place of ``lip (R, K, 3)``, a grid with twice its columns and rings."""
        from scipy.spatial import KDTree

        if self._tree is None:
            self._tree = KDTree(self._points())
        assert isinstance(self._tree, KDTree)  # noqa: S101 - for the type checker
        coarse = lip[2::2, ::2].astype(np.float64)
        found = np.inf
        for grid in (coarse, _halved(_halved(lip.astype(np.float64)).swapaxes(0, 1))):  # the first bounds the second
            near = grid[np.abs(grid[..., 0]) < _BITE_WIDTH]
            if len(near):
                found = min(found, float(self._tree.query(near, distance_upper_bound=found)[0].min()))
        return found

    def _points(self) -> Doubles:
        places = self._part.attributes["POSITION"].astype(np.float64)
        triangles = self._part.triangles
        crown = (self._part.attributes["_MATERIAL"][triangles, 0] > 0).any(axis=1)
        front = (np.abs(places[triangles][..., 0]) < _BITE_WIDTH).all(axis=1)
        a, b, c = np.moveaxis(places[triangles[crown & front]], 1, 0)
        shares = [(i / _FINE, j / _FINE) for i in range(_FINE + 1) for j in range(_FINE + 1 - i)]
        return np.concatenate([a + u * (b - a) + v * (c - a) for u, v in shares])


def _middle(model: HeadModel, part: str) -> Doubles:
    """``(N, 3)`` m, the crowns of the incisors in the middle of a row of teeth."""
    mesh = model.parts[part]
    places = mesh.attributes["POSITION"].astype(np.float64)
    return places[(mesh.attributes["_MATERIAL"][:, 0] > 0) & (np.abs(places[:, 0]) < _MIDDLE_TEETH)]


def _halved(grid: Doubles) -> Doubles:
    """``grid (R, ...)`` with a row between each two."""
    fine = np.empty((2 * len(grid) - 1, *grid.shape[1:]))
    fine[::2] = grid
    fine[1::2] = 0.5 * (grid[1:] + grid[:-1])
    return fine
