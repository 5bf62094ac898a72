"""Ask for face weights of ARKit."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from dataclasses import dataclass

from agentface.arkit.channel import ARKIT_CHANNEL, ArkitChannel
from agentface.conventions import check_duration, check_fraction
from agentface.errors import UnknownNameError
from agentface.head.arkit import ARKIT_SHAPES
from agentface.motion.stream import STREAM_FADE_S
from agentface.requests.request import Movable, Request


@dataclass(frozen=True, slots=True)
class SetArkit(Request):
    """Some of ARKit's 52 face weights, beside those that are still shown.

    Attributes:
        weights: pairs of name and weight 0..1; also a mapping.
        fade: seconds from the frame before.
    """

    weights: tuple[tuple[str, float], ...]
    fade: float = STREAM_FADE_S

    def __post_init__(self) -> None:
        pairs = tuple(self.weights.items() if isinstance(self.weights, Mapping) else self.weights)
        for name, _ in pairs:
            if name not in ARKIT_SHAPES:
                raise UnknownNameError("ARKit weight", name, ARKIT_SHAPES)
        checked = {name: check_fraction(name, weight) for name, weight in pairs}
        self._keep(weights=tuple(sorted(checked.items())), fade=check_duration("fade", self.fade))

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each set of weights by itself."""
        return type(self).__name__, *(name for name, _ in self.weights)

    def apply(self, face: Movable) -> None:
        """Tell the weights' channel, which is there from the first of them on."""
        channel = face.channels.get(ARKIT_CHANNEL)
        if not isinstance(channel, ArkitChannel):
            channel = ArkitChannel()
            face.channels[ARKIT_CHANNEL] = channel
        channel.change(face.model, dict(self.weights), self.fade)
