"""The part of ``rules/visemes.yaml`` that says how visemes flow into each other, as its models."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from pydantic import Field

from agentface.config import Document, Table

JAW = "jaw_open"
_Seconds = Annotated[float, Field(ge=0, le=2)]
_Ramp = Annotated[float, Field(gt=0, le=2)]
_Share = Annotated[float, Field(ge=0, le=1)]
_Factor = Annotated[float, Field(gt=0, le=10)]
Dominance = Annotated[list[Annotated[float, Field(ge=0, le=200)]], Field(min_length=2, max_length=3)]
"""Strength, and speed before and after, 1/s; or one speed for both."""


class RateRow(Table):
    """What the rate of speech changes."""

    normal_s: _Ramp
    least: _Factor
    most: _Factor
    jaw_power: Annotated[float, Field(ge=-2, le=2)]
    jaw_least: _Factor
    jaw_most: _Factor
    contact_power: Annotated[float, Field(ge=-2, le=0)]


class ContactRow(Table):
    """From when to when of a sound a contact is whole, and how it comes and goes."""

    begins: _Share
    ends: _Share
    part_s: _Seconds
    least_s: _Seconds
    before_s: _Ramp
    after_s: _Ramp


class SpeakingRow(Table):
    """How the muscles' yielding comes before the first sound, and goes after the last."""

    before_s: _Ramp
    after_s: _Ramp


class CoarticulationRow(Table):
    """All that is true of every viseme."""

    articulators: dict[str, list[str]]
    middle: Annotated[float, Field(ge=0, le=0.5)]
    edge_s: _Seconds
    round_s: _Ramp
    rate: RateRow
    loudness: dict[str, _Share]
    contacts: dict[str, ContactRow]
    jaw_ramp_s: _Ramp
    speaking: SpeakingRow

    def check(self, document: Document, parameters: tuple[str, ...]) -> None:
        """Remember the faults that need more than one value; ``parameters``: the names that there are."""
        seen: set[str] = set(self.contacts)
        for name in self.contacts:
            if name not in parameters:
                document.fault(("coarticulation", "contacts", name), "a parameter", name)
        for articulator, names in self.articulators.items():
            for place, name in enumerate(names):
                where = ("coarticulation", "articulators", articulator, place)
                if name not in parameters:
                    document.fault(where, "a parameter without side", name)
                elif name in seen:
                    document.fault(where, "each parameter once", name)
                seen.add(name)
        if JAW not in seen:
            document.fault(("coarticulation", "articulators"), f"an articulator with {JAW}", "none")
        for articulator in self.loudness:
            if articulator not in self.articulators:
                document.fault(("coarticulation", "loudness", articulator), "an articulator", articulator)

    def check_viseme(
        self,
        document: Document,
        where: tuple[str | int, ...],
        parameters: Mapping[str, float],
        dominance: Mapping[str, Dominance],
    ) -> None:
        """Remember what of a viseme's parameters and dominance no articulator, or none of the viseme's, has."""
        moved = {name for names in self.articulators.values() for name in names} | self.contacts.keys()
        for name in parameters:
            if name not in moved:
                document.fault((*where, "parameters", name), "a parameter of an articulator", name)
        for name in dominance:
            if name not in self.articulators:
                document.fault((*where, "dominance", name), "an articulator", name)
        for name in self.articulators:
            if name not in dominance:
                document.fault((*where, "dominance"), f"that of the {name}", "none")
