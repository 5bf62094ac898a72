"""``rules/gestures.yaml``: gestures by name, and those that a user adds."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from agentface.cache import prepared, stamp_of
from agentface.config import Document, Table
from agentface.errors import did_you_mean
from agentface.motion.gestures.gesture import GestureForm, Track
from agentface.parameters import NAMES, PARAMETERS, indices_of, parameter_names
from agentface.resources import rules_file, user_rules_file

FILE = "gestures.yaml"
SHORTEST_S = 0.02
"""No key comes sooner after another: faster than anything on a face."""
_DEGREES = "_deg"
_Name = Annotated[str, Field(min_length=1, max_length=64, pattern=r"^[a-z][a-z0-9_]*$")]


class Key(Table):
    """One key pose."""

    at_s: Annotated[float, Field(gt=0, le=60)]
    pose: dict[str, float]


class GestureRow(Table):
    """One gesture."""

    description: str
    keys: Annotated[list[Key], Field(min_length=2, max_length=100)]


class GesturesFile(Table):
    """The whole file."""

    gestures: dict[_Name, GestureRow]


def load_gestures(path: str | Path) -> dict[str, GestureForm]:
    """The gestures in the file at ``path`` by name; raises DataError with every fault of it."""
    document = Document(path)
    file = document.parse(GesturesFile)
    for name, row in file.gestures.items():
        _check(document, name, row)
    document.check()
    return {name: _gesture(name, row) for name, row in file.gestures.items()}


def all_gestures(path: str | Path | None = None) -> dict[str, GestureForm]:
    """Those that come with agentface, the user's own, and those in the file at ``path``; the later ones count."""
    files = [user_rules_file(FILE), *([] if path is None else [Path(path)])]
    found = dict(_shipped())
    for file in files:
        if file.exists() or file != files[0]:
            found |= load_gestures(file)
    return found


def known_as(name: str) -> str:
    """A name of a gesture as the table writes it: ``Brow Flash`` and ``brow-flash`` are ``brow_flash``."""
    return name.strip().lower().replace(" ", "_").replace("-", "_")


@cache
def _shipped() -> dict[str, GestureForm]:
    path = rules_file(FILE)
    return prepared(stamp_of([path]), "gestures", lambda: load_gestures(path))


def _check(document: Document, name: str, row: GestureRow) -> None:
    names, before = parameter_names(), 0.0
    for number, key in enumerate(row.keys):
        where = ("gestures", name, "keys", number)
        if key.at_s < before + SHORTEST_S:
            document.fault((*where, "at_s"), f"at least {before + SHORTEST_S:g}, after the key before", f"{key.at_s:g}")
        before = key.at_s
        for parameter, value in key.pose.items():
            if parameter not in names:
                document.fault((*where, "pose", parameter), "a parameter", parameter, did_you_mean(parameter, names))
                continue
            known = PARAMETERS[indices_of(parameter.removesuffix(_DEGREES))[0]]
            degrees = parameter.endswith(_DEGREES)
            if known.unit == "rad" and not degrees:
                document.fault((*where, "pose", parameter), f"{parameter}{_DEGREES}", parameter, "angles take degrees")
                continue
            low, high = known.bounds
            if not low <= value <= high:
                document.fault((*where, "pose", parameter), f"a number in {low:g}..{high:g}", f"{value:g}")
    if any(row.keys[-1].pose.values()):
        last = len(row.keys) - 1
        document.fault(("gestures", name, "keys", last, "pose"), "{}, where it ends", "another pose")


def _gesture(name: str, row: GestureRow) -> GestureForm:
    times = np.array([0.0, *(key.at_s for key in row.keys)])
    meant = sorted({index for key in row.keys for name in key.pose for index in _indices(name)})
    values = {index: np.zeros(len(times)) for index in meant}
    for number, key in enumerate(row.keys, start=1):
        for parameter, value in key.pose.items():
            for index in _indices(parameter):
                values[index][number] = math.radians(value) if parameter.endswith(_DEGREES) else value
    return GestureForm(name, row.description, tuple(Track.of(NAMES[index], times, values[index]) for index in meant))


def _indices(name: str) -> tuple[int, ...]:
    return indices_of(name.removesuffix(_DEGREES))
