"""The bone under a face as a picture shows it: its skull with openings cut for eyes, nose and mouth, and its teeth.

The skull of the tissue lies under every vertex of the skin, also where a skull has holes. Only the picture has them:
eye sockets, the opening of the nose, a mouth that bares the teeth, the cheek where the tissue is deepest. Neck and
ears are left away.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import SIDES, Doubles, Indices
from agentface.head.landmarks import Landmarks
from agentface.head.model import HeadModel
from agentface.mesh.graph import SparseMatrix, adjacency, edges_of, grown, harmonic, laplacian, smoothed
from agentface.mesh.normals import vertex_normals
from agentface.mesh.refine import refine
from agentface.mesh.smoothstep import smoothstep
from agentface.studies.figures.solids import Scene
from agentface.tissue.lattice import Lattice

BONE, JAW = np.array([236.0, 228.0, 208.0]), np.array([214.0, 186.0, 140.0])
_DEEP, _TOOTH = np.array([96.0, 78.0, 64.0]), np.array([248.0, 246.0, 238.0])
_WHITE, _IRIS, _PUPIL = np.array([244.0, 242.0, 238.0]), np.array([96.0, 76.0, 54.0]), np.array([24.0, 20.0, 18.0])
_JAWS = ("teeth_upper", "teeth_lower")


class Opening(NamedTuple):
    """A hole in the bone, seen from the front.

    Attributes:
        centre: ``(2,)`` m.
        wide, high: m, half of what it measures.
        power: 2 for an ellipse; more for one with corners.
        narrow: what part of its width is missing at the top, and is more at the bottom.
        tilt: how much its outer end is higher, for 1 sideways.
        deep: m.
        behind: m, how far under the bone its floor begins.
    """

    centre: Doubles
    wide: float
    high: float
    power: float
    narrow: float
    tilt: float
    deep: float
    behind: float = 0.0015

    def inside(self, points: Doubles) -> Doubles:
        """``(N,)``: 1 in the middle, 0 on the curve, negative outside; before the ears only."""
        x, y = (points[:, :2] - self.centre).T
        y = y - self.tilt * x
        width = self.wide * (1.0 - self.narrow * np.clip(y / self.high, -1.0, 1.0))
        part = (np.abs(x / width) ** self.power + np.abs(y / self.high) ** self.power) ** (1.0 / self.power)
        return np.where(points[:, 2] > 0.0, 1.0 - part, -1.0)

    def curve(self, count: int) -> Doubles:
        """``(count, 2)`` m: the curve, counter-clockwise."""
        angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
        ways = np.stack([np.cos(angle), np.sin(angle)])
        y = self.high * np.sign(ways[1]) * np.abs(ways[1]) ** (2.0 / self.power)
        x = np.sign(ways[0]) * np.abs(ways[0]) ** (2.0 / self.power)
        x *= self.wide * (1.0 - self.narrow * y / self.high)
        return self.centre + np.stack([x, y + self.tilt * x], axis=1)


class Bones(NamedTuple):
    """The skull of a picture, in m.

    Attributes:
        points, triangles: of the bone, twice as fine as the skin's mesh.
        colours: ``(N, 3)``, the jaw's another.
        kept: ``(N, C)`` one of them negative where bone is cut away.
        openings: the holes that have a floor.
    """

    points: Doubles
    triangles: Indices
    colours: Doubles
    kept: Doubles
    openings: list[Opening]


def bones_of(model: HeadModel, lattice: Lattice) -> Bones:
    """The bone under a face, with its openings."""
    unit, marks = float(model.landmarks.eye_separation), model.landmarks
    openings = [*_sockets(model, unit), _nose(model, unit), _mouth(model, unit)]
    points = _evened_out(model, 1e-3 * lattice.skull.points, openings)
    fine = refine(model.triangles, len(points))
    normals = vertex_normals(points, model.triangles)
    finer = fine.positions(points.astype(np.float32), normals.astype(np.float32)).astype(np.float64)
    bag = fine.mean(model.material[:, 1])
    jaw = smoothstep(0.42, 0.52, fine.mean(model.jaw_weights.astype(np.float64)))[:, None]
    below = finer[:, 1] - np.interp(finer[:, 2], *_neckline(marks, unit))
    kept = np.stack([*(-opening.inside(finer) for opening in openings), below, 0.05 - bag], axis=1)
    return Bones(finer, fine.triangles, BONE + jaw * (JAW - BONE), kept, openings)


def draw_bones(scene: Scene, model: HeadModel, bones: Bones, *, eyes: bool = False) -> None:
    """Put bone, the floors of its openings and the teeth into a scene; the eyeballs too where ``eyes`` says so."""
    scene.surface(bones.points, bones.triangles, bones.colours, bones.kept)
    for opening in bones.openings:
        scene.surface(*_floor(bones, opening))
    for name, gum in zip(_JAWS, (BONE, JAW), strict=True):
        points, tooth = _teeth(model, name)
        bared = np.where(tooth, 1.0, bones.openings[-1].inside(points) + 0.15)[:, None]
        scene.surface(points, model.parts[name].triangles, np.where(tooth[:, None], _TOOTH, gum), bared)
    for side in SIDES if eyes else ():
        scene.surface(*_eyeball(model, side))


def _eyeball(model: HeadModel, side: str) -> tuple[Doubles, Indices, Doubles]:
    """Points, triangles and colours: white, iris, pupil."""
    eye, (x, y, _) = model.parts[f"eye_{side}"], model.eye_centre(side)
    fine = refine(eye.triangles, len(eye.attributes["POSITION"]))
    vertices = eye.attributes["POSITION"].astype(np.float32)
    points = fine.positions(vertices, vertex_normals(vertices, eye.triangles).astype(np.float32)).astype(np.float64)
    part = np.hypot(points[:, 0] - x, points[:, 1] - y) / model.eyes.radius
    colours = np.select([(part < 0.2)[:, None], (part < 0.48)[:, None]], [_PUPIL, _IRIS], _WHITE)
    return points, fine.triangles, np.where((points[:, 2] > model.eye_centre(side)[2])[:, None], colours, _WHITE)


def _sockets(model: HeadModel, unit: float) -> list[Opening]:
    place = np.array([1.0, 1.0])
    left = model.landmarks["pupil_l"][:2] + unit * np.array([0.03, -0.02])
    return [
        Opening(left * place * [sign, 1.0], 0.35 * unit, 0.30 * unit, 2.6, 0.0, -0.12 * sign, 0.55 * unit)
        for sign in (1.0, -1.0)
    ]


def _nose(model: HeadModel, unit: float) -> Opening:
    top, low = model.landmarks["nasion"][1], model.landmarks["subnasale"][1]
    high = 0.5 * (0.62 * (top - low))
    return Opening(np.array([0.0, low + high + 0.05 * unit]), 0.17 * unit, high, 2.0, 0.45, 0.0, 0.4 * unit)


def _mouth(model: HeadModel, unit: float) -> Opening:
    """As wide and as high as the crowns of the teeth."""
    crowns = np.concatenate([_teeth(model, name)[0][_teeth(model, name)[1]] for name in _JAWS])
    low, high = crowns.min(axis=0), crowns.max(axis=0)
    centre = 0.5 * (low + high)[:2] * [0.0, 1.0]
    return Opening(centre, 1.02 * high[0], 0.5 * (high - low)[1] - 0.03 * unit, 3.0, 0.0, 0.0, 0.75 * unit, 0.2 * unit)


def _teeth(model: HeadModel, name: str) -> tuple[Doubles, np.typing.NDArray[np.bool_]]:
    """Points ``(N, 3)`` m of one jaw's teeth and gums, and which of them are teeth."""
    attributes = model.parts[name].attributes
    return attributes["POSITION"].astype(np.float64), attributes["_MATERIAL"][:, 0] > 127


