""":class:`TrackerState`: what a tracker's messages say, until the next one says otherwise. No sockets here."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from agentface.conventions import check_finite
from agentface.errors import InvalidValueError
from agentface.head.arkit import ARKIT_SHAPES
from agentface.io.vmc.axes import turn_between
from agentface.io.vmc.names import presets_by_name, weights_by_name
from agentface.parameters import PARAMETERS
from agentface.vrm.expressions import PRESETS
from agentface.vrm.tracked import Tracked
from agentface.vrm.turns import STILL, Quaternion, eye_angles, head_angles, product, unit

PREFIX = "/VMC/"
OK, TIME, BONE, VALUE, APPLY = (f"{PREFIX}Ext/{name}" for name in ("OK", "T", "Bone/Pos", "Blend/Val", "Blend/Apply"))
USED = frozenset((OK, TIME, BONE, VALUE, APPLY))
"""The addresses that say something about a face."""
BONES = ("Head", "Neck", "LeftEye", "RightEye")
"""The bones that do, by the names of Unity's HumanBodyBones."""
_TURNED = math.radians(0.01)
"""An eye that is turned less looks ahead."""
_LOOKS = {name for name in (*ARKIT_SHAPES, *PRESETS) if name.lower().startswith(("eyelook", "look"))}
_RANGES = {kind: [(known.low, known.high) for known in PARAMETERS if known.kind == kind] for kind in ("head", "gaze")}


@dataclass(slots=True)
class TrackerCounts:
    """What came, one by one: messages that were used, and the others by why they were not.

    Attributes:
        used: messages that said something of the face.
        unused: the protocol's, of bones, shapes and devices that this face does not have.
        unknown: of other addresses.
        surplus: used ones with more arguments than they need.
        rejected: with too few arguments, or wrong ones.
        malformed: datagrams or messages that are no OSC.
        dropped: what came beyond the bounds of a frame.
    """

    used: int = 0
    unused: int = 0
    unknown: int = 0
    surplus: int = 0
    rejected: int = 0
    malformed: int = 0
    dropped: int = 0


@dataclass(slots=True)
class TrackerState:
    """The blend values that apply and those that wait for it, and the bones.

    The protocol tells capital letters from small ones. Values outside of 0..1 count as the nearer of these. Only the
    names that a face knows are kept.

    Attributes:
        axes: in which the bones come, one of ``AXES``.
        loaded: whether the tracker says that it has an avatar; None before it does.
        time_s: the tracker's own time; None likewise.
    """

    axes: str = "unity"
    counts: TrackerCounts = field(default_factory=TrackerCounts)
    loaded: bool | None = None
    time_s: float | None = None
    _waiting: dict[str, float] = field(default_factory=dict)
    _values: dict[str, float] = field(default_factory=dict)
    _bones: dict[str, Quaternion] = field(default_factory=dict)

    def take(self, address: str, arguments: Sequence[Any]) -> bool:
        """Take in a message to one of ``USED``; whether the face has to show something new.

        Raises InvalidValueError for too few arguments and for wrong ones, and then nothing has changed.
        """
        if address == VALUE:
            return self._take_value(*self._some(address, arguments, "s f", 2))
        if address == BONE:
            return self._take_bone(*self._some(address, arguments, "s 7f", 8))
        if address == APPLY:
            self._some(address, arguments, "", 0)
            self.counts.used += 1
            self._values |= self._waiting
            self._waiting.clear()
            return True
        if address == OK:
            self.loaded = bool(_number(self._some(address, arguments, "i", 1)[0]))
        else:
            self.time_s = _number(self._some(address, arguments, "f", 1)[0])
        self.counts.used += 1
        return False

    def forget(self) -> None:
        """The tracker is gone: the next one begins anew."""
        for known in (self._waiting, self._values, self._bones):
            known.clear()
        self.loaded = self.time_s = None

    def frame(self) -> Tracked:
        """What the face has to show. Eyes look as their bones do, or, where these look ahead, as weights say."""
        pairs = self._values.items()
        weights, expressions = (tuple(pair for pair in pairs if pair[0] in known) for known in (ARKIT_SHAPES, PRESETS))
        return Tracked(weights, expressions, self._head(), self._gaze())

    def _some(self, address: str, arguments: Sequence[Any], form: str, count: int) -> Sequence[Any]:
        if len(arguments) < count:
            raise InvalidValueError(address, f"{count} arguments ({form})", len(arguments))
        self.counts.surplus += len(arguments) > count
        return arguments[:count]

    def _take_value(self, name: Any, value: Any) -> bool:
        if not isinstance(name, str):
            raise InvalidValueError(VALUE, "a name", name)
        number = min(max(_number(value), 0.0), 1.0)
        known = presets_by_name().get(name) or weights_by_name().get(name)
        if known is None:
            self.counts.unused += 1
            return False
        self.counts.used += 1
        self._waiting[known] = number
        return False

    def _take_bone(self, name: Any, *pose: Any) -> bool:
        if not isinstance(name, str):
            raise InvalidValueError(BONE, "a name", name)
        x, y, z, w = [_number(value) for value in pose][3:]
        if name not in BONES:
            self.counts.unused += 1
            return False
        turn = unit((x, y, z, w))
        if turn is None:
            raise InvalidValueError(f"{BONE} {name}", "a quaternion that turns", (x, y, z, w))
        self.counts.used += 1
        self._bones[name] = turn_between(self.axes, turn)
        return True

    def _head(self) -> tuple[float, float, float] | None:
        if not {"Head", "Neck"} & self._bones.keys():
            return None
        turn = product(self._bones.get("Neck", STILL), self._bones.get("Head", STILL))
        return _within("head", head_angles(turn))

    def _gaze(self) -> tuple[float, float, float] | None:
        eyes = [eye_angles(self._bones[name]) for name in ("LeftEye", "RightEye") if name in self._bones]
        if not eyes:
            return None
        (left, up), (right, other_up) = eyes[0], eyes[-1]
        if max(map(abs, (left, up, right, other_up))) < _TURNED and _LOOKS & self._values.keys():
            return None
        return _within("gaze", (0.5 * (left + right), 0.5 * (up + other_up), 0.5 * (right - left)))


def _within(kind: str, angles: tuple[float, float, float]) -> tuple[float, float, float]:
    """Angles in radians as far as head or eyes turn."""
    first, second, third = (
        min(max(angle, low), high) for angle, (low, high) in zip(angles, _RANGES[kind], strict=True)
    )
    return first, second, third


def _number(value: Any) -> float:
    return check_finite("argument", value)
