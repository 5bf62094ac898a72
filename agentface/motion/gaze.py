"""Where the eyes look: along angles in the head, or at a point, which they hold while the head turns."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol

from agentface.conventions import Doubles
from agentface.motion.envelope import Envelope
from agentface.motion.eyesight import Eyesight, Point
from agentface.motion.figures import LifeTable
from agentface.motion.turns import TurnChannel
from agentface.parameters import parameter

_NEAR_S = 1e-4
"""Over so long a speed is measured."""
_ELSEWHERE = math.radians(3.0)
"""What is nearer to what is looked at is the same thing, which moves."""
_JOINED = ("head_yaw", "head_pitch")


class HeadMover(Protocol):
    """What turns the head without being told to look elsewhere: sway, nods."""

    @property
    def turning(self) -> bool:
        """Whether it may turn the head now."""

    @property
    def head(self) -> Sequence[float]:
        """How far it turns yaw and pitch now, in radians."""


class GazeChannel(TurnChannel):
    """The angles of the eyes, and what the head adds to them.

    By angles, the eyes go with a head that is told to turn, and hold still against one that sways and nods (the
    vestibulo-ocular reflex). At a point, they stay on it whatever turns the head; if it is too far aside for the eyes,
    the head joins them a little later, and they come back as it arrives.

    Args:
        head: the channel that turns the head when it is told to.
        table: has the figures of eyes and head together, and of how long a leap of the eyes takes.
    """

    def __init__(self, head: TurnChannel, table: LifeTable, *, compiled: bool = False) -> None:
        super().__init__("gaze", compiled=compiled)
        self._eyes = self.names
        self.names = (*self._eyes, *_JOINED)
        self.movers: list[HeadMover] = []
        self._head, self._figures, self._saccades = head, table.look_at, table.saccades
        self._sight: Eyesight | None = None
        self._point: Point | None = None
        limits = [parameter(name) for name in self._eyes]
        span = [known.high - known.low for known in limits]
        self._rest = Envelope(len(span), [-reach for reach in span], span, compiled=compiled)
        reach = [math.radians(limit) for limit in self._figures.head_limit_deg]
        furthest = [2.0 * limit for limit in reach]
        self._joined = Envelope(len(_JOINED), [-far for far in furthest], furthest, compiled=compiled)
        self._reach = reach
        self._head_for: tuple[float, ...] = ()
        self._joins_in, self._joins_at_once = math.inf, False
        self._turned: Point = (0.0, 0.0, 0.0)
        self._is_told = False
        self.looks = 0
        """How often it was told to look elsewhere."""

    @property
    def point(self) -> Point | None:
        """What is looked at; None where it is angles."""
        return self._point

    @property
    def steady(self) -> bool:
        """Whether the eyes have to be told how the head is turned."""
        return self._point is not None or any(mover.turning for mover in self.movers)

    @property
    def targets(self) -> dict[str, float]:
        """The angle in radians that each of the eyes' parameters goes to."""
        if self._sight is None or self._point is None:
            return dict(zip(self._eyes, self.angles.target.tolist(), strict=True))
        yaw, pitch, roll = self._head.angles.target.tolist()
        joined = self._joined.target
        aims = self._sight.aim(self._point, yaw + float(joined[0]), pitch + float(joined[1]), roll)
        return dict(zip(self._eyes, aims, strict=True))

    def look_at(self, sight: Eyesight, point: Point, fade: float | None = None) -> None:
        """Look at a point in metres, in the axes of the head when it is not turned.

        The eyes take ``fade`` seconds, those of a leap so far when None; with 0, eyes and head are there at once.
        """
        if point == self._point and fade != 0.0:
            return
        shown, speed = self._shown(), self._speed()
        self._sight, self._point = sight, point
        way = math.dist(shown[:2], self._aim()[:2])
        if way > _ELSEWHERE:
            self.looks += 1
        if fade is None:
            fade = self._saccades.shortest_s + self._saccades.per_degree_s * math.degrees(way)
        self._join(at_once=fade == 0.0)
        if fade == 0.0:
            self._rest.move(0.0, 0.0)
            return
        aim, moving = self._aim(), self._aim_speed()
        self._rest.glide(
            [one - other for one, other in zip(shown, aim, strict=True)],
            [one - other for one, other in zip(speed, moving, strict=True)],
            fade,
        )

    def turn(self, angles: tuple[float, ...], fade: float) -> None:
        """Turn to ``angles`` in radians, in the head."""
        self.looks += 1
        self._leave_point(angles, fade)
        self.angles.move(angles, fade)

    def turn_one(self, name: str, angle: float, fade: float) -> None:
        """Turn one parameter to ``angle`` in radians; the others go on to where they went."""
        angles = tuple({**self.targets, name: angle}.values())
        self._leave_point(angles, fade)
        super().turn_one(name, angle, fade)

    def release(self, fade: float) -> None:
        """Look straight ahead."""
        self._leave_point((0.0,) * len(self._eyes), fade)
        super().release(fade)

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        self._is_told = False
        if self._point is not None and tuple(self._head.angles.target.tolist()) != self._head_for:
            self._join(at_once=False)
        self.angles.advance(dt)
        self._rest.advance(dt)
        if self._joins_in <= dt:
            self._joined.advance(self._joins_in)
            dt -= self._joins_in
            self._turn_head()
        self._joins_in -= dt
        self._joined.advance(dt)

    def head_is(self, yaw: float, pitch: float, roll: float) -> None:
        """The head's angles as all channels together make them now, before the eyes' are asked for."""
        self._turned, self._is_told = (yaw, pitch, roll), True

    def write(self, values: Doubles, weights: Doubles) -> bool:
        """What the head adds, and the angles: steady eyes keep theirs until they are told how the head is turned."""
        steady = self.steady
        if not steady and self.angles.resting and self._joined.resting:
            return False
        if self._is_told or not steady:
            values[: len(self._eyes)] = self._shown()
        values[len(self._eyes) :] = self._joined.value
        return True

    def _shown(self) -> list[float]:
        if self._point is not None:
            return [aim + rest for aim, rest in zip(self._aim(), self._rest.value.tolist(), strict=True)]
        shown: list[float] = self.angles.value.tolist()
        for mover in self.movers:
            for axis, turned in enumerate(mover.head):
                shown[axis] -= turned
        return shown

    def _speed(self) -> list[float]:
        """The change a second of what is shown, but for what the movers make of it."""
        if self._point is None:
            return list(self.angles.velocity.tolist())
        return [one + other for one, other in zip(self._aim_speed(), self._rest.velocity.tolist(), strict=True)]

    def _aim(self, later: Sequence[float] = (0.0, 0.0, 0.0)) -> Point:
        assert self._sight is not None and self._point is not None  # noqa: S101, PT018 - for the type checker
        return self._sight.aim(self._point, *(angle + more for angle, more in zip(self._turned, later, strict=True)))

    def _aim_speed(self) -> list[float]:
        turning = [_NEAR_S * float(speed) for speed in self._head.angles.velocity]
        for axis, speed in enumerate(self._joined.velocity):
            turning[axis] += _NEAR_S * float(speed)
        if not any(turning):
            return [0.0] * len(self._eyes)
        return [(later - now) / _NEAR_S for later, now in zip(self._aim(turning), self._aim(), strict=True)]

    def _leave_point(self, angles: tuple[float, ...], fade: float) -> None:
        if self._point is None:
            return
        shown, speed = self._shown(), self._speed()
        for mover in self.movers:
            for axis, turned in enumerate(mover.head):
                shown[axis] += turned
        self._point = None
        self.angles.glide(shown, speed, fade, angles)
        self._join(at_once=fade == 0.0)

    def _join(self, *, at_once: bool) -> None:
        """Have the head begin to do its part in a moment, or turn it at once."""
        self._head_for = tuple(self._head.angles.target.tolist())
        self._joins_in = min(self._joins_in, self._figures.head_after_s)
        if at_once:
            self._joins_in = math.inf
            self._joined.move(self._wanted(), 0.0)

    def _turn_head(self) -> None:
        self._joins_in = math.inf
        wanted = self._wanted()
        way = math.hypot(*(goal - now for goal, now in zip(wanted, self._joined.value.tolist(), strict=True)))
        figures = self._figures
        self._joined.move(wanted, figures.head_s + figures.head_per_degree_s * math.degrees(way))

    def _wanted(self) -> tuple[float, float]:
        """How far the head has to turn beside what it is told, for the eyes to see the point with ease."""
        if self._sight is None or self._point is None:
            return 0.0, 0.0
        told = self._head_for
        aims, figures = self._sight.toward(self._point, *told)[:2], self._figures
        far = math.hypot(*(aim / limit for aim, limit in zip(aims, self._sight.hole, strict=True)))
        if far <= figures.head_beyond:
            return 0.0, 0.0
        part = min(figures.head_gain * (far - figures.head_beyond), far - figures.eyes_keep) / far
        yaw, pitch = (
            min(max(part * aim, min(0.0, -limit - angle)), max(0.0, limit - angle))
            for aim, limit, angle in zip(aims, self._reach, told, strict=False)
        )
        return yaw, pitch
