"""The rule base: every rule of every mode, from the two rule files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from agentface.emotion.selector import MODES
from agentface.emotion.sets import CONTRACTION_SETS
from agentface.emotion.state import EMOTIONS
from agentface.emotion.tables import REST, STRONGER, BlendsFile, Contribution, load_blends, load_emotions, pair_of
from agentface.errors import DataError, Fault
from agentface.parameters import MUSCLES
from agentface.resources import data_folder

_Row = npt.NDArray[np.int8]
_Rows = Mapping[str, _Row]
_AT_REST: _Row = np.zeros(5, np.int8)


@dataclass(frozen=True, slots=True)
class Mode:
    """The rules of one expression mode: a single expression or a blend of two.

    ``emotions`` are one or two; ``consequents`` give each muscle the index of a contraction set for every
    intensity set of the one emotion, ``(5,)``, or of the first and the second, ``(5, 5)``.
    """

    emotions: tuple[str, ...]
    description: str
    source: str
    consequents: Mapping[str, _Row]

    @property
    def name(self) -> str:
        """``fear`` or ``sadness+fear``."""
        return "+".join(self.emotions)


@dataclass(frozen=True, slots=True)
class RuleBase:
    """All modes in the order of ``selector.MODES``, and the selector's gap."""

    modes: tuple[Mode, ...]
    gap: float

    @classmethod
    def load(cls, folder: str | Path | None = None) -> RuleBase:
        """The rules in ``folder`` or, by default, those that come with agentface.

        Raises DataError with every fault of ``emotions.yaml`` and ``blends.yaml``.
        """
        place = data_folder("rules") if folder is None else Path(folder)
        faults: list[Fault] = []
        emotions, blends = None, None
        try:
            emotions = load_emotions(place / "emotions.yaml").emotions
        except DataError as error:
            faults += error.faults
        try:
            blends = load_blends(place / "blends.yaml")
        except DataError as error:
            faults += error.faults
        if emotions is None or blends is None:
            raise DataError(faults)
        tables = {emotion: getattr(emotions, emotion) for emotion in EMOTIONS}
        rows = {
            emotion: {muscle: _numbers(row) for muscle, row in table.muscles.items()}
            for emotion, table in tables.items()
        }
        single = [Mode((emotion,), table.description, table.source, rows[emotion]) for emotion, table in tables.items()]
        return cls((*single, *_blends(blends, rows)), blends.selector.gap)

    def mode(self, emotions: tuple[str, ...]) -> Mode:
        """The mode of one emotion, or of two in the order of ``EMOTIONS``."""
        return self.modes[MODES.index(emotions)]


def _numbers(row: list[str]) -> _Row:
    return np.array([CONTRACTION_SETS.index(name) for name in row], np.int8)


def _blends(file: BlendsFile, rows: Mapping[str, _Rows]) -> list[Mode]:
    part_of = {muscle: part for part, muscles in file.groups for muscle in muscles}
    blends = {pair_of(name): blend for name, blend in file.blends.items()}
    modes = []
    for pair in MODES[len(EMOTIONS) :]:
        blend = blends[pair]
        consequents = {}
        for muscle in MUSCLES:
            given = blend.exceptions.get(muscle, getattr(blend, part_of[muscle]))
            rules = _consequents(given, pair, [rows[emotion].get(muscle, _AT_REST) for emotion in pair])
            if rules.any():
                consequents[muscle] = rules
        modes.append(Mode(pair, blend.description, blend.source, consequents))
    return modes


def _consequents(given: Contribution, pair: tuple[str, ...], rows: list[_Row]) -> _Row:
    first, second = np.broadcast_arrays(rows[0][:, None], rows[1][None, :])
    followed = {pair[0]: first, pair[1]: second, STRONGER: np.maximum(first, second), REST: np.zeros_like(first)}
    consequents: _Row = np.minimum(followed[given.donor], np.int8(CONTRACTION_SETS.index(given.at_most)))
    return consequents
