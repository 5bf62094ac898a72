"""``muscles.yaml``: the vector muscles of one face, placed relative to its landmarks.

Lengths are in eye separations (the distance between the pupils), so that the same table fits a smaller head.
An entry describes the left muscle; the right one is its mirror image.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import ConfigDict, Field

from agentface.config import Document, Table
from agentface.conventions import SIDES, Doubles, Floats, Indices
from agentface.errors import did_you_mean
from agentface.head.landmarks import LANDMARKS, PAIRED_LANDMARKS, Landmarks
from agentface.head.muscle_set import MuscleSet
from agentface.head.regions import HALF_REGIONS, SUB_REGIONS, Regions
from agentface.parameters import VECTOR_MUSCLES

_Length = Annotated[float, Field(gt=0, le=5)]
_Offset = Annotated[list[Annotated[float, Field(ge=-5, le=5)]], Field(min_length=3, max_length=3)]
_MUSCLES = tuple(name.removesuffix("_l") for name in VECTOR_MUSCLES if name.endswith("_l"))
_AT_THE_BONE = 0.5  # of the muscle's length, where the skin begins to follow it fully
_MOVABLE = (*HALF_REGIONS, *SUB_REGIONS)


class Anchor(Table):
    """A point: a landmark (paired ones without side) and an offset [lateral, up, forward] in eye separations."""

    at: str
    offset: _Offset = [0.0, 0.0, 0.0]


class Wrinkles(Table):
    """How many wrinkles a muscle raises and how high they are, in eye separations."""

    count: Annotated[int, Field(ge=1, le=12)]
    height: Annotated[float, Field(ge=0, le=0.1)]


class Territory(Table):
    """What of the skin something works on: ``regions`` without ``not_regions``, fading over ``fade`` at the border."""

    regions: Annotated[list[str], Field(min_length=1)]
    not_regions: list[str] = []
    fade: Annotated[float, Field(ge=0, le=1)] = 0.12


class MuscleRow(Territory):
    """One pair of vector muscles.

    ``origin`` is the bone end, ``insertion`` the skin end; ``zone_deg`` half the angle of the zone of influence;
    ``fall_start`` (Rs) and ``fall_finish`` (Rf) distances from the origin; ``elasticity`` (k) the largest
    displacement. ``regions`` says what the muscle may move, ``not_regions`` what of it it may not; its pull
    fades out over ``fade`` before the border.
    """

    origin: Anchor
    insertion: Anchor
    zone_deg: Annotated[float, Field(gt=0, le=90)]
    fall_start: _Length
    fall_finish: _Length
    elasticity: Annotated[float, Field(ge=0, le=1)]
    wrinkles: Wrinkles | None = None


class MusclesFile(Table):
    """``muscles.yaml``."""

    falloff: Literal["smooth", "waters"]
    muscles: dict[str, MuscleRow]


class AnatomyFile(MusclesFile):
    """``anatomy.yaml``: the anatomist's muscles, beside sections for the parts that only the build of faces reads."""

    model_config = ConfigDict(extra="ignore")


def read_muscles(path: str | Path) -> MusclesFile:
    """The checked table; raises DataError naming unknown muscles, landmarks and regions, and missing muscles."""
    path = Path(path)
    document = Document(path)
    file = document.collect(AnatomyFile if path.name == "anatomy.yaml" else MusclesFile)
    rows = document.data.get("muscles") if isinstance(document.data, dict) else None
    if isinstance(rows, dict):
        for name in sorted(set(_MUSCLES) - rows.keys()):
            document.fault(("muscles",), f"an entry for {name}", "none")
        for name, row in rows.items():
            if name not in _MUSCLES:
                hint = did_you_mean(name, _MUSCLES)
                document.fault(("muscles", name), "the name of a vector muscle without side", str(name), hint)
            if isinstance(row, dict):
                _check_row(document, name, row)
    document.check()
    assert file is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    return MusclesFile(falloff=file.falloff, muscles=file.muscles)


def _check_row(document: Document, name: str, row: dict[str, Any]) -> None:
    """What one row names and how its numbers fit together; their form is the model's concern."""
    where, landmarks = ("muscles", name), (*LANDMARKS, *PAIRED_LANDMARKS)
    for key in ("origin", "insertion"):
        at = row[key].get("at") if isinstance(row.get(key), dict) else None
        if isinstance(at, str) and at not in landmarks:
            hint = did_you_mean(at, landmarks)
            document.fault((*where, key, "at"), "a landmark (paired ones without side)", at, hint)
    for key in ("regions", "not_regions"):
        for i, region in enumerate(row[key] if isinstance(row.get(key), list) else []):
            if region not in _MOVABLE:
                document.fault((*where, key, i), f"one of {', '.join(_MOVABLE)}", str(region))
    start, finish = (row.get(key) for key in ("fall_start", "fall_finish"))
    if isinstance(start, (int, float)) and isinstance(finish, (int, float)) and finish <= start:
        document.fault((*where, "fall_finish"), f"more than fall_start, {start}", str(finish))


