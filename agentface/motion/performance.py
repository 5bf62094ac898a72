""":class:`Performance`: poses over time, what every reader makes and every writer takes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import FASTEST_HZ, Doubles, Floats, check_rate
from agentface.errors import Fault, InvalidValueError
from agentface.parameters import COUNT, NAMES, check_poses

LONGEST_S = 24 * 3600.0
HOLD_S = 0.5
"""So long a stream that stops is waited for, with the face as the last frame left it."""
LET_GO_S = 0.5
"""So long the face then takes to let go of it."""
_ROUNDED_S = 1.5e-3
_COMMON_HZ = (25.0, 30.0, 60.0, 24.0, 50.0, 100.0, 120.0, 30000 / 1001, 60000 / 1001, 24000 / 1001)
_SAME_S = 1e-6
"""A time this close to a frame's is that frame's: sums of frame times are not exact."""


@dataclass(frozen=True, eq=False)
class Performance:
    """Poses over time, at regular or irregular times; what lies between them is joined smoothly by :meth:`sample`.

    Attributes:
        times_s: ``(T,)`` float64, seconds, increasing, the first at least 0, the last at most ``LONGEST_S``; T >= 1.
        poses: ``(T, COUNT)`` float32, in the units and ranges of ``PARAMETERS``.
        weights: ``(T, COUNT)`` or ``(1, COUNT)`` float32, 0..1: how much of each parameter it moves; what it does not
            move is left to the other channels.
        rate_hz: frames a second where the times are regular; None where they are not.
        sound: the file that is heard with it; None for silence.
        name: what its author called it.
        notes: places of the file that it was read from where it is not all that the file says.

    Raises InvalidValueError for arrays of another shape, for values that are not finite or outside of their range, and
    for times that do not increase.
    """

    times_s: Doubles
    poses: Floats
    weights: Floats
    rate_hz: float | None = None
    sound: Path | None = None
    name: str = ""
    notes: tuple[Fault, ...] = ()

    def __post_init__(self) -> None:
        times = np.array(self.times_s, np.float64)
        poses = np.array(self.poses, np.float32)
        weights = np.array(self.weights, np.float32)
        count = len(times) if times.ndim == 1 else 0
        if not count:
            raise InvalidValueError("times_s", "one time or more, shape (T,)", times.shape)
        if poses.shape != (count, COUNT):
            raise InvalidValueError("poses", f"the shape {(count, COUNT)}", poses.shape)
        if weights.shape not in ((count, COUNT), (1, COUNT)):
            raise InvalidValueError("weights", f"the shape {(count, COUNT)} or {(1, COUNT)}", weights.shape)
        _check_times(times)
        check_poses(poses)
        if not ((weights >= 0.0) & (weights <= 1.0)).all():
            got = weights[~((weights >= 0.0) & (weights <= 1.0))][0]
            raise InvalidValueError("weights", "numbers in 0..1", float(got))
        if self.rate_hz is not None:
            check_rate("rate_hz", self.rate_hz)
        for name, array in (("times_s", times), ("poses", poses), ("weights", weights)):
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @classmethod
    def regular(cls, rate_hz: float, poses: Floats, weights: Floats, **more: Any) -> Performance:
        """One whose frame ``k`` stands at ``k / rate_hz`` seconds."""
        times = np.arange(len(poses)) / check_rate("rate_hz", rate_hz)
        return cls(times, poses, weights, rate_hz=rate_hz, **more)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Performance):
            return NotImplemented
        arrays = ("times_s", "poses", "weights")
        same = all(np.array_equal(getattr(self, name), getattr(other, name)) for name in arrays)
        return same and (self.rate_hz, self.sound, self.name) == (other.rate_hz, other.sound, other.name)

    def __hash__(self) -> int:
        return hash((self.times_s.tobytes(), self.name))

    def __len__(self) -> int:
        return len(self.times_s)

    @property
    def duration_s(self) -> float:
        """Until the last frame."""
        return float(self.times_s[-1])

    @property
    def length_s(self) -> float:
        """Until the face has let go of it."""
        return self.duration_s + LET_GO_S

    @property
    def moved(self) -> tuple[str, ...]:
        """The parameters of which it moves anything."""
        return tuple(np.array(NAMES)[self.weights.any(axis=0)].tolist())

    def sample(self, times_s: npt.ArrayLike) -> tuple[Doubles, Doubles]:
        """Values and weights at any times ``(...)``: each ``(..., COUNT)`` float64.

        A frame is hit exactly. Between frames each value follows the cubic of Fritsch and Butland (SIAM J. Sci. Stat.
        Comput. 5, 1984): its speed has no jump, and it never leaves the range of the two frames that it is between.
        Before the first frame it is that frame, after the last one that.
        """
        at = np.asarray(times_s, np.float64)
        frame, part, step = self._place(at.ravel())
        values = self._joined(self.poses, frame, part, step).reshape(*at.shape, COUNT)
        if len(self.weights) == 1:
            return values, np.broadcast_to(self.weights[0].astype(np.float64), values.shape)
        return values, self._joined(self.weights, frame, part, step).reshape(*at.shape, COUNT)

    def _place(self, at: Doubles) -> tuple[npt.NDArray[np.intp], Doubles, Doubles]:
        """The frame before each time, how far on towards the next, 0..1, and the seconds between the two."""
        times = self.times_s
        if len(times) == 1:
            return np.zeros(len(at), np.intp), np.zeros(len(at)), np.ones(len(at))
        at = np.clip(at, times[0], times[-1])
        frame = np.clip(np.searchsorted(times, at, side="right") - 1, 0, len(times) - 2)
        step = times[frame + 1] - times[frame]
        after = at - times[frame]
        near = np.minimum(_SAME_S, 0.25 * step)
        after = np.where(after < near, 0.0, np.where(after > step - near, step, after))
        return frame, after / step, step

    def _joined(self, rows: Floats, frame: npt.NDArray[np.intp], part: Doubles, step: Doubles) -> Doubles:
        if len(rows) == 1:
            return rows[frame].astype(np.float64)
        before, after = rows[frame].astype(np.float64), rows[frame + 1].astype(np.float64)
        u, h = part[:, None], step[:, None]
        leaving, arriving = self._slope(rows, frame), self._slope(rows, frame + 1)
        between = (after - before) * (u * u * (3.0 - 2.0 * u))
        curved = h * u * (1.0 - u) * ((1.0 - u) * leaving - u * arriving)
        value = np.where(u < 1.0, before + between + curved, after)
        return np.clip(value, np.minimum(before, after), np.maximum(before, after))

    def _slope(self, rows: Floats, frame: npt.NDArray[np.intp]) -> Doubles:
        """The change a second at some frames, ``(N, COUNT)``: 0 at a turn, limited so that nothing overshoots."""
        last = len(rows) - 1
        middle = np.clip(frame, 1, max(last - 1, 1))
        if last == 1:  # a straight line
            middle = np.zeros_like(frame)
            return self._secant(rows, middle)[0]
        (left, h0), (right, h1) = self._secant(rows, middle - 1), self._secant(rows, middle)
        first, second = 2.0 * h1 + h0, h1 + 2.0 * h0
        with np.errstate(divide="ignore", invalid="ignore"):
            mean = (first + second) / (first / left + second / right)
        slope = np.where(left * right > 0.0, mean, 0.0)
        starts, ends = (frame == 0)[:, None], (frame == last)[:, None]
        slope = np.where(starts, _end_slope(left, right, h0, h1), slope)
        return np.where(ends, _end_slope(right, left, h1, h0), slope)

    def _secant(self, rows: Floats, frame: npt.NDArray[np.intp]) -> tuple[Doubles, Doubles]:
        step = (self.times_s[frame + 1] - self.times_s[frame])[:, None]
        return (rows[frame + 1].astype(np.float64) - rows[frame]) / step, step


def rate_of(times_s: Doubles) -> float | None:
    """Frames a second of times that are regular as far as milliseconds show it; None for others."""
    span = float(times_s[-1] - times_s[0])
    if len(times_s) < 2 or not (len(times_s) - 1) / span <= FASTEST_HZ:
        return None
    for rate in (*_COMMON_HZ, (len(times_s) - 1) / span):
        off = np.abs(times_s - times_s[0] - np.arange(len(times_s)) / rate)
        if off.max() <= _ROUNDED_S:
            return rate
    return None


def _end_slope(near: Doubles, far: Doubles, h0: Doubles, h1: Doubles) -> Doubles:
    """The slope of the parabola through three frames at its end, limited likewise."""
    slope = ((2.0 * h0 + h1) * near - h0 * far) / (h0 + h1)
    slope = np.where(slope * near <= 0.0, 0.0, slope)
    return np.where((near * far <= 0.0) & (np.abs(slope) > 3.0 * np.abs(near)), 3.0 * near, slope)


def _check_times(times: Doubles) -> None:
    inside = (times >= 0.0) & (times <= LONGEST_S)
    if not inside.all():
        raise InvalidValueError("times_s", f"seconds in 0..{LONGEST_S:g}", float(times[~inside][0]))
    late = np.flatnonzero(np.diff(times) <= 0.0)
    if len(late):
        frame = int(late[0]) + 1
        raise InvalidValueError("times_s", f"more than {times[frame - 1]:g} at frame {frame}", float(times[frame]))
