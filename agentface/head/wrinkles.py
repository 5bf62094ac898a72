"""``wrinkles.yaml``: the trains of wrinkles that follow no single muscle's zone, placed relative to the landmarks.

Lengths are in eye separations. An entry describes the left side; the right one is its mirror image.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from agentface.config import Document, Table
from agentface.conventions import SIDES, Doubles, Floats
from agentface.errors import InvalidValueError, Place, did_you_mean
from agentface.head.landmarks import LANDMARKS, PAIRED_LANDMARKS, Landmarks
from agentface.head.muscle_set import MuscleSet
from agentface.head.muscles import Anchor, Borders, MusclesFile, Territory, Wrinkles, anchor_point
from agentface.head.regions import HALF_REGIONS, SUB_REGIONS
from agentface.head.trains import DrawnTrain, Train, ZoneTrain
from agentface.parameters import MUSCLES, VECTOR_MUSCLES, indices_of

_Part = Annotated[float, Field(ge=0, le=1)]
_SHORTEST = 0.01  # eye separations, of a train
_APART = "a point beside start, seen along facing"
_SLANT = 1e-3  # the least length of a direction
_Direction = Annotated[list[Annotated[float, Field(ge=-100, le=100)]], Field(min_length=3, max_length=3)]


class TrainRow(Territory, Wrinkles):
    """One pair of trains: ``count`` wrinkles across the way from ``start`` to ``end``.

    ``muscles`` raise it, the most contracted one sets how high. ``facing`` is the direction that the wrinkles are
    drawn from; ``bow`` the curvature of the wrinkles, 1 / eye separation, positive with its centre beyond ``end``;
    for a ``fan`` they are the spokes about that centre. Along the wrinkles the train reaches ``half_width`` to both
    sides of ``aside`` and fades beyond the part ``flat`` of it; ``taper`` gives the parts of the length over which
    the first and the last wrinkles flatten; ``waver`` says how far the wrinkles wander,
    ``uneven`` how much lower they are here and there, ``shade`` how dark the creases are.
    """

    muscles: Annotated[list[str], Field(min_length=1)]
    start: Anchor
    end: Anchor
    facing: _Direction = [0.0, 0.0, 1.0]
    bow: Annotated[float, Field(ge=-20, le=20)] = 0.0
    fan: bool = False
    aside: Annotated[float, Field(ge=-2, le=2)] = 0.0
    half_width: Annotated[float, Field(gt=0, le=2)]
    flat: Annotated[float, Field(ge=0, le=0.9)] = 0.3
    taper: Annotated[list[_Part], Field(min_length=2, max_length=2)] = [0.3, 0.3]
    waver: Annotated[float, Field(ge=0, le=0.1)] = 0.0
    uneven: _Part = 0.0
    shade: _Part = 1.0


class WrinklesFile(Table):
    """``wrinkles.yaml``."""

    trains: dict[str, TrainRow]


@dataclass(frozen=True, slots=True)
class PlacedTrain:
    """One train of one side of a face.

    Attributes:
        name: of its row or its muscle, with its side.
        parameters: the indices of the parameters that raise it.
        train: where its wrinkles are.
        reach: ``(V,)`` float32 0..1, how far they may rise on each vertex.
    """

    name: str
    parameters: tuple[int, ...]
    train: Train
    reach: Floats


def read_wrinkles(path: str | Path) -> WrinklesFile:
    """The checked table; raises DataError naming unknown muscles, landmarks and regions."""
    document = Document(path)
    file = document.collect(WrinklesFile)
    rows = document.data.get("trains") if isinstance(document.data, dict) else None
    for name, row in rows.items() if isinstance(rows, dict) else ():
        if isinstance(row, dict):
            _check_row(document, name, row)
    document.check()
    assert file is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    return file


def _check_row(document: Document, name: str, row: dict[str, Any]) -> None:
    where = ("trains", name)
    landmarks, regions = (*LANDMARKS, *PAIRED_LANDMARKS), (*HALF_REGIONS, *SUB_REGIONS)
    known: dict[str, tuple[str, tuple[str, ...]]] = {
        "muscles": ("a muscle without side", MUSCLES),
        "regions": ("a region", regions),
        "not_regions": ("a region", regions),
    }
    for key, (what, names) in known.items():
        for i, item in enumerate(row[key] if isinstance(row.get(key), list) else []):
            if item not in names:
                document.fault((*where, key, i), what, str(item), did_you_mean(str(item), names))
    facing = _numbers(row.get("facing", [0.0, 0.0, 1.0]))
    if facing is not None and np.linalg.norm(facing) < _SLANT:
        document.fault((*where, "facing"), "a direction", str(row["facing"]))
        facing = None
    for key in ("start", "end"):
        at = row[key].get("at") if isinstance(row.get(key), dict) else None
        if isinstance(at, str) and at not in landmarks:
            hint = did_you_mean(at, landmarks)
            document.fault((*where, key, "at"), "a landmark (paired ones without side)", at, hint)
    if facing is not None:
        _check_way(document, where, row, facing)


def _check_way(document: Document, where: tuple[str, str], row: dict[str, Any], facing: Doubles) -> None:
    """A way between two offsets from one landmark is known without the face."""
    start, end = (row[key] if isinstance(row.get(key), dict) else {} for key in ("start", "end"))
    offsets = [_numbers(anchor.get("offset", [0.0, 0.0, 0.0])) for anchor in (start, end)]
    if start.get("at") is None or start.get("at") != end.get("at") or offsets[0] is None or offsets[1] is None:
        return
    if np.linalg.norm(_beside(offsets[1] - offsets[0], _unit(facing))) <= _SHORTEST:
        document.fault((*where, "end"), _APART, f"{end['at']} {offsets[1].tolist()}")


def _numbers(values: Any) -> Doubles | None:
    """Three finite numbers as they were read, or None for what the table's model refuses anyway."""
    if not isinstance(values, list) or len(values) != 3 or not all(type(value) in (int, float) for value in values):
        return None
    return np.array(values, np.float64) if max(map(abs, values)) <= 100 else None


