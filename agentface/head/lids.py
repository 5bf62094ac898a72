"""How the lids of a face move: the hand-made numbers of ``eyelids.yaml``."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import Field, model_validator

from agentface.config import Table

_Length = Annotated[float, Field(ge=0, le=0.6)]
_Part = Annotated[float, Field(ge=0, le=1)]


class LidFade(Table):
    """How a lid takes the skin along, keeps it from the muscles, and follows the eye.

    Attributes:
        pitch: the part of the eye's pitch that it follows.
        whole, ends: distances from the edge of the lid in eye separations: a closing lid takes all skin along up to the
            first, and none beyond the second.
        lift: the same as ``ends`` for a lid that the levator or the gaze moves.
        hold: distances from the lid's edge in eye separations up to which the vector muscles have no effect, and from
            which they have their full effect.
    """

    pitch: _Part
    whole: _Length
    ends: _Length
    lift: Annotated[float, Field(gt=0, le=0.6)]
    hold: Annotated[list[_Length], Field(min_length=2, max_length=2)]

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if self.whole >= self.ends or self.hold[0] >= self.hold[1]:
            raise ValueError("whole must be below ends, and the first number of hold below the second")
        return self


class LidSphincter(Table):
    """Waters' sphincter round the eye, in eye separations.

    Attributes:
        half_axes: of its ellipse, to the temple, to the nose, and up and down.
        inward, down, up: how far it draws at most.
    """

    half_axes: Annotated[list[Annotated[float, Field(gt=0, le=1)]], Field(min_length=3, max_length=3)]
    inward: Annotated[float, Field(ge=0, le=0.3)]
    down: Annotated[float, Field(ge=0, le=0.3)]
    up: Annotated[float, Field(ge=0, le=0.3)]


class LidTightening(Table):
    """The preseptal part of pars palpebralis: the lower lid rises and straightens (AU 7).

    Attributes:
        turn_deg: about the eye's centre, in the middle of the lid.
        corners: the part of it at the corners of the eye.
        whole, ends: distances from the edge of the lid in eye separations: skin turns along whole up to the first, and
            not at all beyond the second; from there on it is lifted instead.
        half_axes: of the ellipse of skin that is lifted, to the temple, to the nose and down, in eye separations.
        lift, inward: how far at most, in eye separations; inward only on the temple's side.
    """

    turn_deg: Annotated[float, Field(ge=0, le=30)]
    corners: _Part
    whole: _Length
    ends: _Length
    half_axes: Annotated[list[Annotated[float, Field(gt=0, le=2)]], Field(min_length=3, max_length=3)]
    lift: Annotated[float, Field(ge=0, le=0.2)]
    inward: Annotated[float, Field(ge=0, le=0.2)]

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if self.whole >= self.ends:
            raise ValueError("whole must be below ends")
        return self


class LidSlant(Table):
    """The upper lid follows an inner brow that rises alone: up in its inner part, down in its outer part."""

    inner_deg: Annotated[float, Field(ge=0, le=20)]
    outer_deg: Annotated[float, Field(ge=0, le=20)]


class LidMotion(Table):
    """How the lids move.

    Attributes:
        edge_ring: the ring that is the lids' outer edge: where they meet.
        meeting: where closing lids meet, from the lower edge up, as a part of the opening.
        squeezed_meeting: the same for an eye that is squeezed.
        corner_sink: how far the outer corner of the eye sinks when it closes, in eye separations.
        widest: how high above the eye's centre the levator raises the middle of the upper lid's edge, in radii of the
            eye: past the iris on every face, however low its lids hang.
        sphere: the least distance of the lids' skin from the eye's centre, in radii of the eye.
        upper, lower: how each lid takes its surroundings along.
        sphincter: pars orbitalis.
        tightening: the lower lid's own muscle.
        slant: what the inner brow does to the upper lid.
    """

    edge_ring: Annotated[int, Field(ge=0)]
    meeting: _Part
    squeezed_meeting: _Part
    corner_sink: Annotated[float, Field(ge=0, le=0.1)]
    widest: Annotated[float, Field(ge=0, le=0.8)]
    sphere: Annotated[float, Field(ge=1, le=1.3)]
    upper: LidFade
    lower: LidFade
    sphincter: LidSphincter
    tightening: LidTightening
    slant: LidSlant
