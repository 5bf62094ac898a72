"""The six emotions, the names people use for them, and :class:`EmotionState`, their intensities at one instant."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from agentface.conventions import Doubles, check_fraction
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.named_array import NamedArray

EMOTIONS: tuple[str, ...] = ("happiness", "sadness", "anger", "fear", "disgust", "surprise")
"""The big six of the W3C vocabularies for EmotionML, in the order of ``EmotionState.array``."""

_ALIASES: dict[str, tuple[str, ...]] = {
    "happiness": ("happy", "joy", "joyful", "smile"),
    "sadness": ("sad", "sorrow", "unhappy"),
    "anger": ("angry", "rage"),
    "fear": ("afraid", "fearful", "scared"),
    "disgust": ("disgusted",),
    "surprise": ("surprised", "astonished"),
}
ALIASES: dict[str, str] = {alias: emotion for emotion, names in _ALIASES.items() for alias in names}
"""Other words for an emotion, and the emotion they mean."""
NEUTRAL = "neutral"
"""What lets go of the emotions, wherever one is named: at ``v`` it leaves each of the others at most ``1 - v``."""


def canonical(name: object) -> str:
    """The emotion that ``name`` means, whatever its case; raises UnknownNameError."""
    emotion = _plain(name)
    if emotion not in EMOTIONS:
        raise UnknownNameError("emotion", name, (*EMOTIONS, *ALIASES))
    return emotion


def canonical_or_neutral(name: object) -> str:
    """As :func:`canonical`; also knows ``neutral``."""
    emotion = _plain(name)
    if emotion not in (*EMOTIONS, NEUTRAL):
        raise UnknownNameError("emotion", name, (*EMOTIONS, NEUTRAL, *ALIASES))
    return emotion


def _plain(name: object) -> str:
    word = name.strip().lower() if isinstance(name, str) else ""
    return ALIASES.get(word, word)


class EmotionState(NamedArray):
    """Six intensities in 0..1, immutable; a mapping from the name of an emotion to its intensity.

    ``array`` is a read-only float64 array of six in the order of ``EMOTIONS``.
    """

    __slots__ = ()
    array: Doubles

    def __init__(self, array: Any = None) -> None:
        given = np.zeros(len(EMOTIONS)) if array is None else np.asarray(array)
        if given.shape != (len(EMOTIONS),):
            raise InvalidValueError("EmotionState", f"{len(EMOTIONS)} intensities", given.shape)
        self._freeze(
            np.array([check_fraction(name, value) for name, value in zip(EMOTIONS, given.tolist(), strict=True)])
        )

    @classmethod
    def of(cls, intensities: Mapping[str, float] | None = None, /, **named: float) -> EmotionState:
        """A state from names: ``EmotionState.of({"joy": 0.6})`` or ``EmotionState.of(joy=0.6)``; the rest are 0.

        ``neutral`` may be among them: it leaves each emotion at most 1 minus its intensity.

        Raises UnknownNameError for a name, InvalidValueError for a value outside 0..1 or an emotion named twice.
        """
        if isinstance(intensities, EmotionState) and not named:
            return intensities
        if not isinstance(intensities, Mapping | None):
            raise InvalidValueError("EmotionState.of", "a mapping from emotions to intensities", intensities)
        values: dict[str, float] = {}
        for name, value in (*(intensities or {}).items(), *named.items()):
            emotion = canonical_or_neutral(name)
            if emotion in values:
                raise InvalidValueError(emotion, "each emotion once", name, "two of the names mean the same emotion")
            values[emotion] = check_fraction(emotion, value)
        most = 1.0 - values.pop(NEUTRAL, 0.0)
        return cls([min(values.get(emotion, 0.0), most) for emotion in EMOTIONS])

    def as_dict(self) -> dict[str, float]:
        """All six intensities by name."""
        return dict(zip(EMOTIONS, self.array.tolist(), strict=True))

    def __getitem__(self, name: str) -> float:
        return float(self.array[EMOTIONS.index(canonical(name))])

    def __iter__(self) -> Iterator[str]:
        return iter(EMOTIONS)

    def __repr__(self) -> str:
        active = ", ".join(f"{name}={value:.3g}" for name, value in self.as_dict().items() if value)
        return f"EmotionState.of({active})"
