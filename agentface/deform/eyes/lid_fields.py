"""What each vertex round an eye does when the lids move: fields over the skin at rest, made once a face."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from agentface.conventions import SIDES, Doubles, Indices
from agentface.head.lids import LidMotion, LidSlant
from agentface.head.model import HeadModel
from agentface.head.resample import ResampledModel
from agentface.head.rings import RingHalves
from agentface.mesh.evening import evened
from agentface.mesh.smoothstep import falloff, smoothstep

_Mask: TypeAlias = npt.NDArray[np.bool_]
_THICKNESS = 0.05  # of the eye's radius, by which a lid bulges over its edge when it is stretched
_ROUNDING = 0.05  # of an eye separation, from the edge to where it bulges so far
_NASAL = 0.3  # how far the sphincter draws the skin beside the nose outward, as a part of the temple's way inward
_EVENINGS = 3
_CORNER = 0.35  # part of the eye's width over which the sinking of its outer corner fades out
_RISE = 0.35  # part of the sphincter's ellipse inside which it draws whole
_SLACK = 1e-6  # m, by which the sphere lies below a vertex that rests on it: no pose, no move


@dataclass(frozen=True, slots=True)
class LidFields:
    """The left eye's fields, ``(N,)`` each, of the vertices ``vertex``; angles lift when positive.

    Attributes:
        vertex: the vertices that lids or sphincter move.
        hold: 0..1, how much of what vector muscles did is taken back.
        close, meet_higher: rad, the turn of a full closing, and what a full squeeze adds to it.
        widen, follow: rad and rad a rad, the turn of the levator and of the gaze's pitch.
        tighten, slant: rad, the turn of the lower lid's own muscle, and of an inner brow that rises alone.
        shrink, shrink_higher: change of the distance from the eye's axis, as parts, with ``close``, ``meet_higher``.
        across, up: m, the way of a full squeeze.
        tight_across, tight_up: m, the way that goes with ``tighten``.
        floor: m, the least distance from the eye's centre.
    """

    vertex: Indices
    hold: Doubles
    close: Doubles
    meet_higher: Doubles
    widen: Doubles
    follow: Doubles
    tighten: Doubles
    slant: Doubles
    shrink: Doubles
    shrink_higher: Doubles
    across: Doubles
    up: Doubles
    tight_across: Doubles
    tight_up: Doubles
    floor: Doubles


@dataclass(frozen=True, slots=True)
class _Curve:
    """Half a ring as a curve over x: points ``(K, 3)`` m from the eye's centre, their turn and axial distance."""

    points: Doubles
    turn: Doubles
    reach: Doubles

    @classmethod
    def of(cls, arms: Doubles, half: list[int]) -> _Curve:
        points = arms[half]
        points = points[np.argsort(points[:, 0], kind="stable")]
        return cls(points, np.arctan2(points[:, 1], points[:, 2]), np.hypot(points[:, 1], points[:, 2]))

    def at(self, x: Doubles) -> tuple[Doubles, Doubles]:
        """Turn and axial distance at each ``x``."""
        return np.interp(x, self.points[:, 0], self.turn), np.interp(x, self.points[:, 0], self.reach)

    def nearest(self, arms: Doubles) -> tuple[Doubles, Doubles]:
        """Of each of ``arms (N, 3)``: its distance from the curve in metres, and the x of the nearest point."""
        start, along = self.points[:-1], np.diff(self.points, axis=0)
        lengths = np.maximum((along**2).sum(1), 1e-12)
        part = np.clip(((arms[:, None] - start) * along).sum(2) / lengths, 0.0, 1.0)
        foot = start + part[..., None] * along
        gaps = np.linalg.norm(arms[:, None] - foot, axis=2)
        best = gaps.argmin(1)[:, None]
        return np.take_along_axis(gaps, best, 1)[:, 0], np.take_along_axis(foot[..., 0], best, 1)[:, 0]


