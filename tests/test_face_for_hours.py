"""A face that runs and lives for hours: what it shows stays finite and smooth, and it keeps no memory."""

from __future__ import annotations

import resource
from collections.abc import Callable

import numpy as np
import pytest

from agentface import EMOTIONS, Face
from agentface.head.regions import REGIONS, REST
from agentface.motion.figures import STATES
from agentface.parameters import MUSCLES
from tests.heads import head_model

HOURS, HZ = 2.0, 30
MOST_GROWTH = 10e6
"""Bytes that the process may grow by after its first minute."""
FASTEST = 1.0
"""Metres a second that skin of the face moves at most in the head's axes."""

pytestmark = pytest.mark.soak


def disturb(face: Face, draw: np.random.Generator) -> None:
    """One random thing that a program may ask for."""
    fade = float(draw.choice([0.1, 0.25, 1.0]))
    gestures = list(face.channels.gestures.gestures)
    deeds: list[Callable[[], None]] = [
        lambda: face.set_emotion(str(draw.choice(EMOTIONS)), float(draw.random()), fade=fade),
        lambda: face.set_emotion(dict(zip(EMOTIONS, draw.random(6).tolist(), strict=True)), fade=fade, hold=0.5),
        lambda: face.set_muscle(str(draw.choice(MUSCLES)), float(draw.random()), fade=fade),
        lambda: face.set_gaze(float(draw.uniform(-50, 50)), float(draw.uniform(-40, 40)), fade=fade),
        lambda: face.set_head(*(float(draw.uniform(-40, 40)) for _ in range(3)), fade=fade),
        lambda: face.neutral(fade),
        face.blink,
        lambda: face.look_at([*draw.uniform(-0.6, 0.6, 2), 0.6]),
        lambda: face.gesture(str(draw.choice(gestures)), float(draw.random())),
        lambda: face.set_state(str(draw.choice(STATES))),
        lambda: face.channels.life.beat(float(draw.random()), 0.1),
        lambda: face.channels.life.sentence_ends(0.2),
    ]
    deeds[draw.integers(len(deeds))]()


def peak_bytes() -> int:
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def test_two_hours_of_random_calls():
    face, draw = Face(head_model(), liveliness=0.6), np.random.default_rng(7)
    inside = face.model.regions.region_of < REGIONS.index(REST)
    before = face.step(0.0).vertices[inside]
    first_minute = 0
    for frame in range(round(HOURS * 3600 * HZ)):
        if draw.random() < 0.1:
            disturb(face, draw)
        geometry = face.step(1 / HZ)
        assert np.isfinite(geometry.vertices).all(), frame
        now = geometry.vertices[inside]
        assert np.linalg.norm(now - before, axis=1).max() < FASTEST / HZ, frame
        before = now
        if frame == 60 * HZ:
            first_minute = peak_bytes()
    assert peak_bytes() - first_minute < MOST_GROWTH