def _beside(way: Doubles, facing: Doubles) -> Doubles:
    """The part of a way that is seen along ``facing``, a unit vector."""
    beside: Doubles = way - (way @ facing) * facing
    return beside


def place_trains(
    muscles: MuscleSet,
    muscles_file: MusclesFile,
    file: WrinklesFile,
    landmarks: Landmarks,
    borders: Borders,
    raisable: Floats,
) -> tuple[PlacedTrain, ...]:
    """The trains of a face: those of its vector muscles, then those of ``wrinkles.yaml``, left before right.

    ``raisable`` is ``(V,)`` 0..1, how far any wrinkle may rise on a vertex.
    """
    unit = landmarks.eye_separation
    trains = [
        PlacedTrain(name, indices_of(name), _zone_train(muscles, i, row.wrinkles, unit), raisable * muscles.reach[i])
        for i, name in enumerate(VECTOR_MUSCLES)
        if (row := muscles_file.muscles[name[:-2]]).wrinkles is not None
    ]
    for name, drawn in file.trains.items():
        for side in SIDES:
            indices = tuple(_index(muscle, side) for muscle in drawn.muscles)
            train = _drawn_train(name, drawn, side, landmarks)
            trains.append(PlacedTrain(f"{name}_{side}", indices, train, raisable * borders.reach(drawn, unit)))
    return tuple(trains)


def _index(muscle: str, side: str) -> int:
    indices = indices_of(muscle)
    return indices[SIDES.index(side) if len(indices) > 1 else 0]


def _zone_train(muscles: MuscleSet, i: int, wrinkles: Wrinkles | None, unit: float) -> ZoneTrain:
    assert wrinkles is not None, "only muscles with wrinkles have a train"  # noqa: S101 - for the type checker
    axis, finish = muscles.axis[i], float(muscles.fall_finish[i])
    zone = min(float(muscles.zone[i]), np.radians(85.0))
    return ZoneTrain(muscles.origin[i], axis, zone, finish, wrinkles.count, unit * wrinkles.height)


def _drawn_train(name: str, row: TrainRow, side: str, landmarks: Landmarks) -> DrawnTrain:
    unit, sign = landmarks.eye_separation, 1.0 if side == SIDES[0] else -1.0
    start, end = (anchor_point(anchor, side, landmarks) for anchor in (row.start, row.end))
    facing = _unit(np.array(row.facing) * [sign, 1.0, 1.0])
    way = _beside(end - start, facing)
    if not np.linalg.norm(way) > _SHORTEST * unit:
        raise InvalidValueError(
            Place("wrinkles.yaml", ("trains", name, "end")), _APART, f"{row.end.at} {row.end.offset}"
        )
    along = _unit(way)
    return DrawnTrain(
        start=start,
        along=along,
        across=sign * np.cross(along, facing),
        length=float(np.linalg.norm(way)),
        count=row.count,
        height=unit * row.height,
        bow=row.bow / unit,
        fan=row.fan,
        aside=unit * row.aside,
        half_width=unit * row.half_width,
        flat=row.flat,
        taper=(row.taper[0], row.taper[1]),
        waver=unit * row.waver,
        uneven=row.uneven,
        shade=row.shade,
    )


def _unit(vector: Doubles) -> Doubles:
    unit: Doubles = vector / np.linalg.norm(vector)
    return unit