@dataclass(frozen=True, slots=True)
class _Slit:
    """The opening between two half rings at N places across the eye, turns in rad and axial distances in m, ``(N,)``.

    Attributes:
        opening: the turn from the lower to the upper edge.
        turn, reach: of the edge of the vertex's own lid.
        met, met_reach: of the line where the lids meet.
        higher, higher_reach: how much more they are where the lids of a squeezed eye meet.
    """

    opening: Doubles
    turn: Doubles
    reach: Doubles
    met: Doubles
    met_reach: Doubles
    higher: Doubles
    higher_reach: Doubles

    @classmethod
    def at(cls, edges: tuple[_Curve, _Curve], x: Doubles, is_upper: _Mask, motion: LidMotion) -> _Slit:
        """The slit at each ``x``. The lids meet on a line through as many points as the upper edge has."""
        (above, above_reach), (below, below_reach) = (edge.at(x) for edge in edges)
        upper, lower = edges
        under, under_reach = lower.at(upper.points[:, 0])
        lines = []
        for part in (motion.meeting, motion.squeezed_meeting):
            turn, reach = under + part * (upper.turn - under), under_reach + part * (upper.reach - under_reach)
            lines.append([np.interp(x, upper.points[:, 0], line) for line in (turn, reach)])
        (met, met_reach), (squeezed, squeezed_reach) = lines
        turn, reach = np.where(is_upper, above, below), np.where(is_upper, above_reach, below_reach)
        opening = np.maximum(above - below, 0.0)
        return cls(opening, turn, reach, met, met_reach, squeezed - met, squeezed_reach - met_reach)

    @property
    def profile(self) -> Doubles:
        """0 at the corners of the eye, 1 where it is widest open."""
        return 1.0 - (1.0 - self.opening / self.opening.max()) ** 2

    def moves(self) -> tuple[Doubles, Doubles, Doubles, Doubles]:
        """What the edge does: closing turn, its change when squeezed, and the same for the axial distance, as parts."""
        return self.met - self.turn, self.higher, self.met_reach / self.reach - 1.0, self.higher_reach / self.reach


@dataclass(frozen=True, slots=True)
class _Places:
    """Where the N vertices lie at the lids, and how far each goes along with them.

    Attributes:
        arms: ``(N, 3)`` m, from the eye's centre.
        is_upper: ``(N,)``, whether the upper lid is the nearer one.
        gap: ``(N,)`` eye separations, from the edge of that lid.
        x: ``(N,)`` m, of the nearest point of the edge.
        hold, whole, lift: ``(N,)`` 0..1, by :class:`agentface.head.lids.LidFade`.
    """

    arms: Doubles
    is_upper: _Mask
    gap: Doubles
    x: Doubles
    hold: Doubles
    whole: Doubles
    lift: Doubles

    @classmethod
    def of(cls, model: HeadModel, arms: Doubles, edges: tuple[_Curve, _Curve]) -> _Places:
        """Those of a face; the vertices of the rings up to the edge belong to their own lid."""
        file = model.eyelids
        gaps, places = zip(*(edge.nearest(arms) for edge in edges), strict=True)
        is_upper = gaps[0] <= gaps[1]
        gap, x = np.minimum(*gaps) / model.landmarks.eye_separation, np.where(is_upper, *places)
        for ring in file.rings[SIDES[0]][: file.edge_ring + 1]:
            loop = ring.upper + ring.lower
            is_upper[ring.upper], is_upper[ring.lower] = True, False
            gap[loop], x[loop] = 0.0, arms[loop, 0]
        lids = file.upper, file.lower
        fades = ([lid.hold for lid in lids], [(lid.whole, lid.ends) for lid in lids], [(0.0, lid.lift) for lid in lids])
        return cls(
            arms, is_upper, gap, x, *(np.where(is_upper, *(falloff(gap, *ends) for ends in pair)) for pair in fades)
        )


