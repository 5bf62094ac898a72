"""How the lower teeth and the tongue go with the jaw: forward or aside first, then turned about its hinge."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.deform.morphs import JawSlides, jaw_slide, jaw_slides
from agentface.head.model import HeadModel
from agentface.parameters import indices_of


class TeethTables(NamedTuple):
    """How the bone moves.

    Attributes:
        hinge: ``(2,)`` float32 m, y and z of the axis.
        widest: rad, the turn of the whole opening.
        parameter: where ``jaw_open`` stands in a pose.
        slides: how far it goes forward and aside.
    """

    hinge: Floats
    widest: float
    parameter: int
    slides: JawSlides


def prepare(model: HeadModel) -> TeethTables:
    """The tables of a face."""
    hinge = np.array(model.jaw.pivot[1:], np.float32)
    return TeethTables(hinge, math.radians(model.jaw.widest_deg), indices_of("jaw_open")[0], jaw_slides(model))


def apply(tables: TeethTables, values: Floats, out: Floats) -> None:
    """Write the movement at the pose ``values`` into ``out (4, 4)``."""
    angle = tables.widest * float(values[tables.parameter])
    cosine, sine = math.cos(angle), math.sin(angle)
    rotation: Doubles = np.array([[cosine, -sine], [sine, cosine]])
    ahead, aside = jaw_slide(tables.slides, values)
    out[:] = np.eye(4)
    out[1:3, 1:3] = rotation
    out[0, 3] = aside
    out[1:3, 3] = tables.hinge + rotation @ ([0.0, ahead] - tables.hinge)
