"""Speakers whose time tests move, and what is asked of what they give out."""

from __future__ import annotations

import numpy as np

from agentface.agents import SegmentEnd, SoundPiece, Speaker, VideoFrame
from agentface.clock import FrameClock

FPS = 25


def speaker_of(face, drawing=None, **options):
    """One that waits for nothing, and by default does not draw."""
    return Speaker(face, drawing, **{"fps": FPS, "rate_hz": 16_000, "clock": FrameClock(FPS), **options})


def take(speaker, count):
    """The pieces of so many calls."""
    return [piece for _ in range(count) for piece in speaker.take()]


def take_all(speaker, most=2000):
    """The pieces until nothing is said or waits any more."""
    pieces = []
    for _ in range(most):
        pieces += speaker.take()
        if not speaker.busy:
            return pieces
    raise AssertionError(f"it still speaks after {most} frames")


def sound_of(pieces):
    """All that is heard, one after the other."""
    heard = [piece.samples for piece in pieces if isinstance(piece, SoundPiece)]
    return np.concatenate([np.zeros(0, np.int16), *heard])


def frames_of(pieces):
    return [piece for piece in pieces if isinstance(piece, VideoFrame)]


def ends_of(pieces):
    return [piece for piece in pieces if isinstance(piece, SegmentEnd)]


def noise(seconds, rate=16_000, seed=0):
    """A sound that nobody mistakes for another."""
    return np.random.default_rng(seed).integers(-3000, 3000, round(seconds * rate)).astype(np.int16)