def lid_fields(model: HeadModel) -> LidFields:
    """The fields of the left eye; a face made of another has that one's, interpolated."""
    if isinstance(model, ResampledModel):
        return _resampled(lid_fields(model.coarse), model)
    file, rings = model.eyelids, model.eyelids.rings[SIDES[0]]
    arms = model.vertices.astype(np.float64) - model.eye_centre(SIDES[0])
    edges = _curves(arms, rings[file.edge_ring])
    at = _Places.of(model, arms, edges)
    slit = _Slit.at(edges, at.x, at.is_upper, file)
    sink = at.whole * _sinking(edges[0], slit, at.x, file.corner_sink * model.landmarks.eye_separation)
    fields = _closing(model, at, slit, sink) | _turning(model, at, slit, edges)
    fields["across"], fields["up"] = _sphincter(model, arms, 1.0 - at.whole)
    for name, field in fields.items():  # nearest points of an edge jump where the edge is hollow
        fields[name] = evened(field, model.triangles, _EVENINGS, at.gap > 0.0)
    for ring in rings[: file.edge_ring]:
        _meet(arms, ring, file, sink, fields)
    fields["hold"] = at.hold
    fields["floor"] = np.minimum(file.sphere * model.eyes.radius, np.linalg.norm(arms, axis=1) - _SLACK)
    moved = (at.hold > 0) | (at.whole * slit.opening > 1e-9) | (np.hypot(fields["across"], fields["up"]) > 1e-9)
    moved |= fields["tighten"] + fields["tight_up"] > 1e-6
    pick = np.flatnonzero(moved & (model.vertices[:, 0] > 1e-4) & (arms[:, 2] > -model.eyes.radius)).astype(np.int32)
    return LidFields(pick, **{name: field[pick] for name, field in fields.items()})


def _closing(model: HeadModel, at: _Places, slit: _Slit, sink: Doubles) -> dict[str, Doubles]:
    """The turns and the changes of distance of a lid that closes, or is squeezed shut."""
    file, radius = model.eyelids, model.eyes.radius
    close, higher, shrink, shrink_higher = (at.whole * move for move in slit.moves())
    close, higher = close + sink, higher - sink  # a squeeze holds the corner up
    flat = np.where(at.is_upper, slit.profile, 0.0) * (at.whole * _flattening(at, slit, radius) - shrink)
    shrink += flat
    shrink_higher -= flat * (file.squeezed_meeting - file.meeting) / max(1.0 - file.meeting, 1e-6)
    return {"close": close, "meet_higher": higher, "shrink": shrink, "shrink_higher": shrink_higher}


def _turning(model: HeadModel, at: _Places, slit: _Slit, edges: tuple[_Curve, _Curve]) -> dict[str, Doubles]:
    """What else moves the lids: the levator, the gaze, the lower lid's own muscle and the inner brow."""
    file = model.eyelids
    raised = at.lift * slit.profile
    tighten, tight_across, tight_up = _tightening(model, at, slit.profile)
    return {
        "widen": _rise(edges, file.widest * model.eyes.radius) * np.where(at.is_upper, raised, 0.0),
        "follow": raised * np.where(at.is_upper, file.upper.pitch, file.lower.pitch),
        "tighten": tighten,
        "slant": np.where(at.is_upper, at.lift * _slant(file.slant, edges[0], at.x), 0.0),
        "tight_across": tight_across,
        "tight_up": tight_up,
    }


def _resampled(fields: LidFields, model: ResampledModel) -> LidFields:
    names = fields.__slots__[1:]
    columns, moved = np.zeros((len(model.coarse.vertices), len(names))), np.zeros(len(model.coarse.vertices), np.bool_)
    columns[fields.vertex], moved[fields.vertex] = np.stack([getattr(fields, name) for name in names], axis=1), True
    pick = np.flatnonzero(moved[model.parents].any(axis=1) & (model.vertices[:, 0] > 0.0)).astype(np.int32)
    columns = columns[model.parents[pick]].mean(axis=1)
    # the middle of an edge is nearer to the eye than its ends
    arms = model.vertices[pick].astype(np.float64) - model.eye_centre(SIDES[0])
    columns[:, -1] = np.minimum(columns[:, -1], np.linalg.norm(arms, axis=1) - _SLACK)
    return LidFields(pick, *columns.T)


def _curves(arms: Doubles, ring: RingHalves) -> tuple[_Curve, _Curve]:
    return _Curve.of(arms, ring.upper), _Curve.of(arms, ring.lower)


def _flattening(at: _Places, slit: _Slit, radius: float) -> Doubles:
    """The part by which the axial distance changes to put stretched skin on the sphere through the closed edge."""
    sphere = np.hypot(slit.met_reach, at.x) + _THICKNESS * radius * smoothstep(0.0, _ROUNDING, at.gap)
    target = np.sqrt(np.maximum(sphere**2 - at.arms[:, 0] ** 2, (0.5 * radius) ** 2))
    return target / np.maximum(np.hypot(at.arms[:, 1], at.arms[:, 2]), 0.2 * radius) - 1.0


