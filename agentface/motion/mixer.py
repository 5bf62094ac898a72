"""The channels together: one pose of what all of them want."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, MutableMapping
from dataclasses import replace
from typing import TypeVar

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.kernel import can_compile
from agentface.motion.action_units import ActionUnitChannel
from agentface.motion.blending import Claim, Claims, blend_in_numpy
from agentface.motion.blink import BlinkChannel
from agentface.motion.channel import Channel, Rank
from agentface.motion.conflicts import Conflicts, default_conflicts
from agentface.motion.course import EmotionRules
from agentface.motion.emotion import EmotionChannel
from agentface.motion.faps import FapChannel
from agentface.motion.figures import LifeTable, default_life
from agentface.motion.gaze import GazeChannel
from agentface.motion.gestures.channel import GestureChannel
from agentface.motion.gestures.gesture import GestureForm
from agentface.motion.gestures.table import all_gestures
from agentface.motion.life.channel import LifeChannel
from agentface.motion.muscles import MuscleChannel
from agentface.motion.playing import PerformanceChannel
from agentface.motion.sides import drawn_lags
from agentface.motion.speech import SpeechChannel
from agentface.motion.turns import TurnChannel
from agentface.parameters import COUNT, HIGH, LOW, NEUTRAL, PARAMETERS, WAYS, FacePose, Way, parameter

_Channel = TypeVar("_Channel", bound=Channel)
_NEUTRAL, _LOW, _HIGH = (limits.astype(np.float64) for limits in (NEUTRAL, LOW, HIGH))
_HEADS = [known.index for known in PARAMETERS if known.kind == "head"]
_HEAD = slice(_HEADS[0], _HEADS[-1] + 1)
_HEAD_LOW, _HEAD_HIGH = _LOW[_HEAD], _HIGH[_HEAD]


class _Layer:
    """A channel with its rank; ``values`` and ``weights`` are what it wants now, if ``wants``."""

    def __init__(self, channel: Channel, rank: Rank) -> None:
        self.channel, self.rank = channel, rank
        self.names = tuple(channel.names)
        self.values: Doubles = np.zeros(len(self.names))
        self.weights: Doubles = np.ones(len(self.names))

    def move_to(self, wanted: Doubles) -> None:
        """Keep what it wants in ``wanted (2, len(names))`` from now on."""
        wanted[0], wanted[1] = self.values, self.weights
        self.values, self.weights = wanted

    def write(self) -> bool:
        """Ask the channel; whether it wants anything now."""
        return self.channel.write(self.values, self.weights) is not False


class Mixer(MutableMapping[str, Channel]):
    """Channels by name; each is blended over those of lower priority, by the ways and priorities of its rank.

    The face's own are ``emotion``, ``gaze``, ``head``, ``action_units``, ``performance``, ``faps``, ``speech``,
    ``life``, ``gestures``, ``blink`` and ``muscles``, also to be had as attributes; they stay. A program adds others,
    ``mixer["breath"] = channel`` or :meth:`add`, and deletes them again; a face shows it from its next step on.

    Args:
        rules: what makes contractions of emotions.
        gains: ``(COUNT,)``, what each side of the face makes of what an emotion wants of both; 1 when None.
        conflicts: the channels' ranks; those of ``rules/conflicts.yaml`` when None.
        compiled: False for numpy instead of compiled kernels.
        random: of everything random in the motion.
        life: the figures of a living face; those of ``rules/life.yaml`` when None.
        gestures: by name; those of ``rules/gestures.yaml`` and the user's when None.
    """

    def __init__(
        self,
        rules: EmotionRules,
        gains: Floats | None = None,
        conflicts: Conflicts | None = None,
        *,
        compiled: bool = True,
        random: np.random.Generator | None = None,
        life: LifeTable | None = None,
        gestures: Mapping[str, GestureForm] | None = None,
    ) -> None:
        self._conflicts = conflicts or default_conflicts()
        self._layers: dict[str, _Layer] = {}
        self._blend: Callable[..., None] = _kernel() if compiled and can_compile() else blend_in_numpy
        self._values: Doubles = np.zeros(COUNT)
        self._shown = b""
        self._pose = FacePose()
        table, random = life or default_life(), random or np.random.default_rng(0)
        lags_s = drawn_lags(random, table.sides.lag_s)
        emotion = EmotionChannel(rules, gains, pairs=self._conflicts.pairs, lags_s=lags_s)
        self.emotion = self._own("emotion", emotion)
        head, blink = TurnChannel("head", compiled=compiled), BlinkChannel(compiled=compiled)
        self.gaze = self._own("gaze", GazeChannel(head, table, compiled=compiled))
        self.head = self._own("head", head)
        self.action_units = self._own("action_units", ActionUnitChannel(compiled=compiled))
        self.performance = self._own("performance", PerformanceChannel())
        self.faps = self._own("faps", FapChannel())
        self.speech = self._own("speech", SpeechChannel(compiled=compiled, yields=self._conflicts.yields))
        gesturing = GestureChannel(all_gestures() if gestures is None else gestures, lags_s)
        life_channel = LifeChannel(table, random, self.gaze, blink, gesturing, lags_s, compiled=compiled)
        self.life = self._own("life", life_channel)
        self.gestures = self._own("gestures", gesturing)
        self.speech.follow(self.life)
        self.gaze.movers = [self.life, self.gestures]
        self.blink = self._own("blink", blink)
        self.muscles = self._own("muscles", MuscleChannel(compiled=compiled))
        self._fixed = frozenset(self._layers)
        self._arrange()

    def add(self, name: str, channel: Channel, *, priority: int | None = None, way: Way | None = None) -> None:
        """Add a channel, in place of the one that a program has added under this name.

        Without ``priority`` and ``way`` it has those that ``rules/conflicts.yaml`` gives to others. Raises
        InvalidValueError and UnknownNameError, also for what the channel says of itself.
        """
        if not (isinstance(name, str) and name) or name in self._fixed:
            raise InvalidValueError("channel", "a name that is not one of the face's own", name)
        if priority is not None and priority not in range(101):
            raise InvalidValueError(f"channel {name}: priority", "a whole number in 0..100", priority)
        if way is not None and way not in WAYS:
            raise UnknownNameError("way", way, WAYS)
        rank = self._conflicts.rank(name)
        if priority is not None:
            rank = replace(rank, priority=priority, priorities={})
        if way is not None:
            rank = replace(rank, way=way, ways={})
        self._put(name, channel, rank)
        self._arrange()

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass in every channel."""
        for layer in self._layers.values():
            layer.channel.advance(dt)

    def release(self, fade: float) -> None:
        """Have every channel let go within ``fade`` seconds."""
        for layer in self._layers.values():
            layer.channel.release(fade)

    def pose(self) -> FacePose:
        """The parameters shown now, the same object while nothing changes.

        Raises InvalidValueError for a channel that wants what is no finite number.
        """
        self.emotion.apart = self.life.presence
        values, wants = self._values, self._wants
        for number, layer in enumerate(self._asked):
            wants[number] = layer.write()
        values[:] = _NEUTRAL
        self._blend(self._turning, wants, self._wanted, values)
        if self.gaze.steady:
            self.gaze.head_is(*np.minimum(np.maximum(values[_HEAD], _HEAD_LOW), _HEAD_HIGH).tolist())
            wants[self._gaze_layer] = self._asked[self._gaze_layer].write()
        shown = wants.tobytes() + self._wanted.tobytes()
        if shown == self._shown:
            return self._pose
        self._blend(self._others, wants, self._wanted, values)
        np.minimum(np.maximum(values, _LOW, out=values), _HIGH, out=values)
        try:
            self._pose = FacePose(values)
        except InvalidValueError:
            raise self._blame() from None
        self._shown = shown
        return self._pose

    def drivers(self) -> dict[str, list[str]]:
        """Which parameters each channel moves now, as far as another one does not replace them: names by channel.

        A channel that moves nothing is left out.
        """
        moved: dict[str, list[str]] = {}
        hidden: set[str] = set()
        order = {name: number for number, name in enumerate(self._layers)}
        wanted = {name: layer.write() for name, layer in self._layers.items()}
        rows = [
            (layer.rank.priority_of(parameter_), order[name], name, row, parameter_)
            for name, layer in self._layers.items()
            if wanted[name]
            for row, parameter_ in enumerate(layer.names)
        ]
        for _, _, name, row, parameter_ in sorted(rows, reverse=True):
            layer = self._layers[name]
            way, value, weight = layer.rank.way_of(parameter_), layer.values[row], layer.weights[row]
            idle = 1.0 if way == "scale" else 0.0
            if weight <= 0.0 or parameter_ in hidden or (way != "replace" and value == idle):
                continue
            moved.setdefault(name, []).append(parameter_)
            if way == "replace" and weight >= 1.0:
                hidden.add(parameter_)
        return {name: sorted(moved[name], key=lambda shown: parameter(shown).index) for name in order if name in moved}

    def __getitem__(self, name: str) -> Channel:
        if name not in self._layers:
            raise UnknownNameError("channel", name, tuple(self._layers))
        return self._layers[name].channel

    def __setitem__(self, name: str, channel: Channel) -> None:
        self.add(name, channel)

    def __delitem__(self, name: str) -> None:
        if self[name] and name in self._fixed:
            raise InvalidValueError("channel", "one that a program has added", name, "the face's own stay")
        del self._layers[name]
        self._arrange()

    def __iter__(self) -> Iterator[str]:
        return iter(self._layers)

    def __len__(self) -> int:
        return len(self._layers)

    def _own(self, name: str, channel: _Channel) -> _Channel:
        self._put(name, channel, self._conflicts.rank(name))
        return channel

    def _put(self, name: str, channel: Channel, rank: Rank) -> None:
        layer = _Layer(channel, rank)
        for place in layer.names:
            parameter(place)
        if len(set(layer.names)) < len(layer.names):
            raise InvalidValueError(f"channel {name}: names", "each parameter once", layer.names)
        self._layers.pop(name, None)
        self._layers[name] = layer

    def _arrange(self) -> None:
        """Put what all channels want into one place, and the claims in order; the head's by themselves: where the eyes
        have to turn depends on them.
        """
        self._asked = tuple(self._layers.values())
        ends = np.cumsum([len(layer.names) for layer in self._asked]).tolist()
        self._wants, self._wanted = np.zeros(len(self._asked), np.bool_), np.zeros((2, ends[-1]))
        claims: tuple[list[Claim], list[Claim]] = ([], [])
        for number, (layer, end) in enumerate(zip(self._asked, ends, strict=True)):
            first = end - len(layer.names)
            layer.move_to(self._wanted[:, first:end])
            for column, name in enumerate(layer.names, first):
                turns = parameter(name).index in _HEADS
                claims[turns].append(Claim(layer.rank.priority_of(name), number, layer.rank.way_of(name), column, name))
        self._others, self._turning = (Claims.of(found) for found in claims)
        self._gaze_layer = list(self._layers).index("gaze") if "gaze" in self._layers else 0
        self._shown = b""

    def _blame(self) -> InvalidValueError:
        for (name, layer), wants in zip(self._layers.items(), self._wants.tolist(), strict=True):
            wanted = np.stack([layer.values, layer.weights])
            if wants and not np.isfinite(wanted).all():
                return InvalidValueError(f"channel {name}", "finite values and weights", wanted.tolist())
        return InvalidValueError("channels", "finite values", self._values.tolist())


def _kernel() -> Callable[..., None]:
    from agentface.motion.blending_compiled import blend

    return blend
