"""What the tongue of a face needs a frame, made once a model: :class:`TongueTables`."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.lanes import LANES
from agentface.deform.tongue import passage
from agentface.deform.tongue.passage import Passage
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep
from agentface.parameters import indices_of

NAMES = "tongue_out", "tongue_raise", "tongue_tip_raise", "tongue_tip_shift", "tongue_roll"
SHAPE = "tongueOut"
STATIONS = 25
PLUMPER = 0.4
"""How much thicker than at rest, where it lies flat, a tongue is that is out."""
_SLIDES = "jaw_thrust", "jaw_shift"
_FARTHER = 1.4  # times the artists' way forward: as far as MPEG-4 has it, a mouth's width
_FORWARD = 0.027  # m, of a tongue without that shape
_ROUND_FROM, _ROUND = 0.65, 0.68  # where along the tongue its tip begins to be round, and how round it is


class TongueBlocks(NamedTuple):
    """The vertices in B blocks of LANES; a last block that is not full repeats its last vertex.

    Attributes:
        arm: ``(B, 6, LANES)`` m, x, y and z of ``TongueTables.arm``, then those of ``arm_out``.
        station: ``(B, LANES)``; ``part``: ``(B, LANES)``.
    """

    arm: Doubles
    station: Indices
    part: Doubles


class TongueTables(NamedTuple):
    """What the tongue needs a frame; T vertices, K stations from its root to its tip.

    Attributes:
        parameters: ``(5,)``, where those of ``NAMES`` stand in a pose.
        stirs: ``(7,)``, these and the slides of the jaw, which bring the tongue to the upper teeth.
        rest: ``(T, 3)`` float32 m.
        arm: ``(T, 3)`` m, from the middle line.
        arm_out: ``(T, 3)`` m, how it changes when the tongue is out.
        station: ``(T,)``, the station behind each vertex; ``part``: ``(T,)`` 0..1, how far it is towards the next one.
        line: ``(K, 2)`` m, height and depth of the middle line; ``line_out``: ``(K, 2)`` m, its way out.
        thick: ``(K,)`` m, half of the tongue's height; ``wide``: ``(K,)`` m, half of its width; ``wide_out``: ``(K,)``
            m, how that changes when it is out.
        hump: ``(K,)`` 0..1, how far each station rises; ``rolls``: ``(K,)`` 0..1, how far it rolls.
        passage: teeth and lips.
        blocks: what of these is the vertices', for compiled code.
    """

    parameters: Indices
    stirs: Indices
    rest: Floats
    arm: Doubles
    arm_out: Doubles
    station: Indices
    part: Doubles
    line: Doubles
    line_out: Doubles
    thick: Doubles
    wide: Doubles
    wide_out: Doubles
    hump: Doubles
    rolls: Doubles
    passage: Passage
    blocks: TongueBlocks


_PER_VERTEX = "rest", "arm", "arm_out", "station", "part"


def prepare(model: HeadModel) -> TongueTables:
    """The tables of a face."""
    mesh = model.parts["tongue"]
    rest = mesh.attributes["POSITION"].astype(np.float64)
    out = _way_out(model, rest)
    out[:, 2] *= _FARTHER
    z = rest[:, 2]
    end = np.clip(((z - z.min()) / (z.max() - z.min()) - _ROUND_FROM) / (1.0 - _ROUND_FROM), 0.0, 1.0)
    aside = rest[:, 0] - model.part_moves["tongue"][0]
    out[:, 0] += (np.sqrt(1.0 - _ROUND * end * end) - 1.0) * (aside + out[:, 0])
    along = (z - z.min()) / (z.max() - z.min()) * (STATIONS - 1)
    station = np.minimum(along.astype(np.int32), STATIONS - 2)
    part, at = along - station, np.linspace(z.min(), z.max(), STATIONS)
    near = [np.abs(z - place) <= 1.2 * (at[1] - at[0]) for place in at]
    low, high = (np.array([bound(rest[rows, 1]) for rows in near]) for bound in (np.min, np.max))
    line = np.column_stack([0.5 * (low + high), at])
    line_out = np.array([out[rows, 1:].mean(axis=0) for rows in near])
    wide = np.array([np.abs(rest[rows, 0] - model.part_moves["tongue"][0]).max() for rows in near])
    share = np.linspace(0.0, 1.0, STATIONS)
    middle, there = between(line, station, part), np.abs(rest[:, 0] + out[:, 0] - model.part_moves["tongue"][0])
    wide_out = np.array([there[rows].max() for rows in near]) - wide
    arm = rest - np.column_stack([np.zeros(len(rest)), middle])
    arm_out = out - np.column_stack([np.zeros(len(rest)), between(line_out, station, part)])
    arm_out[:, 1] += PLUMPER * arm[:, 1]
    return TongueTables(
        parameters=np.array([indices_of(name)[0] for name in NAMES], np.int32),
        stirs=np.array([indices_of(name)[0] for name in (*NAMES, *_SLIDES)], np.int32),
        rest=rest.astype(np.float32),
        arm=arm,
        arm_out=arm_out,
        station=station,
        part=part,
        line=line,
        line_out=line_out,
        thick=0.5 * (high - low),
        wide=wide,
        wide_out=wide_out,
        hump=smoothstep(0.0, 0.55, share) * (1.0 - smoothstep(0.6, 1.0, share)),
        rolls=smoothstep(0.3, 0.7, share),
        passage=passage.prepare(model),
        blocks=_blocks(arm, arm_out, station, part),
    )


def only(tables: TongueTables, vertices: npt.NDArray[np.integer[Any]]) -> TongueTables:
    """The tables of some of the vertices."""
    few: dict[str, Any] = {name: np.ascontiguousarray(getattr(tables, name)[vertices]) for name in _PER_VERTEX}
    return tables._replace(**few, blocks=_blocks(few["arm"], few["arm_out"], few["station"], few["part"]))


def _blocks(arm: Doubles, arm_out: Doubles, station: Indices, part: Doubles) -> TongueBlocks:
    full = np.minimum(np.arange(-(-len(arm) // LANES) * LANES), len(arm) - 1).reshape(-1, LANES)
    arms = np.moveaxis(np.concatenate([arm, arm_out], axis=1)[full], 2, 1)
    return TongueBlocks(
        np.ascontiguousarray(arms, np.float64),
        np.ascontiguousarray(station[full], np.int32),
        np.ascontiguousarray(part[full], np.float64),
    )


def _way_out(model: HeadModel, rest: Doubles) -> Doubles:
    shapes = model.parts["tongue"].shapes
    if SHAPE in shapes:
        return np.asarray(shapes[SHAPE].dense(len(rest)), np.float64)
    z = rest[:, 2]
    return np.column_stack([np.zeros((len(rest), 2)), _FORWARD * (z - z.min()) / (z.max() - z.min())])


def between(rows: Doubles, station: Indices, part: Doubles) -> Doubles:
    """``rows (K, ...)`` at each place along the tongue."""
    weight = part if rows.ndim == 1 else part[:, None]
    return np.asarray(rows[station] + weight * (rows[station + 1] - rows[station]))
