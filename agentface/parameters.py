"""The registry of every animation parameter, and :class:`FacePose`, their values at one instant.

This module is the one owner of the names. A face's ``muscles.yaml`` says how each vector muscle moves
that face; the rules say how far each muscle contracts; both are checked against this list.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Literal

import numpy as np

from agentface.conventions import SIDES, Floats, check_range
from agentface.errors import InvalidValueError, UnknownNameError

Kind = Literal["vector", "pseudo", "jaw", "gaze", "head"]

_VECTOR: dict[str, str] = {
    "frontalis_medialis": "frontalis, medial fibres: raise the inner brow (AU 1)",
    "frontalis_intermedius": "frontalis, middle fibres: raise the middle of the brow (AU 1, 2)",
    "frontalis_lateralis": "frontalis, lateral fibres: raise the outer brow (AU 2)",
    "corrugator_supercilii": "draws the brow inward and down (AU 4)",
    "depressor_supercilii": "draws the inner brow down (AU 4)",
    "procerus": "draws the skin between the brows down (AU 4, 9)",
    "orbicularis_oculi_medialis": "orbicularis oculi, pars orbitalis, lower medial fibres: raise the cheek (AU 6)",
    "orbicularis_oculi_lateralis": "orbicularis oculi, pars orbitalis, lower lateral fibres: raise the cheek (AU 6)",
    "levator_labii_superioris_alaeque_nasi": "wrinkles the nose (AU 9)",
    "nasalis": "compresses the nose and wrinkles its side (AU 9)",
    "levator_labii_superioris": "raises the upper lip (AU 10)",
    "zygomaticus_minor": "draws the upper lip up and outward (AU 10, 11)",
    "zygomaticus_major": "draws the lip corner up and outward: the smile (AU 12)",
    "levator_anguli_oris": "raises the lip corner (AU 13)",
    "depressor_anguli_oris": "draws the lip corner down (AU 15)",
    "depressor_labii_inferioris": "draws the lower lip down (AU 16)",
    "mentalis": "pushes the chin and the lower lip up (AU 17)",
    "risorius": "stretches the lip corner outward (AU 20)",
    "platysma": "stretches the lip corner outward and down (AU 20)",
}
_PSEUDO: dict[str, str] = {
    "levator_palpebrae": "opens the upper lid past neutral (AU 5)",
    "orbicularis_oculi_palpebralis": "orbicularis oculi, pars palpebralis: closes the lids (AU 43, 45)",
    "orbicularis_oculi_orbitalis": "orbicularis oculi, pars orbitalis: squeezes the eye",
    "orbicularis_oculi_preseptalis": "orbicularis oculi, preseptal fibres: tightens the lower lid (AU 7)",
}
_MIDDLE: dict[str, str] = {
    "orbicularis_oris_pucker": "orbicularis oris, puckering the lips (AU 18)",
    "orbicularis_oris_press": "orbicularis oris, pressing the lips together (AU 24)",
}
MUSCLES: tuple[str, ...] = (*_VECTOR, *_PSEUDO, *_MIDDLE, "jaw_open")
"""What a rule may contract: muscles without their side, and the jaw."""
VECTOR_MUSCLES: tuple[str, ...] = tuple(f"{name}_{side}" for name in _VECTOR for side in SIDES)
"""The vector muscles with their sides, in the order of their parameters."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """One animation parameter: its place in a pose, its unit and its range."""

    name: str
    index: int
    kind: Kind
    unit: str
    low: float
    high: float
    description: str


def _build() -> tuple[Parameter, ...]:
    rows: list[tuple[str, Kind, str, float, float, str]] = []
    paired: list[tuple[dict[str, str], Kind]] = [(_VECTOR, "vector"), (_PSEUDO, "pseudo")]
    for table, kind in paired:
        rows += [(f"{name}_{side}", kind, "contraction", 0, 1, text) for name, text in table.items() for side in SIDES]
    rows += [(name, "pseudo", "contraction", 0, 1, text) for name, text in _MIDDLE.items()]
    rows.append(("jaw_open", "jaw", "of the widest opening", 0, 1, "drops the jaw (AU 26, 27)"))
    for name, limit_deg, text in (
        ("gaze_yaw", 50, "the eyes turn to the person's left"),
        ("gaze_pitch", 40, "the eyes turn upward"),
        ("head_yaw", 80, "the head turns to its left"),
        ("head_pitch", 60, "the head looks up"),
        ("head_roll", 50, "the head tilts to its left"),
    ):
        limit = float(np.float32(math.radians(limit_deg)))  # what a pose gives back at its limit, it takes again
        rows.append((name, "gaze" if name.startswith("gaze") else "head", "rad", -limit, limit, text))
    apart, together = (float(np.float32(math.radians(limit_deg))) for limit_deg in (-10, 25))
    rows.append(("gaze_vergence", "gaze", "rad", apart, together, "each eye turns inward"))
    return tuple(Parameter(row[0], index, *row[1:]) for index, row in enumerate(rows))


PARAMETERS: tuple[Parameter, ...] = _build()
NAMES: tuple[str, ...] = tuple(parameter.name for parameter in PARAMETERS)
_BY_NAME = {parameter.name: parameter for parameter in PARAMETERS}
COUNT = len(PARAMETERS)


def parameter(name: str) -> Parameter:
    """The parameter called ``name``; raises UnknownNameError."""
    try:
        return _BY_NAME[name]
    except (KeyError, TypeError):
        raise UnknownNameError("parameter", name, NAMES) from None


@cache
def indices_of(muscle: str) -> tuple[int, ...]:
    """Where a muscle stands in a pose: two indices for a paired muscle named without its side, else one.

    Raises UnknownNameError, which knows the names without side, too.
    """
    if muscle in _BY_NAME:
        return (_BY_NAME[muscle].index,)
    if f"{muscle}_l" in _BY_NAME:
        return tuple(_BY_NAME[f"{muscle}_{side}"].index for side in SIDES)
    raise UnknownNameError("muscle", muscle, (*MUSCLES, *NAMES))


class FacePose(Mapping[str, float]):
    """Every animation parameter at one instant; immutable, neutral where not said otherwise.

    ``values`` is a read-only float32 array of ``COUNT`` values in the order of ``PARAMETERS``.
    """

    __slots__ = ("values",)
    # An array instead of the method that Mapping has under this name: every frame reads it.
    values: Floats  # type: ignore[assignment]

    def __init__(self, values: Floats | None = None) -> None:
        array = np.zeros(COUNT, np.float32) if values is None else np.array(values, np.float32)
        if array.shape != (COUNT,):
            raise InvalidValueError("FacePose", f"{COUNT} values", array.shape)
        if not np.isfinite(array).all():
            raise InvalidValueError("FacePose", "finite values", array[~np.isfinite(array)][0])
        array.flags.writeable = False
        self.values = array

    @classmethod
    def of(cls, **contractions: float) -> FacePose:
        """A pose from names: ``FacePose.of(zygomaticus_major=0.8, jaw_open=0.2)``; a paired name sets both sides."""
        return cls().replace(contractions)

    def replace(self, contractions: Mapping[str, float]) -> FacePose:
        """A copy with some parameters changed; raises UnknownNameError or InvalidValueError."""
        values = self.values.copy()
        for name, value in contractions.items():
            for index in indices_of(name):
                known = PARAMETERS[index]
                values[index] = check_range(name, value, known.low, known.high)
        return FacePose(values)

    def __getitem__(self, name: str) -> float:
        return float(self.values[parameter(name).index])

    def __iter__(self) -> Iterator[str]:
        return iter(NAMES)

    def __len__(self) -> int:
        return COUNT

    def __repr__(self) -> str:
        active = ", ".join(f"{name}={value:.3g}" for name, value in self.items() if value)
        return f"FacePose.of({active})"
