"""Faces that live in a clock of their own: their channels, without a head to deform."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles
from agentface.emotion.state import EMOTIONS
from agentface.motion.course import EmotionRules
from agentface.motion.mixer import Mixer
from agentface.parameters import MUSCLES


class NoRules:
    """A face that feels nothing."""

    compiled = True

    def weights(self, states):
        return np.zeros((len(states), len(EMOTIONS), len(EMOTIONS)))

    def course(self, states, _weights=None):
        return np.zeros((len(states), len(MUSCLES)))


def channels(
    seed: int = 0, liveliness: float = 0.6, state: str | None = None, rules: EmotionRules | None = None
) -> Mixer:
    """The channels of a face that has been as lively as this from its first moment."""
    mixer = Mixer(rules or NoRules(), random=np.random.default_rng(seed))
    mixer.life.set_state(state)
    mixer.life.set_liveliness(liveliness, 0.0)
    return mixer


def trace(mixer: Mixer, seconds: float, hz: float) -> Doubles:
    """The poses ``(N, COUNT)`` of so many seconds, each frame's after its step."""
    frames = round(seconds * hz)
    poses = np.empty((frames, len(mixer.pose().array)))
    for frame in range(frames):
        mixer.advance(1.0 / hz)
        poses[frame] = mixer.pose().array
    return poses