def place_muscles(file: MusclesFile, landmarks: Landmarks, borders: Borders, vertices: Floats) -> MuscleSet:
    """The muscles of a face in metres, in the order of ``VECTOR_MUSCLES``."""
    unit = landmarks.eye_separation
    rows = [(file.muscles[name[:-2]], name[-1]) for name in VECTOR_MUSCLES]
    origin = np.array([anchor_point(row.origin, side, landmarks) for row, side in rows])
    insertion = np.array([anchor_point(row.insertion, side, landmarks) for row, side in rows])
    reach = border_weights(file, borders, unit)
    return MuscleSet(
        names=VECTOR_MUSCLES,
        origin=origin,
        insertion=insertion,
        zone=np.array([math.radians(row.zone_deg) for row, _ in rows]),
        fall_start=np.array([unit * row.fall_start for row, _ in rows]),
        fall_finish=np.array([unit * row.fall_finish for row, _ in rows]),
        elasticity=np.array([unit * row.elasticity for row, _ in rows]),
        reach=reach * off_the_bone(vertices, origin, insertion),
        falloff=file.falloff,
    )


def border_weights(file: MusclesFile, borders: Borders, unit: float) -> Floats:
    """``(M, V)`` weights of the muscles in the order of ``VECTOR_MUSCLES``: what each may move, faded at the border."""
    return np.stack([borders.reach(file.muscles[name[:-2]], unit) for name in VECTOR_MUSCLES])


def off_the_bone(vertices: Floats | Doubles, origin: Doubles, insertion: Doubles) -> Floats:
    """``(M, V)`` weights: skin over a muscle's attachment is not drawn into its apex, where it would pinch."""
    length = np.maximum(np.linalg.norm(insertion - origin, axis=1), 1e-9)  # MuscleSet refuses a muscle of no length
    distance = np.linalg.norm(vertices[None].astype(np.float32) - origin[:, None].astype(np.float32), axis=2)
    t = np.clip(distance / (_AT_THE_BONE * length[:, None]), 0.0, 1.0)
    return (t * t * (3.0 - 2.0 * t)).astype(np.float32)


def anchor_point(anchor: Anchor, side: str, landmarks: Landmarks) -> Doubles:
    """An anchor's position ``(3,)`` in metres on one side of the face."""
    name = f"{anchor.at}_{side}" if anchor.at in PAIRED_LANDMARKS else anchor.at
    mirrored = np.array([1.0 if side == SIDES[0] else -1.0, 1.0, 1.0])
    return np.asarray(landmarks[name] + landmarks.eye_separation * mirrored * anchor.offset, np.float64)


class Borders:
    """Distances along the skin to the border of a territory; those that were asked for once are known."""

    def __init__(self, regions: Regions, vertices: Floats, triangles: Indices) -> None:
        self._regions = regions
        ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        both = np.concatenate([ends, ends[:, ::-1]])
        self._from, to = both[np.argsort(both[:, 1], kind="stable")].T
        self._to, self._first = np.unique(to, return_index=True)
        self._length = np.linalg.norm(vertices[self._from] - vertices[to], axis=1)
        self._known: dict[tuple[str, ...], Floats] = {}

    def reach(self, row: Territory, unit: float) -> Floats:
        """``(V,)`` weights: 0 outside the territory, rising to 1 over ``fade`` inside."""
        key = (*sorted(row.regions), "|", *sorted(row.not_regions))
        if key not in self._known:
            inside = self._regions.mask(row.regions)
            if row.not_regions:
                inside &= ~self._regions.mask(row.not_regions)
            self._known[key] = self._distance(inside)
        t = np.clip(self._known[key] / max(row.fade * unit, 1e-9), 0.0, 1.0)
        return (t * t * (3.0 - 2.0 * t)).astype(np.float32)

    def _distance(self, inside: np.typing.NDArray[np.bool_], rounds: int = 24) -> Floats:
        distance = np.where(inside, np.float32(1e3), np.float32(0.0))
        for _ in range(rounds):
            nearest = np.minimum.reduceat(distance[self._from] + self._length, self._first)
            distance[self._to] = np.minimum(distance[self._to], nearest)
        return distance
