"""``morphs.yaml``: how the parameters that are no single muscle move the skin at the ends of their ranges.

Each end is a sum of the artists' shapes, of ellipsoids of skin and of a way of the whole ear. What is between is in
proportion.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from pydantic import Field

from agentface.config import Document, Table
from agentface.conventions import SIDES, Doubles, Floats, Indices
from agentface.errors import did_you_mean
from agentface.head.arkit import ARKIT_SHAPES, sided
from agentface.head.landmarks import Landmarks
from agentface.head.muscles import Borders
from agentface.head.ring_names import LipRing
from agentface.head.rings import RingHalves
from agentface.head.volumes import Ellipsoid, check_names
from agentface.mesh.evening import evened
from agentface.mesh.glb import Shape
from agentface.mesh.smoothstep import smoothstep
from agentface.parameters import PARAMETERS, indices_of

_Part = Annotated[float, Field(ge=-2, le=2)]
_Way = Annotated[float, Field(ge=-0.3, le=0.3)]
_Height = Annotated[float, Field(ge=-0.2, le=0.2)]
_SIDE_M = 0.009
"""m on either side of the median plane over which one side's part of a shape goes over into the other's."""
_LIP_M, _CORNER_M = 0.004, 0.012
"""m above and below the lips' line over which that is so for upper and lower lip, in the middle and at the corners."""
_LOWEST = 1e-5  # m, what is not worth a store
_EAR, _EAR_EVENINGS = 3, 24
_EVENINGS = 20  # artists' shapes end abruptly where two of them are never seen together, as below the nose
MORPHED: tuple[str, ...] = tuple(
    dict.fromkeys(known.name[:-2] if known.partner else known.name for known in PARAMETERS if known.morphs)
)
"""The parameters, without side, that have a row each."""


class End(Table):
    """What one end of a parameter's range does; of one with sides, the left one's: the right is its mirror image.

    ``shapes`` are artists' shapes and how much of each. For a parameter with sides one that the artists made for each
    side is named without it, and of one for both sides its own side counts. ``bumps`` are ellipsoids; ``ears`` is how
    far the whole ear goes, in eye separations [outward, up, forward].
    """

    shapes: dict[str, _Part] = {}
    bumps: list[Ellipsoid] = []
    ears: Annotated[list[_Way], Field(min_length=3, max_length=3)] = [0.0, 0.0, 0.0]


class MorphRow(Table):
    """One parameter. ``lip`` is the lip to which it is kept; ``low`` is for one that has negative values.

    The lower end of one that goes sideways is the image of its upper one, and has no row.
    """

    lip: Literal["upper", "lower"] | None = None
    high: End
    low: End | None = None


class MorphsFile(Table):
    """``morphs.yaml``."""

    morphs: dict[str, MorphRow]


@dataclass(frozen=True, slots=True)
class PlacedMorph:
    """One end of one parameter on a face.

    Attributes:
        index: of the parameter in a pose.
        sign: 1 for the upper end of its range, -1 for the lower one.
        lip: of which half of a lip it is: 0 to 3, or -1; what one half does at once shares its muscle.
        vertices: ``(N,)`` what it moves.
        ways: ``(N, 3)`` float32 m, how far at that end, on a face whose jaw is closed.
    """

    index: int
    sign: int
    lip: int
    vertices: Indices
    ways: Floats


def read_morphs(path: str | Path) -> MorphsFile:
    """The checked table; raises DataError naming unknown or missing parameters, shapes, landmarks and regions."""
    document = Document(path)
    file = document.collect(MorphsFile)
    rows = document.data.get("morphs") if isinstance(document.data, dict) else None
    for name, row in rows.items() if isinstance(rows, dict) else ():
        if name not in MORPHED:
            what = "a parameter without side that moves skin by a shape"
            document.fault(("morphs", name), what, str(name), did_you_mean(str(name), MORPHED))
        elif isinstance(row, dict):
            _check_row(document, name, row)
    for name in MORPHED:
        if isinstance(rows, dict) and name not in rows:
            document.fault(("morphs",), f"the parameter {name}", "none")
    document.check()
    assert file is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    return file


def _check_row(document: Document, name: str, row: dict[str, Any]) -> None:
    known = PARAMETERS[indices_of(name)[0]]
    signed = known.low < 0.0 and not known.sideways
    if signed != ("low" in row):
        got, what = ("none", "this key") if signed else ("one", "no key for values below 0, which it has not")
        document.fault(("morphs", name, "low"), what, got)
    plain = {shape[: -len("Left")] for shape in ARKIT_SHAPES if sided(shape.removesuffix("Left"), SIDES[0])}
    for key in ("high", "low"):
        end = row.get(key)
        if isinstance(end, dict):
            shapes = "an artists' shape (ARKit's names)", (*ARKIT_SHAPES, *sorted(plain))
            check_names(document, ("morphs", name, key), end, {"shapes": shapes})
            bumps = end.get("bumps")
            for i, bump in enumerate(bumps if isinstance(bumps, list) else ()):
                if isinstance(bump, dict):
                    check_names(document, ("morphs", name, key, "bumps", i), bump, {})


