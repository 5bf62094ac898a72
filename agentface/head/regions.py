"""The eleven regions of the face and their sub-regions, as ranges of vertices (Bui et al., section 2.1)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from agentface.config import Document, Table
from agentface.conventions import SIDES, Bytes
from agentface.errors import UnknownNameError, did_you_mean

HALF_REGIONS = ("lower_face", "middle_face", "lower_eyelid", "upper_eyelid", "upper_face")
REST = "rest_of_head"
REGIONS: tuple[str, ...] = (*(f"{name}_{side}" for side in ("r", "l") for name in HALF_REGIONS), REST)
"""The paper's regions 1 to 11, in its order: the right half, the left half, the rest."""
SUB_REGIONS = {"lower_lip": "lower_face", "upper_lip": "middle_face", "eyebrow": "upper_face"}
"""Each sub-region and the region that it is part of."""

LIMITED: tuple[str, ...] = (*HALF_REGIONS, *SUB_REGIONS, REST)
"""What has a limit of its own: regions and sub-regions without their side, and the rest of the head."""

_Range = Annotated[list[int], Field(min_length=2, max_length=2)]
_Ends = tuple[int, int]
Limits = dict[str, Annotated[float, Field(gt=0, le=1)]]
"""How far muscles may move the skin of each region of ``LIMITED``, in eye separations."""


class RegionsFile(Table):
    """``regions.yaml``: the first and the last vertex of each region and sub-region, both included, and the limits."""

    vertices: int
    regions: dict[str, _Range]
    sub_regions: dict[str, _Range]
    limits: Limits


@dataclass(frozen=True, slots=True)
class Regions:
    """Which region each vertex is in.

    ``region_of`` is ``(V,)`` uint8, an index into ``REGIONS``; ``ranges`` maps the name of a region or a
    sub-region (with its side) to ``(first, last)``, both included; ``limits`` says how far muscles may move each
    of ``LIMITED``, in eye separations.
    """

    region_of: Bytes
    ranges: dict[str, tuple[int, int]]
    limits: dict[str, float]

    def members(self, name: str) -> slice:
        """The vertices of a region or sub-region, for example ``upper_lip_l``; raises UnknownNameError."""
        if name not in self.ranges:
            raise UnknownNameError("region", name, tuple(self.ranges))
        first, last = self.ranges[name]
        return slice(first, last + 1)

    def mask(self, names: list[str]) -> np.typing.NDArray[np.bool_]:
        """``(V,)`` true where a vertex is in one of the regions, named without side for both sides."""
        inside = np.zeros(len(self.region_of), np.bool_)
        for name in names:
            for full in with_sides(name):
                inside[self.members(full)] = True
        return inside


def with_sides(name: str) -> tuple[str, ...]:
    """A region named without its side as its two halves; other names as they are."""
    if name in HALF_REGIONS or name in SUB_REGIONS:
        return tuple(f"{name}_{side}" for side in SIDES)
    return (name,)


def load_regions(path: str | Path, vertex_count: int) -> Regions:
    """Read ``regions.yaml``; raises DataError when ranges overlap, leave a gap or do not fit the mesh."""
    document = Document(path)
    file = document.collect(RegionsFile)
    tables = document.data if isinstance(document.data, dict) else {}
    if file is not None and file.vertices != vertex_count:
        document.fault(("vertices",), f"{vertex_count}, as in head.glb", str(file.vertices))
    subs = tuple(f"{name}_{side}" for name in SUB_REGIONS for side in SIDES)
    _check_names(document, "regions", tables, REGIONS, "a range")
    _check_names(document, "sub_regions", tables, subs, "a range")
    _check_names(document, "limits", tables, LIMITED, "a limit")
    _check_ranges(document, _ranges(tables.get("regions")), _ranges(tables.get("sub_regions")), vertex_count)
    document.check()
    assert file is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    region_of = np.empty(vertex_count, np.uint8)
    for index, name in enumerate(REGIONS):
        first, last = file.regions[name]
        region_of[first : last + 1] = index
    ranges = {name: (first, last) for name, (first, last) in (file.regions | file.sub_regions).items()}
    return Regions(region_of, ranges, dict(file.limits))


def _check_names(document: Document, key: str, tables: dict[str, Any], known: tuple[str, ...], what: str) -> None:
    table = tables.get(key)
    if not isinstance(table, dict):
        return
    for name in sorted(map(str, table.keys() - set(known))):
        document.fault((key, name), f"one of {', '.join(known)}", name, did_you_mean(name, known))
    for name in sorted(set(known) - table.keys()):
        document.fault((key,), f"{what} for {name}", "none")


def _ranges(table: Any) -> dict[str, _Ends] | None:
    """The ranges of a table as it was read, or None where one of them is none: the others would seem to leave gaps."""
    rows = table.values() if isinstance(table, dict) else [None]
    if not all(isinstance(row, list) and len(row) == 2 and all(type(end) is int for end in row) for row in rows):
        return None
    return {str(name): (row[0], row[1]) for name, row in table.items()}


def _check_ranges(
    document: Document, regions: dict[str, _Ends] | None, subs: dict[str, _Ends] | None, vertex_count: int
) -> None:
    if regions is None:
        return
    _check_cover(document, regions, vertex_count)
    for name, (first, last) in (subs or {}).items():
        owner = f"{SUB_REGIONS.get(name[:-2], '')}{name[-2:]}"
        low, high = regions.get(owner, (0, -1))
        if first > last or not (low <= first and last <= high):
            document.fault(("sub_regions", name), f"a range inside {owner}, {low}..{high}", f"{first}..{last}")


def _check_cover(document: Document, ranges: dict[str, _Ends], vertex_count: int) -> None:
    due = 0
    for name, (first, last) in sorted(ranges.items(), key=lambda item: item[1]):
        if first < due:
            document.fault(("regions", name), f"to start at vertex {due}: no overlap", f"{first}")
        elif first > due:
            document.fault(("regions", name), f"to start at vertex {due}: no gap", f"{first}")
        if last < first:
            document.fault(("regions", name), f"a last vertex of at least {first}", f"{last}")
        due = max(due, last + 1)
    if due != vertex_count:
        document.fault(("regions",), f"ranges up to vertex {vertex_count - 1}", f"up to {due - 1}")
