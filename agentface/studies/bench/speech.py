"""``agentface bench speech``: the laws of a speaking mouth under every emotion, and what a frame of speech costs."""

from __future__ import annotations

from collections.abc import Iterable
from time import perf_counter
from typing import Any

import numpy as np

from agentface.deform.protocol import DEFAULT_DEFORMER
from agentface.head.model import load_model
from agentface.motion.speech import SpeechChannel
from agentface.resources import face_names
from agentface.studies.harvard import harvard
from agentface.studies.speech_laws import LAWS, STATES, Manner, SpeakingMouth, broken

SETTINGS = ((1.0, 1.0), (0.6, 0.4), (0.6, 1.8), (1.6, 0.4), (1.6, 1.8))
"""Rates and loudnesses."""
_FRAMES = 600


def run(deformer_name: str = DEFAULT_DEFORMER) -> dict[str, Any]:
    """By face: each law's least and largest figure over all emotions, rates and loudnesses; and what broke which."""
    manners = [Manner(state, rate, loudness) for state in STATES for rate, loudness in SETTINGS]
    figures: dict[str, Any] = {
        name: _over(SpeakingMouth(load_model(name), deformer_name), manners) for name in face_names()
    }
    figures["manners"] = len(manners)
    figures["frame_us"] = _frame_us()
    return figures


def _over(mouth: SpeakingMouth, manners: Iterable[Manner]) -> dict[str, Any]:
    least, most = (dict.fromkeys(LAWS, sign * np.inf) for sign in (1.0, -1.0))
    faults: list[str] = []
    for manner in manners:
        found = mouth.figures(manner)
        faults += [f"{manner}: {fault}" for fault in broken(found)]
        for name, value in found.items():
            least[name], most[name] = min(least[name], value), max(most[name], value)
    return {"least": least, "most": most, "broken": faults}


def _frame_us() -> float:
    """What one frame of speech costs the motion, without the skin."""
    channel = SpeechChannel()
    values, weights = np.zeros(len(channel.names)), np.ones(len(channel.names))
    channel.speak(harvard()[0].phones, alphabet="arpabet")
    channel.advance(0.3)
    channel.write(values, weights)
    start = perf_counter()
    for _ in range(_FRAMES):
        channel.advance(1e-3)
        channel.write(values, weights)
    return (perf_counter() - start) / _FRAMES * 1e6