def _neckline(marks: Landmarks, unit: float) -> tuple[Doubles, Doubles]:
    """What is below it is no skull: depth along z and height of a line from the occiput to the chin."""
    gonion, menton = marks["gonion_l"], marks["menton"]
    steps = [
        (gonion[2] - 2.2 * unit, gonion[1] + 0.9 * unit),
        (gonion[2] - 0.6 * unit, gonion[1] + 0.7 * unit),
        (gonion[2] - 0.2 * unit, gonion[1] + 0.5 * unit),
        (gonion[2], gonion[1] - 0.05 * unit),
        (menton[2], menton[1] - 0.05 * unit),
    ]
    z, y = np.array(steps).T
    return z, y


def _evened_out(model: HeadModel, points: Doubles, openings: list[Opening]) -> Doubles:
    """The bone without the marks of ears, lids, nose and lips: smooth there between what is round them."""
    inside, wet, ear = (model.material[:, 1:] > [0.02, 0.5, 0.02]).T
    *holes, mouth = openings
    fine = inside | wet | np.any([opening.inside(points) > -0.3 for opening in holes], axis=0)
    edges = edges_of(model.triangles)
    beside = adjacency(edges, len(points))
    marked = fine | ear
    marked |= beside @ marked.astype(np.float64) > 0.0
    known = np.flatnonzero(~marked).astype(np.int32)
    matrix = laplacian(edges, len(points))
    points = np.stack([harmonic(matrix, known, column[known]) for column in points.T], axis=1)
    rough = smoothed(beside, grown(fine, beside, 4).astype(np.float64), 4)
    points += rough[:, None] * (smoothed(beside, points, 12) - points)
    return _to_the_gums(model, points, mouth, beside)


