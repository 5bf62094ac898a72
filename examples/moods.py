"""Moods that come and go: a loop that mixes two emotions and writes a film, ``python examples/moods.py moods.mp4``.

Each emotion rises and falls like a slow wave, out of step with the others; the rules make one face of them.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

from agentface import EMOTIONS, Face
from agentface.io.video import VideoWriter

FPS = 30


def moods(time: float, period: float) -> dict[str, float]:
    """Intensities at ``time``: one emotion after the other has its hour, and neighbours overlap."""
    hour = len(EMOTIONS) * (time / period % 1.0)
    wave = {}
    for number, emotion in enumerate(EMOTIONS):
        distance = abs((hour - number + 3) % len(EMOTIONS) - 3)
        wave[emotion] = max(0.0, math.cos(distance * math.pi / 2.4)) if distance < 1.2 else 0.0
    return wave


def main() -> None:
    """Run the example."""
    parser = argparse.ArgumentParser(description="Film a face whose mood changes.")
    parser.add_argument("output", nargs="?", type=Path, default=Path("moods.mp4"))
    parser.add_argument("--seconds", type=float, default=12.0)
    parser.add_argument("--size", type=int, default=480)
    parser.add_argument("--face", default="amber")
    options = parser.parse_args()

    face = Face(options.face)
    size = (options.size, options.size)
    with VideoWriter(options.output, size, FPS) as video:
        for frame in range(round(options.seconds * FPS)):
            time = frame / FPS
            face.set_emotion(moods(time, options.seconds), fade=0.1)
            face.set_gaze(12 * math.sin(0.9 * time), 5 * math.sin(1.3 * time), fade=0.2)
            face.step(1 / FPS)
            video.add(face.render(size), time)
    print(f"{options.output}: {options.seconds:g} s")


if __name__ == "__main__":
    main()
