"""Volumes of skin and flesh that contracting muscles gather or hollow: the bulges of Bui et al., section 4.

A volume of the level s moves each of its vertices by s times its way at full contraction, which is known at rest;
volumes add up where they meet.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.head.model import HeadModel


class VolumeTables(NamedTuple):
    """The K volumes of a face.

    Attributes:
        parameters: int32 ``(K, M)``, the parameters that move each volume, the first one repeated.
        shares: float32 ``(K, M)``, their shares, 0 for what is repeated.
        first: int32 ``(K + 1,)``, where each volume's entries begin.
        vertices: int32 ``(N,)``, the vertices that a volume moves.
        ways: float32 ``(N, 3)`` m, how far at level 1.
    """

    parameters: Indices
    shares: Floats
    first: Indices
    vertices: Indices
    ways: Floats


def prepare(model: HeadModel) -> VolumeTables:
    """The tables of a face."""
    most = max((len(volume.shares) for volume in model.volumes), default=1)
    parameters = np.zeros((len(model.volumes), most), np.int32)
    shares = np.zeros((len(model.volumes), most), np.float32)
    for i, volume in enumerate(model.volumes):
        parameters[i] = next(iter(volume.shares))
        parameters[i, : len(volume.shares)] = list(volume.shares)
        shares[i, : len(volume.shares)] = list(volume.shares.values())
    counts = [len(volume.vertices) for volume in model.volumes]
    return VolumeTables(
        parameters,
        shares,
        np.concatenate([[0], np.cumsum(counts)]).astype(np.int32),
        np.concatenate([np.zeros(0), *(volume.vertices for volume in model.volumes)]).astype(np.int32),
        np.concatenate([np.zeros((0, 3)), *(volume.ways for volume in model.volumes)]).astype(np.float32),
    )


def apply(tables: VolumeTables, values: Floats, points: Floats) -> None:
    """Move ``points (P, 3)`` m in place, to the parameters ``values``."""
    levels = np.clip((values[tables.parameters] * tables.shares).sum(axis=1), np.float32(0.0), np.float32(1.0))
    each = np.repeat(levels, np.diff(tables.first))
    np.add.at(points, tables.vertices, each[:, None] * tables.ways)
