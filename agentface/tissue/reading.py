"""Reads ``tissue.yaml`` and tells all its faults at once: also unknown names, and numbers that do not fit together."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from agentface.config import Document
from agentface.errors import DataError, Fault, did_you_mean
from agentface.head.landmarks import LANDMARKS, PAIRED_LANDMARKS
from agentface.head.regions import HALF_REGIONS, SUB_REGIONS
from agentface.parameters import MUSCLES
from agentface.resources import data_folder
from agentface.tissue.tissue_file import LARGEST_RHO, SHALLOWEST_MM, TISSUE_FILE, TISSUE_MUSCLES, TissueFile

_Where = tuple[str, ...]
_Known = tuple[str, ...]
_ANYWHERE = (*LANDMARKS, *PAIRED_LANDMARKS)
_ON_THE_SKIN = tuple(name for name in _ANYWHERE if name != "pupil")
_MOVABLE = (*HALF_REGIONS, *SUB_REGIONS)
_BEYOND = 1e9
_LANDMARK, _REGION = "a landmark (paired ones without side)", "a region without side"


def anatomy_file() -> Path:
    """The anatomist's table, which every face's begins with."""
    return data_folder("regions") / TISSUE_FILE


def tissue_of(folder: str | Path) -> TissueFile:
    """The table of a face's folder; raises DataError with all faults, or that there is none and how to make one."""
    path = Path(folder) / TISSUE_FILE
    if not path.is_file():
        hint = f"`agentface calibrate {folder} --deformer tissue` makes one; or copy {anatomy_file()}"
        raise DataError([Fault(path, None, "", "this file, for the tissue deformer", "none", hint)])
    return read_tissue(path)


def read_tissue(path: str | Path) -> TissueFile:
    """The checked table; raises DataError with all faults."""
    document = Document(path)
    file = document.collect(TissueFile)
    data = _table(document.data)
    lattice, skull, muscles = (_table(data.get(key)) for key in ("lattice", "skull", "muscles"))
    _check_names(document, ("depth_mm",), data.get("depth_mm"), _LANDMARK, _ON_THE_SKIN)
    _check_names(document, ("lattice", "regions"), lattice.get("regions"), _REGION, _MOVABLE)
    paired = tuple(name for name in PAIRED_LANDMARKS if name != "pupil")
    _check_names(document, ("lattice", "carried_mm"), lattice.get("carried_mm"), "a paired landmark, no side", paired)
    _check_names(document, ("skull", "holds"), skull.get("holds"), _LANDMARK, _ON_THE_SKIN)
    _check_thickness(document, lattice, _table(data.get("depth_mm")))
    _check_rho(document, _table(data.get("volume")))
    if "muscles" in data:
        _check_muscles(document, muscles)
    document.check()
    assert file is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    return file


def _check_names(document: Document, where: _Where, names: Any, what: str, known: _Known) -> None:
    """Faults for the unknown keys of a table, or items of a list."""
    for place, name in enumerate(names if isinstance(names, (dict, list)) else ()):
        if isinstance(name, str) and name not in known:
            key = name if isinstance(names, dict) else place
            document.fault((*where, key), what, name, did_you_mean(name, known))


def _check_thickness(document: Document, lattice: dict[str, Any], depths: dict[str, Any]) -> None:
    """No layer is under the bone: neither by its part of the depth nor by the least thickness."""
    part = _number(lattice.get("thickness"))
    for region, value in _table(lattice.get("regions")).items():
        times = _number(value)
        if part is not None and times is not None and 0.0 < part <= 1.0 < part * times:
            told = f"at most {1.0 / part:.3g}: {part:g} of the depth, that many times, reaches the bone"
            document.fault(("lattice", "regions", region), told, f"{times:g}")
    bounds = lattice.get("thickness_mm")
    if not (isinstance(bounds, list) and len(bounds) == 2):
        return
    least, most = map(_number, bounds)
    if least is not None and most is not None and least >= most:
        document.fault(("lattice", "thickness_mm"), "the least thickness, then a larger one", f"{least:g}, {most:g}")
    known = {name: depth for name, value in depths.items() if (depth := _number(value) or 0.0) >= SHALLOWEST_MM}
    shallow = min(known, key=lambda name: known[name], default=None)
    if least is not None and shallow is not None and least > known[shallow]:
        told = f"at most {known[shallow]:g}, the depth at {shallow}"
        document.fault(("lattice", "thickness_mm", 0), told, f"{least:g}")


def _check_rho(document: Document, volume: dict[str, Any]) -> None:
    form, rho = volume.get("form"), _number(volume.get("rho"))
    if isinstance(form, str) and form in LARGEST_RHO and rho is not None and rho > LARGEST_RHO[form]:
        told = f"at most {LARGEST_RHO[form]:g}: with the form {form}, more diverges"
        document.fault(("volume", "rho"), told, f"{rho:g}")


def _check_muscles(document: Document, muscles: dict[str, Any]) -> None:
    for name in sorted(set(TISSUE_MUSCLES) - muscles.keys()):
        document.fault(("muscles",), f"an entry for {name}", "none")
    _check_names(document, ("muscles",), muscles, "a muscle of the tissue, without side", TISSUE_MUSCLES)
    for name, row in muscles.items():
        _check_row(document, ("muscles", name), _table(row))


def _check_row(document: Document, where: _Where, row: dict[str, Any]) -> None:
    _check_names(document, (*where, "moved_by"), row.get("moved_by"), "a muscle without side, or jaw_open", MUSCLES)
    for key in ("origin", "insertion", "centre", "belly"):
        at = _table(row.get(key)).get("at")
        if isinstance(at, str) and at not in _ANYWHERE:
            document.fault((*where, key, "at"), _LANDMARK, at, did_you_mean(at, _ANYWHERE))
    for key in ("regions", "not_regions"):
        _check_names(document, (*where, key), row.get(key), _REGION, _MOVABLE)
    for low, high in (("fall_near", "fall_start"), ("fall_start", "fall_finish")):
        one, other = _number(row.get(low)), _number(row.get(high))
        if one is not None and other is not None and one >= other:
            document.fault((*where, high), f"more than {low}, {one:g}", f"{other:g}")


def _table(value: Any) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}


def _number(value: Any) -> float | None:
    """A number that can be compared; what is none, or beyond all bounds, is told by the schema."""
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return float(value) if number and abs(value) < _BEYOND else None
