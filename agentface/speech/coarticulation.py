"""What a timeline shows at one time; the compiled twin is :mod:`agentface.speech.coarticulation_compiled`.

Every articulator goes through ``sum(D T) / sum(D)`` over the segments near by, with a target T and a dominance
``D = strength exp(-speed (sqrt(d^2 + e^2) - e))`` at a distance d from the segment's middle part (Cohen and Massaro,
Modeling coarticulation in synthetic visual speech, 1993; the rounding e leaves no corner in the speed).

Contacts, the hold on the jaw and speaking are whole for a while and come and go by half a cosine. Where several
overlap, contacts and speaking are together ``1 - prod(1 - x)``, which has no corner either, and the holds the cubic
root of the sum of their cubes, nearly the largest.
"""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles
from agentface.speech.articulation import Ramps, Timeline

REACH_S = 2.0
"""What is farther away counts for nothing."""


def sample(timeline: Timeline, ramps: Ramps, time: float, out: Doubles) -> None:
    """Write ``out (P + 2,)``: the parameters, how tightly the jaw is held, and 0..1 speaking."""
    near = (timeline.spans[:, 1] > time - REACH_S) & (timeline.spans[:, 0] < time + REACH_S)
    count, moved = out.shape[0] - 2, ramps.articulator.shape[0]
    out[:] = 0.0
    if not near.any():
        return
    weights = _dominance(timeline, ramps, time)[near]
    shares = weights[:, ramps.articulator]
    sums = shares.sum(axis=0)
    out[:moved] = (shares * timeline.targets[near, :moved]).sum(axis=0) / np.maximum(sums, 1e-30)
    levels = _bump(time, timeline.held[near], timeline.held[near, :, 2], timeline.held[near, :, 3])
    out[moved:count] = 1.0 - (1.0 - timeline.targets[near, moved:] * levels).prod(axis=0)
    tight = timeline.tight[near] * _bump(time, timeline.kept[near], ramps.jaw_s, ramps.jaw_s)
    out[count] = (tight**3.0).sum() ** (1.0 / 3.0)
    said = timeline.said[near] * _bump(time, timeline.spans[near], ramps.speaking[0], ramps.speaking[1])
    out[count + 1] = 1.0 - (1.0 - said).prod()


def _dominance(timeline: Timeline, ramps: Ramps, time: float) -> Doubles:
    """``(S, A)``: that of each segment at a time."""
    away = time - timeline.middles[:, 0]
    far = np.maximum(np.abs(away) - timeline.middles[:, 1], 0.0)
    distance = np.sqrt(far * far + ramps.round_s**2) - ramps.round_s
    speed = np.where((away < 0.0)[:, None], timeline.dominance[:, :, 1], timeline.dominance[:, :, 2])
    return np.asarray(timeline.dominance[:, :, 0] * np.exp(-speed * distance[:, None]))


def _bump(time: float, spans: Doubles, before: Doubles | float, after: Doubles | float) -> Doubles:
    """1 from ``spans[..., 0]`` to ``spans[..., 1]``, coming and going by half a cosine."""
    up = np.clip((time - spans[..., 0]) / before + 1.0, 0.0, 1.0)
    down = np.clip((spans[..., 1] - time) / after + 1.0, 0.0, 1.0)
    return np.asarray((0.5 - 0.5 * np.cos(np.pi * up)) * (0.5 - 0.5 * np.cos(np.pi * down)))