def _rise(edges: tuple[_Curve, _Curve], height: float) -> float:
    """The turn that raises the upper lid, where the eye is widest open, to ``height`` metres above the eye's centre."""
    upper, lower = edges
    middle = np.argmax(upper.turn - lower.at(upper.points[:, 0])[0])
    return max(0.0, math.asin(min(1.0, height / upper.reach[middle])) - upper.turn[middle])


def _tightening(model: HeadModel, at: _Places, profile: Doubles) -> tuple[Doubles, ...]:
    """The turn of the lower lid at full contraction, and how far the skin below goes across and up."""
    table, unit = model.eyelids.tightening, model.landmarks.eye_separation
    near = falloff(at.gap, table.whole, table.ends)
    turn = math.radians(table.turn_deg) * (table.corners + (1.0 - table.corners) * np.clip(profile, 0.0, 1.0)) * near
    x, y = (at.arms[:, :2] - (model.landmarks[f"lid_lower_{SIDES[0]}"] - model.eye_centre(SIDES[0]))[:2]).T / unit
    temple, nose, height = table.half_axes
    lifted = falloff(np.hypot(x / np.where(x > 0, temple, nose), y / height), 0.0, 1.0) * (1.0 - near) * unit
    across = -table.inward * np.clip(x / temple, 0.0, 1.0) * lifted
    return tuple(np.where(at.is_upper, 0.0, field) for field in (turn, across, table.lift * lifted))


def _slant(table: LidSlant, edge: _Curve, place: Doubles) -> Doubles:
    """The turn of the upper lid: one bow upward over its inner half and one downward over its outer half."""
    inner, outer = edge.points[[0, -1], 0]
    part = np.clip((place - inner) / (outer - inner), 0.0, 1.0)
    turn = np.where(part < 0.5, table.inner_deg, table.outer_deg)
    return np.radians(turn) * np.sin(2.0 * np.pi * part)


def _sinking(edge: _Curve, slit: _Slit, place: Doubles, depth: float) -> Doubles:
    """The turn by which the outer corner of the eye sinks with the closing, fading out along the lids."""
    inner, outer = edge.points[[0, -1], 0]
    return -depth / slit.met_reach * falloff((outer - place) / (outer - inner), 0.0, _CORNER)


def _meet(arms: Doubles, ring: RingHalves, motion: LidMotion, sink: Doubles, fields: dict[str, Doubles]) -> None:
    """Give a ring inside the edge its own line where its halves meet."""
    edges = _curves(arms, ring)
    sunk = {"close": 1.0, "meet_higher": -1.0, "shrink": 0.0, "shrink_higher": 0.0}
    for half, upper in ((ring.upper, True), (ring.lower, False)):
        slit = _Slit.at(edges, arms[half, 0], np.full(len(half), upper), motion)
        for (name, share), move in zip(sunk.items(), slit.moves(), strict=True):
            fields[name][half] = move + share * sink[half]


def _sphincter(model: HeadModel, arms: Doubles, free: Doubles) -> tuple[Doubles, Doubles]:
    """Waters' sphincter with a smooth rim: lateral and upward way in metres of a full contraction, z unchanged."""
    unit, ring = model.landmarks.eye_separation, model.eyelids.sphincter
    canthi = [model.landmarks[f"{name}_canthus_{SIDES[0]}"] for name in ("inner", "outer")]
    middle = np.mean(canthi, axis=0) - model.eye_centre(SIDES[0])
    temple, nose, height = (unit * axis for axis in ring.half_axes)
    x, y = arms[:, 0] - middle[0], (arms[:, 1] - middle[1]) / height
    x = x / np.where(x > 0, temple, nose)
    distance = np.hypot(x, y)
    strength = unit * free * falloff(distance, _RISE, 1.0) * (arms[:, 2] > -model.eyes.radius)
    x, y = x / np.maximum(distance, 1e-6), y / np.maximum(distance, 1e-6)
    across = -ring.inward * np.where(x > 0, 1.0, _NASAL) * x * strength
    return across, -np.where(y > 0, ring.down, ring.up) * y * strength
