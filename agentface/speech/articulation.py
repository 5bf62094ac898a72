""":class:`Articulation`: the table of visemes as arrays, and :class:`Timeline`, phones laid out on them."""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from agentface.cache import prepared, stamp_of
from agentface.conventions import Doubles, Indices
from agentface.resources import rules_file
from agentface.speech.alphabets import Part
from agentface.speech.articulators import JAW
from agentface.speech.visemes import VisemeTable, viseme_table


class Ramps(NamedTuple):
    """What does not depend on the phones, for P parameters of which the last C are contacts, and A articulators.

    Attributes:
        articulator: ``(P - C,)`` int32, which articulator moves each parameter.
        jaw_s: s, over so long a limit of the jaw does.
        speaking: ``(2,)`` s, over so long speaking does.
        round_s: s, how round the tip of a dominance is.
    """

    articulator: Indices
    jaw_s: float
    speaking: Doubles
    round_s: float


class Timeline(NamedTuple):
    """S segments in the order of time; P, C and A as in :class:`Ramps`; times in s.

    Attributes:
        spans: ``(S, 2)``, from when to when.
        middles: ``(S, 2)``, the middle, and how far on either side the middle part goes.
        targets: ``(S, P)``, what each parameter would be if nothing stood beside it.
        dominance: ``(S, A, 3)``: strength, and speed before and after, 1/s.
        held: ``(S, C, 4)``, from when to when a contact is whole, and over how long it comes and goes.
        tight: ``(S,)``, how tightly the jaw is held: at ``log(1 + 1 / x)`` it opens no farther than x.
        kept: ``(S, 2)``, from when to when.
        said: ``(S,)`` 0 or 1, whether it is anything but silence.
    """

    spans: Doubles
    middles: Doubles
    targets: Doubles
    dominance: Doubles
    held: Doubles
    tight: Doubles
    kept: Doubles
    said: Doubles


class Articulation:
    """The visemes by arrays.

    Attributes:
        rules: what holds for all visemes.
        names: the P parameters without side that visemes move, contacts last.
        contacts: the C of them that are contacts.
        articulators: the A articulators.
        ramps: what the sampling needs beside a timeline.
        jaw: the place of the jaw's opening in ``names``.
    """

    def __init__(self, table: VisemeTable) -> None:
        self._table, self.rules = table, table.coarticulation
        self.articulators = tuple(self.rules.articulators)
        moved = [(name, row) for row, names in enumerate(self.rules.articulators.values()) for name in names]
        self.contacts = tuple(self.rules.contacts)
        self.names = (*(name for name, _ in moved), *self.contacts)
        self.jaw = self.names.index(JAW)
        self.ramps = Ramps(
            np.array([row for _, row in moved], np.int32),
            self.rules.jaw_ramp_s,
            np.array([self.rules.speaking.before_s, self.rules.speaking.after_s]),
            self.rules.round_s,
        )
        self._poses = {name: np.array([v.shares.get(n, 0.0) for n in self.names]) for name, v in table.items()}

    @property
    def visemes(self) -> tuple[str, ...]:
        """The names of the visemes."""
        return tuple(self._table)

    @property
    def size(self) -> int:
        """How many numbers a sample has: P parameters, how tightly the jaw is held, and how much is spoken."""
        return len(self.names) + 2

    def target(self, part: Part) -> Doubles:
        """``(P,)``: the mixture that a part of a sound shows."""
        mixed = sum(share * self._poses[name] for name, share in part.visemes)
        return np.clip(np.asarray(mixed, np.float64), -1.0, 1.0)

    def dominance(self, part: Part) -> Doubles:
        """``(A, 3)``: that of the part's main viseme."""
        rows = np.array([self._table[part.visemes[0][0]].dominance[name] for name in self.articulators])
        rows[:, 0] *= part.dominance
        return rows

    def early_s(self, part: Part) -> float:
        """So much before the part's middle it is shown most."""
        return self._table[part.visemes[0][0]].early_s

    def tight(self, part: Part) -> float:
        """How tightly the jaw is held, 0 for not at all: at ``log(1 + 1 / x)`` it opens no farther than x."""
        most = self._table[part.visemes[0][0]].jaw_most
        return 0.0 if most >= 1.0 else math.log1p(1.0 / most)


@cache
def default_articulation() -> Articulation:
    """That of the visemes that come with agentface, made once."""
    return prepared(stamp_of([rules_file("visemes.yaml")]), "articulation", lambda: Articulation(viseme_table()))
