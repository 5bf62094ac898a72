"""The outside of the head as one radius a direction: what hair lies on and never enters."""

from __future__ import annotations

from copy import copy

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.head.model import HeadModel
from agentface.view.hair.ribbons import unit_rows

_TURNS, _LEVELS = 96, 72
_FALL = 0.11
"""Metres below the centre that count as much as one quarter turn above it."""
_EAR_LOBE = 1.45
_SAMPLES = 60_000
_SMOOTHER = 8
"""Times that it is smoothed to lose what is small."""
_STILL = 0.0005
"""Metres up to which a shape leaves the skin where it is."""


class Hull:
    """Radii over the turn about the vertical axis and over the level: 0 the crown, 1 the centre's height, then down.

    Above the centre a radius is measured from the centre, below it from the vertical axis.
    """

    def __init__(self, model: HeadModel, *, ears: bool, moving: bool = False) -> None:
        """With ``ears`` or without; ``moving``: with all places to which the face's shapes take the skin."""
        self.centre = self.centre_of(model)
        chosen = model.triangles
        if not ears:
            chosen = chosen[model.material[chosen, 3].max(1) < 0.3]
        rng = np.random.default_rng(0)
        drawn, weights = spread_over(model.vertices, chosen, _SAMPLES, rng)
        table, corners = np.zeros((_LEVELS, _TURNS)), chosen[drawn]
        self._reach(table, (model.vertices[corners] * weights[..., None]).sum(1))
        for shape in model.shapes.values() if moving else ():
            moved = shape.dense(len(model.vertices))
            touched = np.abs(moved[corners]).max(axis=(1, 2)) > _STILL
            posed = (model.vertices + moved)[corners[touched]]
            self._reach(table, (posed * weights[touched][..., None]).sum(1))
        self._table = _smooth(_filled(table))

    def _reach(self, table: Doubles, points: Doubles | Floats) -> None:
        """Raise the radii in ``table`` to those of ``points (N, 3)`` m."""
        turn, level, reach = self._polar(points)
        rows = np.clip((level / 2.6 * _LEVELS).astype(int), 0, _LEVELS - 1)
        np.maximum.at(table, (rows, ((turn / (2 * np.pi)) % 1 * _TURNS).astype(int) % _TURNS), reach)

    @staticmethod
    def centre_of(model: HeadModel) -> Doubles:
        """``(3,)`` m: what radii are measured from."""
        unit, back = model.landmarks.eye_separation, float(model.vertices[:, 2].min())
        return np.array([0.0, 0.36 * unit, back + 1.72 * unit])

    def smoother(self) -> Hull:
        """The same head without its ears' edges."""
        other = copy(self)
        other.soften()
        return other

    def soften(self) -> None:
        """Lose what is small."""
        for _ in range(_SMOOTHER):
            self._table = _smooth(self._table)

    def push_out(self, points: Doubles, height: Doubles | float) -> Doubles:
        """``points (..., 3)`` moved outward to at least ``height`` metres above the hull."""
        turn, level, reach = self._polar(points)
        short = np.maximum(self._radius(turn, level) + height - reach, 0.0)
        return np.asarray(points + self.outward(points) * short[..., None])

    def hold(self, points: Doubles, low: Doubles | float, slack: Doubles | float) -> Doubles:
        """``points (..., 3)`` kept ``low`` to ``low + slack`` metres above the hull; free below the ears."""
        turn, level, reach = self._polar(points)
        least = self._radius(turn, level) + low
        most = least + slack + 0.08 * np.maximum(level - _EAR_LOBE, 0.0)
        return np.asarray(points + self.outward(points) * (np.clip(reach, least, most) - reach)[..., None])

    def height(self, points: Doubles) -> Doubles:
        """``(...)`` metres of each point above the hull; negative inside."""
        turn, level, reach = self._polar(points)
        return np.asarray(reach - self._radius(turn, level))

    def outward(self, points: Doubles) -> Doubles:
        """``(..., 3)`` unit vectors away from the centre, level below it."""
        away = np.asarray(points - self.centre, np.float64)
        away[..., 1] = np.maximum(away[..., 1], 0.0)
        return unit_rows(away)

    def sideways(self, points: Doubles) -> Doubles:
        """``(N, R, 3)``: across hair that runs along ``points (N, R, 3)`` m, level with the head."""
        return unit_rows(np.cross(np.gradient(points, axis=1), self.outward(points)))

    def _polar(self, points: Doubles | Floats) -> tuple[Doubles, Doubles, Doubles]:
        x, y, z = np.moveaxis(np.asarray(points - self.centre, np.float64), -1, 0)
        flat = np.hypot(x, z)
        above = np.maximum(y, 0.0)
        level = np.where(y > 0, np.arctan2(flat, above) / (0.5 * np.pi), 1.0 - y / _FALL)
        return np.arctan2(x, z), level, np.hypot(flat, above)

    def _radius(self, turn: Doubles, level: Doubles) -> Doubles:
        column = (turn / (2 * np.pi)) % 1 * _TURNS - 0.5
        row = np.clip(level / 2.6 * _LEVELS - 0.5, 0, _LEVELS - 1.001)
        c, r = np.floor(column).astype(int), np.floor(row).astype(int)
        u, v = column - c, row - r
        table, right, left = self._table, (c + 1) % _TURNS, c % _TURNS
        upper = (1 - u) * table[r, left] + u * table[r, right]
        lower = (1 - u) * table[r + 1, left] + u * table[r + 1, right]
        return np.asarray((1 - v) * upper + v * lower)


def spread_over(
    vertices: Floats, triangles: np.typing.NDArray[np.int32], count: int, rng: np.random.Generator
) -> tuple[np.typing.NDArray[np.intp], Doubles]:
    """``count`` places drawn evenly over triangles: the triangle of each and its weights ``(count, 3)``."""
    a, b, c = (vertices[triangles[:, corner]].astype(np.float64) for corner in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    drawn = rng.choice(len(triangles), count, p=area / area.sum())
    u, v = np.sqrt(rng.random(count)), rng.random(count)
    return drawn, np.stack([1 - u, u * (1 - v), u * v], axis=1)


def _filled(table: Doubles) -> Doubles:
    """Empty cells get the mean of their neighbours, from the filled ones outward."""
    for _ in range(sum(table.shape)):
        empty = table == 0
        if not empty.any():
            break
        shifted = [np.roll(table, turn, 1) for turn in (-1, 1)]
        shifted += [np.concatenate([table[1:], table[-1:]]), np.concatenate([table[:1], table[:-1]])]
        total, count = sum(shifted), sum((part > 0).astype(float) for part in shifted)
        table = np.where(empty & (count > 0), total / np.maximum(count, 1), table)
    return table


def _smooth(table: Doubles) -> Doubles:
    for _ in range(2):
        table = 0.5 * table + 0.25 * (np.roll(table, 1, 1) + np.roll(table, -1, 1))
        padded = np.concatenate([table[:1], table, table[-1:]])
        table = 0.5 * table + 0.25 * (padded[2:] + padded[:-2])
    # the crown is one point
    table[0] = table[0].mean()
    return table