def _to_the_gums(model: HeadModel, points: Doubles, mouth: Opening, beside: SparseMatrix) -> Doubles:
    """Round the mouth the bone is where the teeth stand in it."""
    from scipy.spatial import cKDTree

    gums = np.concatenate([points[~tooth] for points, tooth in (_teeth(model, name) for name in _JAWS)])
    away, near = cKDTree(gums[:, :2]).query(points[:, :2], 12)
    z = gums[near, 2].max(axis=1) + 0.001
    share = smoothstep(-0.5, -0.05, mouth.inside(points)) * (1.0 - smoothstep(0.003, 0.008, away[:, 0]))
    result = points.copy()
    result[:, 2] += share * (z - points[:, 2])
    near_mouth = smoothstep(-1.3, -0.6, mouth.inside(points))
    return np.asarray(result + near_mouth[:, None] * (smoothed(beside, result, 5) - result))


def _floor(bones: Bones, opening: Opening) -> tuple[Doubles, Indices, Doubles]:
    """The bowl that closes an opening: points, triangles and colours, from its rim inwards."""
    from scipy.spatial import cKDTree

    count, rings = 72, 10
    rim = opening.curve(count)
    front = bones.points[(bones.kept > -0.05).all(axis=1)]
    front = front[front[:, 2] > 0.0]
    away, near = cKDTree(front[:, :2]).query(rim, 6)
    weights = 1.0 / (away + 1e-4) ** 2
    height = (weights * front[near, 2]).sum(axis=1) / weights.sum(axis=1)
    height = 0.25 * np.roll(height, 1) + 0.5 * height + 0.25 * np.roll(height, -1)
    part = np.linspace(0.0, 1.0, rings)
    size = np.concatenate([[1.03], 1.0 - 0.9 * part[1:] ** 1.6])
    middle = np.append(opening.centre, height.mean())
    points, colours = [], []
    for step, wide in zip(part, size, strict=True):
        xy = opening.centre + wide * (rim - opening.centre)
        z = (1.0 - step) * height + step * (middle[2] - opening.deep) - opening.behind * (1.0 - step)
        points.append(np.column_stack([xy, z]))
        colours.append(np.tile(BONE + min(1.0, 2.2 * step) * (_DEEP - BONE), (count, 1)))
    corner = np.arange(count * (rings - 1))
    right = corner - corner % count + (corner + 1) % count
    triangles = np.concatenate(
        [np.stack([corner, right, right + count], 1), np.stack([corner, right + count, corner + count], 1)]
    )
    # the bowl opens towards the eye
    return np.concatenate(points), triangles[:, ::-1].astype(np.int32), np.concatenate(colours)
