"""``orbicularis_oris`` of ``lips.yaml``: how the ring muscle of the mouth moves the lips' control points."""

from __future__ import annotations

from typing import Annotated, Generic, TypeVar

import numpy as np
from pydantic import Field

from agentface.config import Table
from agentface.conventions import Doubles

_Number = TypeVar("_Number", bound=float)
_Turn = Annotated[float, Field(ge=-90, le=90)]
_Way = Annotated[float, Field(ge=-1, le=1)]
_Reach = Annotated[float, Field(ge=0.01, le=2)]
_Share = Annotated[float, Field(ge=0, le=1)]
_Shares = Annotated[list[_Share], Field(min_length=6, max_length=6)]


class ReachRoundMouth(Table):
    """A distance in the middle of the upper lip, in the middle of the lower lip and at the corners."""

    upper: _Reach
    lower: _Reach
    corner: _Reach

    def at(self, turn: Doubles) -> Doubles:
        """The distance at the angles ``turn`` (0 at the left corner, a quarter turn in the upper lip's middle)."""
        return _blend(turn, np.array(self.upper), np.array(self.lower), np.array(self.corner))


class RowsRoundMouth(Table, Generic[_Number]):
    """As :class:`ReachRoundMouth`, with a number for each row of control points, from inside the mouth outward."""

    upper: Annotated[list[_Number], Field(min_length=6, max_length=6)]
    lower: Annotated[list[_Number], Field(min_length=6, max_length=6)]
    corner: Annotated[list[_Number], Field(min_length=6, max_length=6)]

    def at(self, turn: Doubles) -> Doubles:
        """``(N, 6)``: the numbers at the angles ``turn (N,)``."""
        upper, lower, corner = (np.array(rows) for rows in (self.upper, self.lower, self.corner))
        return _blend(turn[:, None], upper, lower, corner)


class TurnsRoundMouth(RowsRoundMouth[_Turn]):
    """Degrees."""


class WaysRoundMouth(RowsRoundMouth[_Way]):
    """Eye separations."""


class MouthEllipse(Table):
    """The ellipse to which the control points are drawn.

    Attributes:
        width: of the mouth's own width.
        height: its half height, in eye separations.
        thickness: how far the rows stay apart, of their distance at rest.
        pull: how far each row goes there.
    """

    width: Annotated[float, Field(gt=0, le=2)]
    height: Annotated[float, Field(ge=0, le=1)]
    thickness: Annotated[float, Field(ge=0, le=2)]
    pull: _Shares


class LipContraction(Table):
    """One way in which orbicularis oris contracts, at its strongest.

    Attributes:
        ellipse: where the control points are drawn to, in the frontal plane.
        rotation_deg: turns the lips' profile outward about the lip line.
        extrusion: forward, in eye separations.
    """

    ellipse: MouthEllipse
    rotation_deg: TurnsRoundMouth
    extrusion: WaysRoundMouth


class OrbicularisOrisTable(Table):
    """The contractions, and how far they reach.

    Attributes:
        reach: how far beyond the lips' surface the skin follows, in eye separations.
        roll_from: the press above which the lips also roll in.
        pucker, press, roll: the contractions.
    """

    reach: ReachRoundMouth
    roll_from: Annotated[float, Field(ge=0, lt=1)]
    pucker: LipContraction
    press: LipContraction
    roll: LipContraction


class LipsMotion(Table):
    """The part of ``lips.yaml`` that is made by hand."""

    orbicularis_oris: OrbicularisOrisTable


def _blend(turn: Doubles, upper: Doubles, lower: Doubles, corner: Doubles) -> Doubles:
    sine = np.sin(turn)
    middle = sine * sine
    return np.asarray(corner * (1.0 - middle) + np.where(sine > 0, upper, lower) * middle)
