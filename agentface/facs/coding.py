"""Action units to poses and back, by ``rules/action_units.yaml``.

A muscle that several action units share contracts as far as the one that asks most of it: two causes do not contract a
muscle twice, and a dropped jaw (26) parts the lips (25) already. Signed movements add up. Backwards, an action unit is
as strong as its least contracted muscle allows: the largest intensity that asks for no more than is there, so that the
contractions come back exactly (Cuninghame-Green, Minimax Algebra, 1979).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np

from agentface.conventions import Floats
from agentface.facs.action_units import action_units, check_unit
from agentface.parameters import COUNT, HIGH, LOW, PARAMETERS, indices_of

_CONTRACTS = np.array([known.contracts for known in PARAMETERS])


@cache
def parts_of(units: tuple[int, ...]) -> Floats:
    """``(U, COUNT)``: what each action unit at its full intensity makes of each parameter, on both sides.

    Raises UnknownNameError for a number that the table does not have.
    """
    parts = np.zeros((len(units), COUNT), np.float32)
    for row, number in enumerate(units):
        for name, part in action_units()[check_unit(number)].parts.items():
            parts[row, [*indices_of(name)]] = part
    parts.flags.writeable = False
    return parts


def poses_of(units: Sequence[int], intensities: Floats) -> Floats:
    """``(T, COUNT)`` of ``intensities (T, U)``, 0..1, of the action units of these numbers, kept within its ranges."""
    levels = np.asarray(intensities, np.float32)
    poses = np.zeros((len(levels), COUNT), np.float32)
    for level, parts in zip(levels.T, parts_of(tuple(units)), strict=True):
        asked = level[:, None] * parts
        poses = np.where(_CONTRACTS, np.maximum(poses, asked), poses + asked)
    return poses.clip(LOW, HIGH)


def intensities_of(units: Sequence[int], poses: Floats) -> Floats:
    """``(T, U)``, 0..1: the intensities that ``poses (T, COUNT)`` show.

    What is contracted on one side more than on the other counts as their mean, for an action unit has no side here.
    """
    found = np.ones((len(poses), len(units)), np.float32)
    for column, number in enumerate(units):
        for name, part in action_units()[check_unit(number)].parts.items():
            shown = np.asarray(poses)[:, [*indices_of(name)]].mean(axis=1) / part
            np.minimum(found[:, column], shown, out=found[:, column])
    return found.clip(0.0, 1.0)
