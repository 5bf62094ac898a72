"""How well a displacement field of muscles agrees with the artists' shape of the same action unit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import SIDES, Floats
from agentface.deform.protocol import DEFAULT_DEFORMER, Deformer, make_deformer
from agentface.facs.action_units import ActionUnit
from agentface.head.arkit import sided
from agentface.head.model import HeadModel
from agentface.head.regions import REGIONS
from agentface.parameters import FacePose

PART_OF_PEAK = 0.25
AS_FAR = 0.99
"""Of the peak: what moves as far as that shares it; at a border the mesh would decide."""


@dataclass(frozen=True, slots=True)
class Agreement:
    """Muscles against artists, over the vertices where the artists' shape moves more than a quarter of its maximum.

    Attributes:
        cosine: mean cosine between the two displacements; a vertex that the muscles leave alone counts 0.
        covered: part of these vertices that the muscles move at least a tenth of the artists' maximum.
        peak_ratio: the muscles' largest displacement over the artists'.
        peak_mm: the artists' largest displacement.
        fitted: whether the calibration fits these muscles to this shape.
        region, artists_region: the paper's region, without side, where each is largest; where the muscles move several
            regions as far, to a percent of their peak, the artists' among them counts.
    """

    cosine: float
    covered: float
    peak_ratio: float
    peak_mm: float
    region: str
    artists_region: str
    fitted: bool = True


def agreement(model: HeadModel, muscles: Floats, artists: Floats, *, fitted: bool = True) -> Agreement:
    """Compare two displacement fields ``(V, 3)`` in metres."""
    moved, wanted = np.linalg.norm(muscles, axis=1), np.linalg.norm(artists, axis=1)
    peak = float(wanted.max())
    chosen = wanted > PART_OF_PEAK * peak
    dots = (muscles[chosen] * artists[chosen]).sum(1)
    cosines = dots / np.maximum(moved[chosen] * wanted[chosen], 1e-12)
    artists_region = _region(model, int(wanted.argmax()))
    farthest = {_region(model, int(vertex)) for vertex in np.flatnonzero(moved >= AS_FAR * moved.max())}
    return Agreement(
        cosine=float(np.where(moved[chosen] > 1e-7, cosines, 0.0).mean()),
        covered=float((moved[chosen] > 0.1 * peak).mean()),
        peak_ratio=float(moved.max()) / peak,
        peak_mm=1e3 * peak,
        region=artists_region if artists_region in farthest else _region(model, int(moved.argmax())),
        artists_region=artists_region,
        fitted=fitted,
    )


def measure(model: HeadModel, units: dict[int, ActionUnit], deformer: Deformer | None = None) -> dict[int, Agreement]:
    """The agreement of the action units that artists' shapes make, with a deformer of a face, or the geometric one."""
    deformer = make_deformer(DEFAULT_DEFORMER, model) if deformer is None else deformer
    rest = model.vertices
    result = {}
    for number, unit in units.items():
        if not unit.shapes:
            continue
        moved = deformer.at(unit.pose).vertices - rest
        result[number] = agreement(model, moved, unit.shape(model), fitted=unit.fitted)
    return result


def measure_shapes(model: HeadModel, deformer: Deformer | None = None) -> dict[str, Agreement]:
    """The agreement of what ``morphs.yaml`` makes of each artists' shape with that shape, both sides and lips together.

    Its rest is the shape itself; what is measured is what lids, jaw and contact leave of it.
    """
    deformer = make_deformer(DEFAULT_DEFORMER, model) if deformer is None else deformer
    made: dict[str, dict[str, float]] = {}
    for name, row in model.morphs_file.morphs.items():
        for shape in row.high.shapes:
            made.setdefault(shape, {})[name] = 1.0
    result = {}
    for shape, parameters in made.items():
        names = [whole for whole in (shape, *(sided(shape, side) for side in SIDES)) if whole in model.shapes]
        if names:
            artists = sum((model.shapes[name].dense(len(model.vertices)) for name in names), 0 * model.vertices)
            moved = deformer.at(FacePose().replace(parameters)).vertices - model.vertices
            result[shape] = agreement(model, moved, artists, fitted=False)
    return result


def _region(model: HeadModel, vertex: int) -> str:
    return REGIONS[model.regions.region_of[vertex]].removesuffix("_l").removesuffix("_r")
