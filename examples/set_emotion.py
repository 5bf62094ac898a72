"""Set an emotion from Python and write a picture: ``python examples/set_emotion.py happiness 0.8 happy.png``."""

from __future__ import annotations

import argparse

from PIL import Image

from agentface import EMOTIONS, Face


def main() -> None:
    """Run the example."""
    parser = argparse.ArgumentParser(description="Write a picture of an emotion.")
    parser.add_argument("emotion", nargs="?", default="happiness", help=", ".join(EMOTIONS))
    parser.add_argument("intensity", nargs="?", type=float, default=0.8, help="0..1")
    parser.add_argument("output", nargs="?", default="emotion.png")
    parser.add_argument("--face", default="amber", help="amber, onyx, or the folder of another face")
    options = parser.parse_args()

    face = Face(options.face)
    face.set_emotion(options.emotion, options.intensity, fade=0.3)
    for _ in range(24):  # what a program does once a frame
        face.step(1 / 60)
    Image.fromarray(face.render(size=(640, 640))).save(options.output)

    print(f"{options.output}: {options.emotion} at {options.intensity:g}")
    for muscle, contraction in face.status()["shown"]["contractions"].items():
        if contraction > 0:
            print(f"  {muscle:<42} {contraction:.2f}")


if __name__ == "__main__":
    main()
