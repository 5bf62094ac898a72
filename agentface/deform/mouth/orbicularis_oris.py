"""Orbicularis oris at full contraction: rotation, ellipse and extrusion (Bui et al., section 3.2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles
from agentface.head.model import HeadModel
from agentface.head.orbicularis_oris import LipContraction


@dataclass(frozen=True, slots=True)
class Contraction:
    """What a full contraction does to the control points: the arrays of :class:`.lips.LipTables`."""

    shift: Doubles
    target: Doubles
    pull: Doubles


@dataclass(frozen=True, slots=True)
class MouthFrame:
    """The lips at rest as orbicularis oris sees them.

    Attributes:
        turn: ``(K,)`` rad, the angle of each column of control points; 0 at the left corner.
        line: ``(K, 3)`` m, where the lip line passes the column.
        outward: ``(K, 3)`` unit, away from the mouth's middle along the face.
        forward: ``(K, 3)`` unit, out of the face, level.
    """

    turn: Doubles
    line: Doubles
    outward: Doubles
    forward: Doubles


def contractions(model: HeadModel, control: Doubles, line: Doubles) -> list[Contraction]:
    """Pucker, press and roll for the control points ``(24 * 6, 3)`` m, with the lip ``line (24, 3)`` m."""
    frame = mouth_frame(line)
    table, unit = model.lips.orbicularis_oris, model.landmarks.eye_separation
    places = control.reshape(len(line), -1, 3)
    return [contraction(row, frame, places, unit) for row in (table.pucker, table.press, table.roll)]


def mouth_frame(line: Doubles) -> MouthFrame:
    """The frame of a lip ``line (K, 3)`` m that starts at the left corner and goes over the upper lip first."""
    turn = 2 * np.pi * np.arange(len(line)) / len(line)
    x, z = line[:, 0], line[:, 2]
    powers = np.stack([np.ones_like(x), x**2, x**4], axis=1)
    curve = np.linalg.lstsq(powers, z, rcond=None)[0]
    slope = 2 * curve[1] * x + 4 * curve[2] * x**3
    level = np.stack([np.ones_like(x), np.zeros_like(x), slope], axis=1) / np.hypot(1.0, slope)[:, None]
    forward = np.stack([-level[:, 2], level[:, 1], level[:, 0]], axis=1)
    outward = np.cos(turn)[:, None] * level + np.sin(turn)[:, None] * [0.0, 1.0, 0.0]
    return MouthFrame(turn, line, outward, forward)


def contraction(row: LipContraction, frame: MouthFrame, places: Doubles, unit: float) -> Contraction:
    """A full contraction of the control points ``places (K, 6, 3)`` m; ``unit`` is an eye separation in m."""
    offset = places - frame.line[:, None]
    out = (offset * frame.outward[:, None]).sum(2)
    ahead = (offset * frame.forward[:, None]).sum(2)
    angle = np.radians(row.rotation_deg.at(frame.turn))
    cosine, sine = np.cos(angle), np.sin(angle)
    move_out, move_ahead = out * (cosine - 1) + ahead * sine, ahead * (cosine - 1) - out * sine
    shift = move_out[..., None] * frame.outward[:, None] + move_ahead[..., None] * frame.forward[:, None]
    shift[..., 2] += unit * row.extrusion.at(frame.turn)
    half_width = np.abs(frame.line[:, 0]).max()
    cosine = np.clip(frame.line[:, 0] / half_width, -1.0, 1.0)
    sine = np.sqrt(1.0 - cosine**2) * np.where(frame.turn <= np.pi, 1.0, -1.0)
    ellipse = row.ellipse
    on_ellipse = np.stack(
        [ellipse.width * half_width * cosine, frame.line[:, 1].mean() + ellipse.height * unit * sine], axis=1
    )
    target = on_ellipse[:, None] + ellipse.thickness * offset[..., :2]
    pull = np.broadcast_to(np.array(ellipse.pull), target.shape[:2])
    return Contraction(shift.reshape(-1, 3), target.reshape(-1, 2), pull.reshape(-1).copy())
