"""Named points of the face, found by vertex: what muscles are anchored to on any face."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from agentface.config import Document, Table
from agentface.conventions import SIDES, Floats
from agentface.head.feature_points import FeaturePointRow, check_points

LANDMARKS: tuple[str, ...] = (
    "hairline_middle", "glabella", "nasion", "nose_tip", "subnasale", "upper_lip_middle", "lower_lip_middle",
    "chin_fold", "pogonion", "menton",
)  # fmt: skip
PAIRED_LANDMARKS: tuple[str, ...] = (
    "brow_inner", "brow_middle", "brow_outer", "inner_canthus", "outer_canthus", "lid_upper", "lid_lower",
    "infraorbital", "cheekbone", "zygion", "alare", "mouth_corner", "upper_lip_side", "lower_lip_side", "cheek",
    "jaw_side", "gonion", "ear_front", "pupil",
)  # fmt: skip


_NO_VERTICES = {f"pupil_{side}" for side in SIDES}


def both_sides(name: str) -> tuple[str, ...]:
    """A paired landmark named without its side as its two; another as it is."""
    return tuple(f"{name}_{side}" for side in SIDES) if name in PAIRED_LANDMARKS else (name,)


class LandmarkRow(Table):
    """One landmark: the vertices whose mean it is."""

    vertices: Annotated[list[int], Field(min_length=1)]


class FeaturePointsFile(Table):
    """``feature_points.yaml``: the landmarks, and the feature points of MPEG-4 by number."""

    landmarks: dict[str, LandmarkRow]
    feature_points: dict[str, FeaturePointRow]


class Landmarks(dict[str, Floats]):
    """Name to position ``(3,)`` in metres at rest; paired names carry ``_l`` or ``_r``."""

    @property
    def eye_separation(self) -> float:
        """The distance between the pupils in metres: the unit of lengths in ``muscles.yaml`` (MPEG-4's ES0)."""
        return float(np.linalg.norm(self["pupil_l"] - self["pupil_r"]))


def read_landmarks(path: str | Path, vertex_count: int) -> FeaturePointsFile:
    """The checked table of a mesh of ``vertex_count`` vertices.

    Raises DataError when a landmark or a feature point is missing, unknown or names a vertex that the mesh does not
    have.
    """
    document = Document(path)
    file = document.parse(FeaturePointsFile)
    known = {*LANDMARKS, *(f"{name}_{side}" for name in PAIRED_LANDMARKS for side in SIDES)}
    for name in sorted(file.landmarks.keys() - known):
        document.fault(
            ("landmarks", name), "a landmark that agentface knows", name, f"known: {', '.join(sorted(known))}"
        )
    for name in sorted(known - file.landmarks.keys() - _NO_VERTICES):
        document.fault(("landmarks",), f"the landmark {name}", "none")
    for name, row in file.landmarks.items():
        bad = [index for index in row.vertices if not 0 <= index < vertex_count]
        if bad:
            document.fault(("landmarks", name, "vertices"), f"vertices in 0..{vertex_count - 1}", str(bad))
    check_points(document, file.feature_points, vertex_count)
    document.check()
    return file


def place_landmarks(file: FeaturePointsFile, vertices: Floats, pupils: dict[str, Floats]) -> Landmarks:
    """Where the landmarks are on a face at rest, ``vertices (V, 3)`` m; the pupils are no vertices of the skin."""
    return Landmarks(pupils | {name: vertices[row.vertices].mean(axis=0) for name, row in file.landmarks.items()})
