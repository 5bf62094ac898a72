"""The skull nudged by hand (Zhang, Prakash and Sung, section 3.2): where it then lies, and how a file is told."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import yaml

from agentface.conventions import Doubles
from agentface.tissue.lattice import PERIOSTEUM_MM, Lattice
from agentface.tissue.layers import EPIDERMIS, HYPODERMIS
from agentface.tissue.tissue_file import SkullTable

NUDGES: dict[str, tuple[float, float, float]] = {
    "rotate_deg": (-10.0, 10.0, 0.0),
    "translate_mm": (-10.0, 10.0, 0.0),
    "scale": (0.9, 1.1, 1.0),
}
"""What a hand moves the skull by, along x, y and z each: the least, the most, and where it was fitted."""
_DIGITS = 3
_TOUCHING_MM = 1e-3


class Nearness(NamedTuple):
    """How near the bone comes to the tissue that moves.

    Attributes:
        room: ``(V,)`` mm from the hypodermis down to where contact begins; infinite where no tissue moves.
        outside: ``(V,)`` mm that the bone stands out of the skin at rest, 0 where it does not.
    """

    room: Doubles
    outside: Doubles

    @property
    def least_mm(self) -> float:
        """The least room; 0 where the tissue lies on the bone, a little less where it is pressed against it."""
        return float(self.room.min())

    @property
    def resting(self) -> int:
        """How many nodes lie on the bone."""
        return int((self.room <= _TOUCHING_MM).sum())

    @property
    def outside_mm(self) -> float:
        """How far the bone stands out of the skin where it does most."""
        return float(self.outside.max())


def nearness(lattice: Lattice, bone: Doubles, hypodermis: Doubles) -> Nearness:
    """How near ``bone (V, 3)`` mm comes to ``hypodermis (V, 3)`` mm, as the forces of contact reckon it."""
    rest, normals = lattice.rest, lattice.normals
    gap = np.maximum(_along(rest[HYPODERMIS] - bone, normals) - PERIOSTEUM_MM, 0.0)
    room = np.where(lattice.free, gap + _along(hypodermis - rest[HYPODERMIS], normals), np.inf)
    out = np.maximum(_along(bone - rest[EPIDERMIS], normals), 0.0)
    return Nearness(room, np.where(lattice.free, out, 0.0))


def nudged(table: SkullTable, key: str, axis: int, value: float) -> SkullTable:
    """``table`` with one number of ``NUDGES`` changed, forced into its range."""
    low, high, _ = NUDGES[key]
    numbers = list(getattr(table, key))
    numbers[axis] = round(min(max(value, low), high), _DIGITS) + 0.0  # no -0.0
    return table.model_copy(update={key: numbers})


def as_fitted(table: SkullTable) -> SkullTable:
    """``table`` with nothing nudged."""
    return table.model_copy(update={key: [rest] * 3 for key, (_, _, rest) in NUDGES.items()})


def rewritten(text: str, table: SkullTable) -> str:
    """The text of a valid ``tissue.yaml`` with the numbers of ``NUDGES`` as ``table`` has them, and else as it is."""
    root: Any = yaml.compose(text, yaml.SafeLoader)
    skull = next(value for key, value in root.value if key.value == "skull")
    there = {key.value: value for key, value in skull.value}
    changes: list[tuple[int, int, str]] = []
    missing = []
    for key, (_, _, rest) in NUDGES.items():
        numbers = getattr(table, key)
        if key in there:
            # one by one: so it does not matter how the list is written, and what is said beside its items stays
            for item, number in zip(there[key].value, numbers, strict=True):
                if not _says(item.value, number):
                    changes.append((item.start_mark.index, item.end_mark.index, repr(number)))
        elif numbers != [rest] * 3:
            missing.append(f"{key}: {numbers}")
    if missing:
        first = skull.value[0][0].start_mark
        newline = "\r\n" if "\r\n" in text else "\n"
        end = ", " if skull.flow_style else newline + " " * first.column
        changes.append((first.index, first.index, "".join(line + end for line in missing)))
    for start, stop, new in sorted(changes, reverse=True):
        text = text[:start] + new + text[stop:]
    return text


def _says(text: str, number: float) -> bool:
    try:
        return float(text) == number
    except ValueError:  # 0x1: YAML has numbers that Python writes otherwise
        return False


def _along(ways: Doubles, normals: Doubles) -> Doubles:
    return np.asarray((ways * normals).sum(axis=1))
