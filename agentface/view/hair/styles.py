"""Hair styles: which way hair runs over the head, how long it is, how finely each quality draws it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.view.hair.ribbons import unit_rows

GUIDE_STEP = 0.006
"""Metres between the points of a guide."""
REFERENCE_EYES = 0.0525
"""The distance between the pupils, metres, that lengths below are meant for."""

Flow = Callable[[Doubles, float], Doubles]
"""From places ``(N, 3)`` and how far along the hair they are, metres, to directions ``(N, 3)``."""


@dataclass(frozen=True, slots=True)
class Amount:
    """How finely a quality draws hair: locks and their half width in metres, hairs and theirs, points of each."""

    locks: int
    width: float
    hairs: int
    radius: float
    points: int


@dataclass(frozen=True, slots=True)
class Style:
    """How a style grows.

    ``thickness`` of the hair and the length ``rise`` over which it gets there, metres; ``stiff`` 0..1 how slowly it
    follows the flow, ``weight`` of its own, ``clump`` 0..1 how far a lock's tips come together, ``blunt`` 0..1 how
    long the shortest are, ``over_ears`` whether it lies over them.
    """

    thickness: float
    rise: float
    stiff: float
    weight: float
    clump: float
    blunt: float
    over_ears: bool
    amounts: dict[str, Amount]


STYLES = {
    "cropped": Style(
        0.006, 0.006, 0, 0, 0, 1.0, False,
        {"fast": Amount(0, 0.0, 1000, 0.0005, 4), "portrait": Amount(0, 0.0, 4400, 0.00026, 6)},
    ),
    "swept": Style(
        0.013, 0.022, 0.70, 0.03, 0.35, 0.80, False,
        {"fast": Amount(950, 0.0025, 200, 0.0007, 6), "portrait": Amount(2100, 0.0014, 800, 0.00030, 8)},
    ),
    "bob": Style(
        0.012, 0.040, 0.72, 0.16, 0.32, 0.94, True,
        {"fast": Amount(0, 0.0, 16, 0.00028, 7), "portrait": Amount(0, 0.0, 80, 0.00020, 9)},
    ),
    "bun": Style(
        0.007, 0.060, 0.55, 0.0, 0.35, 0.84, False,
        {"fast": Amount(420, 0.0032, 200, 0.0007, 8), "portrait": Amount(900, 0.0022, 1200, 0.00028, 11)},
    ),
}  # fmt: skip


PARTED = ("bob",)
"""Styles whose hair falls from a parting: drawn as sheets."""


def thickness_of(model: HeadModel, look: HairLook) -> float:
    """How thick hair lies on the head, metres."""
    return STYLES[look.style].thickness * look.volume * model.landmarks.eye_separation / REFERENCE_EYES


def parting_of(model: HeadModel, look: HairLook) -> float:
    """The parting's x in metres."""
    return look.parting * 0.6 * model.landmarks.eye_separation


def whorl_of(model: HeadModel, look: HairLook) -> Doubles:
    """Where the parting ends: a point above which hair falls to all sides; its height means nothing."""
    return np.array([0.5 * parting_of(model, look), 0.0, -0.75 * model.landmarks.eye_separation])


def knot_of(model: HeadModel) -> Doubles:
    """Where tied hair runs to: behind the back of the head."""
    unit = model.landmarks.eye_separation
    return np.array([0.0, 0.42 * unit, float(model.vertices[:, 2].min()) - 0.2 * unit])


def flow_of(model: HeadModel, look: HairLook) -> Flow:
    """The directions of the style of ``look``."""
    return {"bob": _falling, "swept": _back, "bun": _to_knot}[look.style](model, look)


def lengths_of(model: HeadModel, look: HairLook, guides: Doubles) -> Doubles:
    """``(G,)`` metres of each guide ``(G, K, 3)`` that hair is long."""
    unit = model.landmarks.eye_separation
    if look.style == "swept":  # long on top, short at the sides and the nape
        high = np.clip((guides[:, 0, 1] / unit - 0.55) / 0.8, 0, 1)
        return np.asarray((0.015 + 0.055 * high) * look.length * unit / REFERENCE_EYES)
    if look.style == "bun":
        away = np.linalg.norm(guides - knot_of(model), axis=2)
        return np.asarray(np.maximum(away.argmin(1) * GUIDE_STEP, 0.012))
    drop = guides[:, :, 1] - look.length * float(model.landmarks["menton"][1])
    below = drop < 0
    last = np.clip(np.where(below.any(1), below.argmax(1), guides.shape[1] - 1), 1, None)
    over, under = (np.take_along_axis(drop, (last - back)[:, None], axis=1)[:, 0] for back in (1, 0))
    part = np.clip(over / np.maximum(over - under, 1e-6), 0, 1)
    return np.asarray(np.maximum((last - 1 + part) * GUIDE_STEP, 0.02))


def _falling(model: HeadModel, look: HairLook) -> Flow:
    """Away from the parting and round the whorl, then down beside the cheeks."""
    parting, unit = parting_of(model, look), model.landmarks.eye_separation
    front = float(model.landmarks["hairline_middle"][2])
    whorl = whorl_of(model, look)

    def flow(at: Doubles, along: float) -> Doubles:
        side = np.tanh((at[:, 0] - parting) / (0.05 * unit))
        high = np.clip(at[:, 1] / (1.5 * unit), 0, 1)
        ahead = np.clip((at[:, 2] - 0.5 * unit) / (front - 0.5 * unit), 0, 1.5)
        parted = np.clip((at[:, 2] + 0.5 * unit) / (0.9 * unit), 0, 1)[:, None]
        away = unit_rows((at - whorl) * [1, 0, 1])
        aside = np.stack([1.2 * side, 0 * side, 0 * side - 0.10 - 0.50 * np.exp(-along / 0.03)], axis=1)
        fall = [0 * high, -0.25 - 0.75 * (1 - high), 0.20 * (1 - high) * (at[:, 2] < 0.5 * unit) - 0.6 * ahead]
        return np.asarray(high[:, None] * (parted * aside + (1 - parted) * away) + np.stack(fall, axis=1))

    return flow


def _back(model: HeadModel, look: HairLook) -> Flow:
    """Combed back: on top straight, at the sides also down."""
    parting, unit = parting_of(model, look), model.landmarks.eye_separation

    def flow(at: Doubles, along: float) -> Doubles:
        high = np.clip(at[:, 1] / (1.4 * unit), 0, 1)
        aside = 0.35 * np.tanh((at[:, 0] - parting) / (0.4 * unit)) * high
        return np.stack([aside, 0.15 * high - 1.0 * (1 - high), -0.45 - 0.55 * high], axis=1)

    return flow


def _to_knot(model: HeadModel, look: HairLook) -> Flow:
    """Over the head to where it is tied."""
    knot, parting, unit = knot_of(model), parting_of(model, look), model.landmarks.eye_separation

    def flow(at: Doubles, along: float) -> Doubles:
        ahead = np.clip((at[:, 2] - 0.1 * unit) / unit, 0, 1)
        aside = 0.55 * np.tanh((at[:, 0] - parting) / (0.1 * unit)) * ahead
        return np.asarray(unit_rows(knot - at) + np.stack([aside, 0 * ahead, 0 * ahead], axis=1))

    return flow
