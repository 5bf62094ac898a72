"""``volumes.yaml``: where contracting muscles gather skin and flesh, and where they hollow them.

Wrinkles are lines; these are the forms between them: the apple of a smiling cheek, the boss of the chin, the bulge
of a frowning brow, the pit at the corner of the mouth. Lengths are in eye separations. An entry describes the left
side; the right one is its mirror image.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Self

import numpy as np
from pydantic import Field, model_validator

from agentface.config import Document, Table
from agentface.conventions import SIDES, Doubles, Floats, Indices
from agentface.errors import did_you_mean
from agentface.head.landmarks import LANDMARKS, PAIRED_LANDMARKS, Landmarks
from agentface.head.muscles import Anchor, Borders, Territory, anchor_point
from agentface.head.regions import HALF_REGIONS, SUB_REGIONS
from agentface.parameters import MUSCLES, indices_of

_Share = Annotated[float, Field(ge=-2, le=2)]
_Radius = Annotated[float, Field(gt=0, le=2)]
_Way = Annotated[float, Field(ge=-0.3, le=0.3)]
_LOWEST = 1e-6  # m, what is not worth a store


class Ellipsoid(Territory):
    """Skin that moves, most in its middle ``centre`` and not at all at its rim.

    ``radii`` are those of the ellipsoid [lateral, up, forward], turned by ``tilt_deg`` about the forward axis
    (positive: the upper end to the nose). It goes ``height`` along the skin's normal, out or (negative) in, and
    ``way``.
    """

    centre: Anchor
    radii: Annotated[list[_Radius], Field(min_length=3, max_length=3)]
    tilt_deg: Annotated[float, Field(ge=-90, le=90)] = 0.0
    height: _Way = 0.0
    way: Annotated[list[_Way], Field(min_length=3, max_length=3)] = [0.0, 0.0, 0.0]

    @model_validator(mode="after")
    def _moving(self) -> Self:
        if not (self.height or any(self.way)):
            raise ValueError("expected a height or a way that is not 0")
        return self

    def field(self, skin: tuple[Floats, Floats], landmarks: Landmarks, borders: Borders, side: str) -> Doubles:
        """``(V, 3)`` m: how far it moves the ``skin``, vertices ``(V, 3)`` m and unit normals, on side l or r."""
        (vertices, normals), unit = skin, landmarks.eye_separation
        sign = 1.0 if side == SIDES[0] else -1.0
        weight = borders.reach(self, unit) * _inside(self, vertices, landmarks, side)
        way = self.height * normals + np.array(self.way) * [sign, 1.0, 1.0]
        return np.asarray(unit * weight[:, None] * way, np.float64)


class VolumeRow(Ellipsoid):
    """One pair of volumes: an ellipsoid of skin that muscles move.

    ``muscles`` and their shares: it moves as far as the sum of their contractions times shares, 0..1.
    """

    muscles: Annotated[dict[str, _Share], Field(min_length=1)]


class VolumesFile(Table):
    """``volumes.yaml``."""

    volumes: dict[str, VolumeRow]


@dataclass(frozen=True, slots=True)
class PlacedVolume:
    """One volume of one side of a face.

    Attributes:
        name: of its row, with its side.
        shares: by parameter, its part in the volume's level.
        vertices: ``(N,)`` what it moves.
        ways: ``(N, 3)`` float32 m, how far at level 1.
    """

    name: str
    shares: dict[int, float]
    vertices: Indices
    ways: Floats


def read_volumes(path: str | Path) -> VolumesFile:
    """The checked table; raises DataError naming unknown muscles, landmarks and regions."""
    document = Document(path)
    file = document.collect(VolumesFile)
    rows = document.data.get("volumes") if isinstance(document.data, dict) else None
    for name, row in rows.items() if isinstance(rows, dict) else ():
        if isinstance(row, dict):
            _check_row(document, ("volumes", name), row)
    document.check()
    assert file is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    return file


def _check_row(document: Document, where: tuple[str, str], row: dict[str, Any]) -> None:
    check_names(document, where, row, {"muscles": ("a muscle without side", MUSCLES)})


def check_names(
    document: Document, where: tuple[str | int, ...], row: dict[str, Any], more: dict[str, tuple[str, tuple[str, ...]]]
) -> None:
    """Note each unknown region and landmark of an ellipsoid's ``row``, and names under other keys that ``more`` lacks.

    ``more`` has for a key what is named there and the names that are known.
    """
    named: dict[str, tuple[str, tuple[str, ...]]] = {
        **more,
        "regions": ("a region", (*HALF_REGIONS, *SUB_REGIONS)),
        "not_regions": ("a region", (*HALF_REGIONS, *SUB_REGIONS)),
    }
    for key, (what, names) in named.items():
        items = row.get(key)
        for i, item in enumerate(items if isinstance(items, list | dict) else []):
            if item not in names:
                place = item if isinstance(items, dict) else i
                document.fault((*where, key, place), what, str(item), did_you_mean(str(item), names))
    landmarks = (*LANDMARKS, *PAIRED_LANDMARKS)
    at = row["centre"].get("at") if isinstance(row.get("centre"), dict) else None
    if isinstance(at, str) and at not in landmarks:
        what = "a landmark (paired ones without side)"
        document.fault((*where, "centre", "at"), what, at, did_you_mean(at, landmarks))


def place_volumes(
    file: VolumesFile,
    landmarks: Landmarks,
    borders: Borders,
    skin: tuple[Floats, Floats],
    movable: Floats,
) -> tuple[PlacedVolume, ...]:
    """The volumes of a face, left before right.

    Args:
        file: the table.
        landmarks: of the face.
        borders: of its territories.
        skin: its vertices ``(V, 3)`` m and unit normals at rest.
        movable: ``(V,)`` 0..1, how far any volume may move a vertex.
    """
    placed = []
    for name, row in file.volumes.items():
        for side in SIDES:
            shares = {index: share for muscle, share in row.muscles.items() for index in _indices(muscle, side)}
            ways = (movable[:, None] * row.field(skin, landmarks, borders, side)).astype(np.float32)
            chosen = np.flatnonzero(np.abs(ways).max(axis=1) > _LOWEST).astype(np.int32)
            placed.append(PlacedVolume(f"{name}_{side}", shares, chosen, np.ascontiguousarray(ways[chosen])))
    return tuple(placed)


def _indices(muscle: str, side: str) -> tuple[int, ...]:
    indices = indices_of(muscle)
    return (indices[SIDES.index(side)],) if len(indices) > 1 else indices


def _inside(row: Ellipsoid, vertices: Floats, landmarks: Landmarks, side: str) -> Floats:
    """``(V,)``: (1 - d^2)^2 with d the distance from the centre as a part of the ellipsoid's radius there."""
    sign, tilt = (1.0 if side == SIDES[0] else -1.0), np.radians(row.tilt_deg)
    away = (vertices - anchor_point(row.centre, side, landmarks)) * [sign, 1.0, 1.0]
    x = np.cos(tilt) * away[:, 0] + np.sin(tilt) * away[:, 1]
    y = np.cos(tilt) * away[:, 1] - np.sin(tilt) * away[:, 0]
    parts = np.stack([x, y, away[:, 2]], axis=1) / (landmarks.eye_separation * np.array(row.radii))
    return np.asarray(np.maximum(1.0 - (parts**2).sum(axis=1), 0.0) ** 2, np.float32)
