""":class:`Staging`: what the behaviors of BML blocks make of a face together, and what it goes back to."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Iterable, Mapping
from functools import cached_property
from typing import Protocol, TypeAlias

from agentface.bml.block import Aim, Nod, Show
from agentface.head.model import HeadModel
from agentface.motion.eyesight import Eyesight, Point
from agentface.requests import Gesture, LookAt, Request, SetActionUnit, SetEmotion, SetGaze, SetHead
from agentface.requests.gesture import LONGEST_S, SHORTEST_S

_Owner: TypeAlias = Hashable
_Key: TypeAlias = tuple[str | int, str | None]
"""An emotion, or an action unit and its side."""


class _Gaze(Protocol):
    """What a staging asks of the channel of the gaze."""

    @property
    def point(self) -> Point | None:
        """What is looked at; None where it is angles."""


class _Eyes(Protocol):
    """Channels, the gaze among them."""

    @property
    def gaze(self) -> _Gaze:
        """The channel of the gaze."""


class Staged(Protocol):
    """What a staging needs of its face."""

    @property
    def model(self) -> HeadModel:
        """The head."""

    @property
    def channels(self) -> _Eyes:
        """The channels by name."""

    @property
    def emotion(self) -> Mapping[str, float]:
        """Target intensities."""

    @property
    def mood(self) -> Mapping[str, float]:
        """What the emotions return to."""

    @property
    def turned_deg(self) -> Mapping[str, float]:
        """Where gaze and head go."""


class Staging:
    """What is shown, looked at and done for the behaviors that go on.

    Of several that show the same, the strongest counts; of several that look somewhere, the newest. When they end, the
    face goes back to what a shift has made its own, or to what it showed before.

    Args:
        face: what is moved.
        ask: asks something of it.
    """

    def __init__(self, face: Staged, ask: Callable[[Request], None]) -> None:
        self._face, self._ask = face, ask
        self._asked: dict[_Key, dict[_Owner, float]] = {}
        self._shifted: dict[_Key, float] = {}
        self._before: dict[_Key, float] = {}
        self._looks: dict[_Owner, Aim] = {}
        self._aim: Aim | None = None
        self._looked: Request | None = None
        self._head_aim: Aim | None = None
        self._head_before: tuple[float, float, float] | None = None
        self._nods: dict[_Owner, str] = {}

    def show(self, owner: _Owner, shows: Iterable[Show], fade: float) -> None:
        """Show something for ``owner``, within ``fade`` seconds."""
        for show in shows:
            key = show.what, show.side
            self._note(key)
            asked = self._asked.setdefault(key, {})
            asked[owner] = max(asked.get(owner, 0.0), show.level)
            self._tell(key, fade)

    def let_go(self, owner: _Owner, fade: float) -> None:
        """Show it no longer."""
        for key in [key for key, asked in self._asked.items() if owner in asked]:
            del self._asked[key][owner]
            self._tell(key, fade)

    def shift(self, shows: Iterable[Show], fade: float) -> None:
        """Have the face go back to this from now on."""
        gone, self._shifted = self._shifted, {}
        for show in shows:
            key = show.what, show.side
            if key not in gone:
                self._note(key)
            self._shifted[key] = max(self._shifted.get(key, 0.0), show.level)
        for key in gone | self._shifted:
            self._tell(key, fade)

    def look(self, owner: _Owner, aim: Aim, fade: float) -> None:
        """Look somewhere for ``owner``."""
        self._note_look()
        self._looks[owner] = aim
        self._look(aim, fade)

    def look_back(self, owner: _Owner, fade: float) -> None:
        """Look there no longer."""
        newest = next(reversed(self._looks), None) == owner
        if self._looks.pop(owner, None) is None or not newest:
            return
        aim = next(reversed(self._looks.values()), None) or self._aim
        if aim is not None:
            self._look(aim, fade)
        else:
            self._look_as_before(fade)

    def shift_look(self, aim: Aim, fade: float) -> None:
        """Look there from now on, whenever nothing else is looked at."""
        self._note_look()
        self._aim = aim
        if not self._looks:
            self._look(aim, fade)

    def shift_head(self, aim: Aim, fade: float) -> None:
        """Turn the head there from now on."""
        self._note_head()
        self._head_aim = aim
        self._ask(SetHead(*_turned(aim, 1.0), 0.0, fade))

    def nod(self, owner: _Owner, nod: Nod, length_s: float) -> None:
        """Do a gesture once."""
        self._nods[owner] = nod.gesture
        self._ask(Gesture(nod.gesture, nod.amount, min(max(length_s, SHORTEST_S), LONGEST_S)))

    def nodded(self, owner: _Owner) -> None:
        """It is done."""
        self._nods.pop(owner, None)

    def end_nod(self, owner: _Owner) -> None:
        """End it before its time."""
        gesture = self._nods.pop(owner, None)
        if gesture is not None:
            self._ask(Gesture(gesture, 0.0))  # one of no strength takes the place of the one that goes on

    def clear(self, fade: float) -> None:
        """Go back to what was before all of it."""
        keys = self._asked.keys() | self._shifted.keys()
        self._asked, self._shifted = {}, {}
        for key in sorted(keys, key=str):
            self._tell(key, fade)
        looks = bool(self._looks) or self._aim is not None
        self._looks, self._aim, self._head_aim = {}, None, None
        if looks:
            self._look_as_before(fade)
        self._head_back(fade)
        for owner in tuple(self._nods):
            self.end_nod(owner)

    def forget(self) -> None:
        """Somebody else has let go of everything."""
        self._asked, self._shifted, self._before, self._looks, self._nods = {}, {}, {}, {}, {}
        self._aim = self._head_aim = self._looked = self._head_before = None

    def felt(self, emotion: str, level: float) -> None:
        """Somebody else has told the face what to feel: to this it goes back."""
        if (emotion, None) in self._before:
            self._before[emotion, None] = level

    def _note(self, key: _Key) -> None:
        """Remember what the face goes back to."""
        if key not in self._before:
            self._before[key] = self._face.emotion[key[0]] if isinstance(key[0], str) else 0.0

    def _tell(self, key: _Key, fade: float) -> None:
        asked, (what, side) = self._asked.get(key), key
        level = max((asked or {}).values(), default=0.0)
        rest = self._shifted.get(key, self._before.get(key, 0.0))
        if not asked:
            self._asked.pop(key, None)
            if key not in self._shifted:
                self._before.pop(key, None)
        level = max(level, rest)
        if isinstance(what, str):
            back = not asked and key not in self._shifted and level == self._face.mood[what]
            self._ask(SetEmotion(what, level, fade, 0.0 if back else None))
        else:
            self._ask(SetActionUnit(what, level, side, fade))

    def _note_look(self) -> None:
        if self._looks or self._aim is not None:
            return
        point, turned = self._face.channels.gaze.point, self._face.turned_deg
        self._looked = SetGaze(turned["gaze_yaw"], turned["gaze_pitch"]) if point is None else LookAt.of(point)

    def _note_head(self) -> None:
        if self._head_before is None:
            turned = self._face.turned_deg
            self._head_before = turned["head_yaw"], turned["head_pitch"], turned["head_roll"]

    def _look(self, aim: Aim, fade: float) -> None:
        if aim.head_share:
            self._note_head()
            self._ask(SetHead(*_turned(aim, aim.head_share), 0.0, max(fade, _HEAD_FADE_S)))
        else:
            self._head_back(fade)
        self._ask(LookAt(*self._point(aim), fade))

    def _look_as_before(self, fade: float) -> None:
        self._head_back(fade)
        looked, self._looked = self._looked, None
        if isinstance(looked, LookAt):
            self._ask(LookAt(looked.x, looked.y, looked.z, fade))
        elif isinstance(looked, SetGaze):
            self._ask(SetGaze(looked.yaw_deg, looked.pitch_deg, fade))

    def _head_back(self, fade: float) -> None:
        fade = max(fade, _HEAD_FADE_S)
        if self._head_before is None:
            return
        if self._head_aim is not None:
            self._ask(SetHead(*_turned(self._head_aim, 1.0), 0.0, fade))
            return
        before, self._head_before = self._head_before, None
        self._ask(SetHead(*before, fade))

    def _point(self, aim: Aim) -> Point:
        yaw, pitch = math.radians(aim.yaw_deg), math.radians(aim.pitch_deg)
        _, up, forward = self._eye
        flat = aim.distance_m * math.cos(pitch)
        return flat * math.sin(yaw), up + aim.distance_m * math.sin(pitch), forward + flat * math.cos(yaw)

    @cached_property
    def _eye(self) -> Point:
        return Eyesight.of(self._face.model).eye


_HEAD_FADE_S = 0.3
"""The head turns no faster, whatever the eyes do."""
_FURTHEST_DEG = 60.0


def _turned(aim: Aim, share: float) -> tuple[float, float]:
    """Yaw and pitch of the head in degrees, as far as it turns."""
    yaw, pitch = (min(max(share * angle, -_FURTHEST_DEG), _FURTHEST_DEG) for angle in (aim.yaw_deg, aim.pitch_deg))
    return yaw, pitch
