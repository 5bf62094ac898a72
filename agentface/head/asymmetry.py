"""``asymmetry.yaml`` and the shape of the same name: how a face differs from its mirror image.

The bones differ by one sparse shape, which is added when a face is loaded; its eyes, teeth and tongue go along. The
muscles differ by gains: the part of what a rule asks for that a side makes.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from agentface.config import Document, Table
from agentface.conventions import SIDES, Floats
from agentface.errors import did_you_mean
from agentface.head.ring_names import LidRing, LipRing
from agentface.head.rings import EyelidsFile, LipsFile, RingHalves
from agentface.parameters import COUNT, MUSCLES, NAMES, indices_of

SHAPE = "asymmetry"
"""The name of the morph target of the skin."""
_SIDED = tuple(name for name in NAMES if name not in MUSCLES and name[:-2] in MUSCLES)


class AsymmetryFile(Table):
    """``asymmetry.yaml``: by muscle and side, the part of a contraction that it makes."""

    gains: dict[str, Annotated[float, Field(ge=0.5, le=1)]]


def read_asymmetry(path: str | Path) -> AsymmetryFile:
    """The checked table; raises DataError naming unknown muscles."""
    document = Document(path)
    file = document.collect(AsymmetryFile)
    gains = document.data.get("gains") if isinstance(document.data, dict) else None
    for name in gains if isinstance(gains, dict) else ():
        if name not in _SIDED:
            hint = did_you_mean(str(name), _SIDED)
            document.fault(("gains", name), "a muscle with its side", str(name), hint)
    document.check()
    assert file is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    return file


def gains_of(file: AsymmetryFile, strength: float) -> Floats:
    """``(COUNT,)`` float32: what each parameter is multiplied by; all 1 at ``strength`` 0."""
    gains = np.ones(COUNT, np.float32)
    for name, gain in file.gains.items():
        gains[list(indices_of(name))] = 1.0 + strength * (gain - 1.0)
    return gains


def part_moves(moves: Floats, lips: LipsFile, eyelids: EyelidsFile) -> dict[str, Floats]:
    """How far each part goes along with the skin's ``moves (V, 3)`` m: ``(3,)`` m by the names of the parts.

    An eye goes with the margins of its lids, teeth and tongue with the lips.
    """
    mouth = _mean(moves, lips.rings[LipRing.CONTACT])
    eyes = {f"eye_{side}": _mean(moves, eyelids.rings[side][LidRing.INNER_MARGIN]) for side in SIDES}
    return {**dict.fromkeys(("teeth_upper", "teeth_lower", "tongue"), mouth), **eyes}


def _mean(moves: Floats, ring: RingHalves) -> Floats:
    return np.asarray(moves[ring.upper + ring.lower[1:-1]].mean(axis=0), np.float32)
