"""Film a face that is given a sound piece by piece: ``python examples/speaker.py examples/hello.wav hello.mp4``."""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from agentface import Face
from agentface.agents import Drawing, SegmentEnd, SoundPiece, Speaker, VideoFrame
from agentface.clock import FrameClock
from agentface.io.sound import read_sound
from agentface.io.video import VideoWriter
from agentface.speech.sound import Sound

EXAMPLES = Path(__file__).parent


def main() -> None:
    """Run the example."""
    parser = argparse.ArgumentParser(description="Film a face that speaks a recording, piece by piece.")
    parser.add_argument("sound", nargs="?", default=EXAMPLES / "hello.wav", type=Path)
    parser.add_argument("output", nargs="?", default="speaker.mp4")
    parser.add_argument("--size", default=384, type=int, help="of the square picture, in pixels")
    options = parser.parse_args()

    sound = read_sound(options.sound, 24_000)
    frames: list[VideoFrame] = []
    heard: list[np.ndarray] = []
    # in a program that talks to somebody the clock is the machine's, which is the default
    with (
        Face(liveliness=0.6) as face,
        Speaker(face, Drawing((options.size, options.size)), clock=FrameClock(25)) as speaker,
    ):
        face.set_emotion("happiness", 0.4)
        for first in range(0, len(sound.samples), 480):  # 20 ms, as voices and networks give it
            speaker.push_sound(sound.samples[first : first + 480].tobytes(), sound.rate_hz)
        speaker.end_segment()
        ended = False
        while not ended:
            for piece in speaker.take():
                if isinstance(piece, VideoFrame):
                    frames.append(piece)
                elif isinstance(piece, SoundPiece):
                    heard.append(piece.samples)
                ended = ended or isinstance(piece, SegmentEnd)

    track = Sound(np.concatenate(heard), speaker.rate_hz)
    with VideoWriter(options.output, (options.size, options.size), 25, sound=track) as film:
        for frame in frames:
            film.add(frame.image, frame.time_s)
    print(f"{options.output}: {len(frames)} frames, {track.duration_s:.2f} s of sound")


if __name__ == "__main__":
    main()
