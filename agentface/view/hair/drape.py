"""Which way long hair falls: from the parting over the head to its widest, then down beside face and neck."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep
from agentface.view.hair.groom import smoothed
from agentface.view.hair.hairline import Hairline
from agentface.view.hair.hull import Hull
from agentface.view.hair.ribbons import unit_rows
from agentface.view.hair.styles import REFERENCE_EYES, parting_of, whorl_of

COLUMNS = 49
_ON_PARTING = 0.45
"""The part of the columns that start along the parting; the others fan out round the whorl."""
_TURNS_DEG = (50.0, 190.0)
"""Round the head from the front, where it is widest: where the first and the last column lie."""
_ARC, _FALL = 24, 14
_SMOOTHINGS, _PULLS, _LAST_SMOOTHINGS = 8, 10, 30
"""Hair hangs taut over what stands out: smoothed, and pushed out of the head again, so many times."""
_WHORL = 0.0025
"""Metres round the whorl where hair starts."""
_BESIDE, _CROSSED, _CROSSING = 0.0008, 8.0, 0.9
"""Metres from the parting where hair starts, by how much of that less at its end, where it is combed over it, and the
exponent with which it comes to that."""
_ZIGZAG = ((0.0013, 240.0, 0.0), (0.0007, 610.0, 1.3))
"""Waves of the parting, which is no line: metres to both sides, radians a metre, where each starts."""
_FRAMING_DEG, _FRAMING_REACH_DEG, _FRAMING_WAY = 20.0, 20.0, (0.15, 0.50)
"""How far the hair at the face comes forward over the cheeks, and to which turn behind it does; the parts of
its fall between which it comes."""
_BACK, _BACK_WAY = 0.30, (0.50, 0.80)
"""How much of that it goes back below the cheekbones, where it would hide the corners of the mouth; between which parts
of its fall."""
_BULGE, _INWARD = 0.006, 0.016
"""Metres that falling hair stands off half way down, and that its ends turn in towards the neck."""


def draped(model: HeadModel, look: HairLook, hull: Hull, sign: float) -> Doubles:
    """``(C, K, 3)`` m on the ``hull``, of the side ``sign``: the first column at the face, the last at the nape."""
    scale = model.landmarks.eye_separation / REFERENCE_EYES
    roots = _roots(model, look, hull, sign) - hull.centre
    first = unit_rows(roots)
    turn = np.radians(np.linspace(*_TURNS_DEG, COLUMNS))
    last = np.stack([sign * np.sin(turn), 0.0 * turn, np.cos(turn)], axis=1)
    angle = np.arccos(np.clip((first * last).sum(1), -1.0, 1.0))[:, None, None]
    part = np.linspace(0.0, 1.0, _ARC)[None, :, None]
    arc = (np.sin((1.0 - part) * angle) * first[:, None] + np.sin(part * angle) * last[:, None]) / np.sin(angle)
    arc = hull.hold(hull.centre + 0.1 * arc, 0.0, 0.0)
    path = np.concatenate([arc, _fall(model, look, arc[:, -1] - hull.centre, sign, scale) + hull.centre], axis=1)
    for _ in range(_PULLS):
        path = hull.push_out(smoothed(path, _SMOOTHINGS), 0.0)
    return smoothed(path, _LAST_SMOOTHINGS)


def _fall(model: HeadModel, look: HairLook, widest: Doubles, sign: float, scale: float) -> Doubles:
    """``(C, _FALL, 3)`` m from the head's centre: down from where each column is ``widest (C, 3)``."""
    turn = np.arctan2(sign * widest[:, 0], widest[:, 2])[:, None]
    reach = np.hypot(widest[:, 0], widest[:, 2])[:, None]
    s = np.linspace(0.0, 1.0, _FALL + 1)[None, 1:]
    away = np.degrees(turn - turn[0]) / _FRAMING_REACH_DEG
    forward = smoothstep(*_FRAMING_WAY, s) * (1.0 - _BACK * smoothstep(*_BACK_WAY, s))
    turn = turn - np.radians(_FRAMING_DEG) * np.exp(-(away**2)) * forward
    reach = reach + scale * (_BULGE * np.sin(np.pi * s) - _INWARD * smoothstep(0.35, 1.1, s) ** 1.5)
    lowest = look.length * float(model.landmarks["menton"][1])
    drop = s * (lowest - widest[:, 1:2] - Hull.centre_of(model)[1])
    return np.stack([sign * reach * np.sin(turn), widest[:, 1:2] + drop, reach * np.cos(turn)], axis=2)


def parting_line(model: HeadModel, look: HairLook, hull: Hull) -> Doubles:
    """``(N, 3)`` m on the hull: the parting from the hairline back to the whorl."""
    line, whorl = Hairline(model, look.hairline), whorl_of(model, look)
    pitch = np.radians(np.linspace(85.0, -30.0, 400))
    top = hull.hold(hull.centre + 0.1 * np.stack([0 * pitch, np.cos(pitch), np.sin(pitch)], axis=1), 0.0, 0.0)
    part = np.clip((top[:, 2] - whorl[2]) / (top[0, 2] - whorl[2]), 0.0, 1.0)
    top[:, 0] = whorl[0] + (parting_of(model, look) - whorl[0]) * part
    top = hull.hold(top, 0.0, 0.0)
    first, last = int(np.argmax(line.behind(top) > 0.001)), int(np.argmax(top[:, 2] < whorl[2]))
    return top[first:last]


def _roots(model: HeadModel, look: HairLook, hull: Hull, sign: float) -> Doubles:
    """``(C, 3)`` m along the parting from the hairline back, then round the whorl to the middle of the back."""
    line, count = parting_line(model, look, hull), round(_ON_PARTING * COLUMNS)
    chosen = line[np.linspace(0, len(line) - 1, count).astype(int)]
    fan = np.radians(np.linspace(90.0, 190.0, COLUMNS - count))
    round_whorl = chosen[-1] + _WHORL * np.stack([sign * np.sin(fan), 0 * fan, np.cos(fan)], axis=1)
    chosen[:, 0] += sign * _BESIDE * (1.0 - _CROSSED * np.linspace(0.0, 1.0, count) ** _CROSSING)
    chosen[:, 0] += sum(far * np.sin(turns * chosen[:, 2] + start) for far, turns, start in _ZIGZAG)
    return np.concatenate([chosen, round_whorl])