class MorphSkin(NamedTuple):
    """What morphs need of a face: fields of :class:`agentface.head.model.HeadModel`."""

    vertices: Floats
    triangles: Indices
    mirror: Indices
    normals: Floats
    material: Floats
    shapes: dict[str, Shape]
    landmarks: Landmarks
    borders: Borders
    lip_rings: list[RingHalves]


def place_morphs(file: MorphsFile, skin: MorphSkin) -> tuple[PlacedMorph, ...]:
    """The morphs of a face in the order of the parameters, a row's upper end before its lower one.

    A shape that the head does not have moves nothing.
    """
    placed = []
    for name, row in file.morphs.items():
        lip = -1 if row.lip is None else 2 * (row.lip == "lower")
        index, *partner = indices_of(name)
        for sign, end in ((1, row.high), (-1, row.low)):
            if end is None:
                continue
            way = _field(skin, end, paired=bool(partner))
            if row.lip is not None:
                way *= _of_lip(skin, row.lip)[:, None]
            image = way[skin.mirror] * [-1.0, 1.0, 1.0]
            if partner:
                placed += [_placed(index, sign, lip, way), _placed(partner[0], sign, lip + (lip >= 0), image)]
            elif PARAMETERS[index].sideways:
                placed += [_placed(index, 1, lip, way), _placed(index, -1, lip, image)]
            else:
                placed.append(_placed(index, sign, lip, 0.5 * (way + image)))
    return tuple(sorted(placed, key=lambda morph: (morph.index, -morph.sign)))


def _placed(index: int, sign: int, lip: int, way: Doubles) -> PlacedMorph:
    moved = np.flatnonzero(np.abs(way).max(axis=1) > _LOWEST).astype(np.int32)
    return PlacedMorph(index, sign, lip, moved, np.ascontiguousarray(way[moved], np.float32))


def _field(skin: MorphSkin, end: End, *, paired: bool) -> Doubles:
    """``(V, 3)`` m: what an end does, of a parameter with sides the left one's."""
    count, unit = len(skin.vertices), skin.landmarks.eye_separation
    way = np.zeros((count, 3))
    for name, part in end.shapes.items():
        own = sided(name, SIDES[0]) if paired else None
        shape = skin.shapes.get(own or name)
        if shape is not None:
            of_both = paired and not own
            share = smoothstep(-_SIDE_M, _SIDE_M, skin.vertices[:, 0]) if of_both else np.ones(count)
            way += part * share[:, None] * shape.dense(count)
    if end.shapes:
        way = evened(way, skin.triangles, _EVENINGS, skin.material[:, :3].max(axis=1) == 0.0)
    for bump in end.bumps:
        way += bump.field((skin.vertices, skin.normals), skin.landmarks, skin.borders, SIDES[0])
    if any(end.ears):
        ear = (skin.material[:, _EAR] * (skin.vertices[:, 0] > 0.0)).astype(np.float64)
        # its root stays, so that it leans and does not fold
        ear = evened(ear[:, None], skin.triangles, _EAR_EVENINGS)
        way += unit * ear * np.array(end.ears)
    return way


def _of_lip(skin: MorphSkin, lip: str) -> Doubles:
    """``(V,)`` 0..1: how far each vertex belongs to the upper or to the lower lip, which sum to 1."""
    seam = skin.lip_rings[LipRing.CONTACT]
    across, height = skin.vertices[sorted(seam.upper, key=lambda vertex: skin.vertices[vertex, 0]), :2].T
    line = np.interp(skin.vertices[:, 0], across, height)
    inside = skin.landmarks["mouth_corner_l"][0] - np.abs(skin.vertices[:, 0])
    reach = _CORNER_M + (_LIP_M - _CORNER_M) * smoothstep(0.0, _CORNER_M, inside)
    above = smoothstep(-reach, reach, skin.vertices[:, 1] - line)
    for ring in skin.lip_rings:
        for half, value in ((ring.upper, 1.0), (ring.lower, 0.0)):
            inner = np.array(half[1:-1], np.int64)
            corner = np.abs(skin.vertices[half[0], 0]) - np.abs(skin.vertices[inner, 0])
            share = smoothstep(0.0, _CORNER_M, corner)
            above[inner] = share * value + (1.0 - share) * above[inner]
    return above if lip == "upper" else 1.0 - above
