"""The feature points of MPEG-4 (ISO/IEC 14496-2, Annex C) on a head: which vertex of which mesh each is."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from agentface.config import Document, Table
from agentface.conventions import Indices
from agentface.errors import DataError, Fault

_GROUPS = {2: 14, 3: 14, 4: 6, 5: 4, 6: 4, 7: 1, 8: 10, 9: 15, 10: 10, 11: 6}
"""Points a group."""
FEATURE_POINTS: tuple[str, ...] = tuple(f"{group}.{i + 1}" for group, count in _GROUPS.items() for i in range(count))
"""The numbers of the 84 points."""
PointMesh = Literal["skin", "teeth_upper", "teeth_lower", "tongue"]
PointPlace = Literal["pupil_l", "pupil_r", "neck"]


class FeaturePointRow(Table):
    """Where a feature point is: a vertex of a mesh, a place that is none, or the reason why the head has none."""

    mesh: PointMesh = "skin"
    vertex: Annotated[int, Field(ge=0)] | None = None
    place: PointPlace | None = None
    absent: Annotated[str, Field(min_length=1)] | None = None

    @model_validator(mode="after")
    def _one_of_three(self) -> FeaturePointRow:
        if [self.vertex, self.place, self.absent].count(None) != 2:
            raise ValueError("expected one of vertex, place and absent")
        return self


def check_points(document: Document, rows: Mapping[str, FeaturePointRow], vertex_count: int) -> None:
    """Remember a fault for each point that is missing, unknown, or no vertex of a skin of ``vertex_count``."""
    for number in sorted(rows.keys() - set(FEATURE_POINTS)):
        document.fault(("feature_points", number), "a feature point of MPEG-4", number, "2.1 to 11.6")
    missing = [number for number in FEATURE_POINTS if number not in rows]
    if missing:
        document.fault(
            ("feature_points",), "all 84 points", f"none of {', '.join(missing)}", "agentface build has them"
        )
    for number, row in rows.items():
        if row.mesh == "skin" and row.vertex is not None and row.vertex >= vertex_count:
            document.fault(("feature_points", number, "vertex"), f"a vertex in 0..{vertex_count - 1}", str(row.vertex))


def check_parts(path: str | Path, rows: Mapping[str, FeaturePointRow], counts: Mapping[str, int]) -> None:
    """Raise DataError for points that are no vertices of a part, by the parts' ``counts`` of vertices."""
    faults = [
        Fault(
            Path(path),
            None,
            f"feature_points.{number}.vertex",
            f"a vertex in 0..{counts[row.mesh] - 1}",
            str(row.vertex),
        )
        for number, row in rows.items()
        if row.mesh != "skin" and row.vertex is not None and row.vertex >= counts[row.mesh]
    ]
    if faults:
        raise DataError(faults)


def renumbered(rows: Mapping[str, FeaturePointRow], place: Indices) -> dict[str, FeaturePointRow]:
    """The points of a skin whose vertex i is now vertex ``place[i]``, or gone where that is negative."""

    def moved(row: FeaturePointRow) -> FeaturePointRow:
        if row.mesh != "skin" or row.vertex is None:
            return row
        vertex = int(place[row.vertex])
        if vertex < 0:
            return FeaturePointRow(absent="the vertex was left out where the mesh was thinned")
        return FeaturePointRow(vertex=vertex)

    return {number: moved(row) for number, row in rows.items()}
