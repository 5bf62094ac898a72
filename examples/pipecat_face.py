"""A pipeline of Pipecat with a face in it, without an account: a local voice speaks, and pictures of it are written.

``python examples/pipecat_face.py "[joy] Hello, how are you?" out/pipecat`` writes every fifth picture into a folder.
With a transport of your own, put it in the place of ``Pictures``, with ``video_out_enabled``, ``video_out_width`` and
``video_out_height`` of the drawing, and any text-to-speech service in the place of ``LocalVoice``. Needs the extra
pipecat, and flite.
"""

from __future__ import annotations

import argparse
import asyncio
from pathlib import Path
from typing import Any

from PIL import Image
from pipecat.frames.frames import (
    EndFrame,
    Frame,
    OutputImageRawFrame,
    TTSAudioRawFrame,
    TTSSpeakFrame,
    TTSStartedFrame,
    TTSStoppedFrame,
)
from pipecat.pipeline.pipeline import Pipeline
from pipecat.pipeline.worker import PipelineWorker
from pipecat.processors.frame_processor import FrameDirection, FrameProcessor
from pipecat.workers.runner import WorkerRunner

from agentface import Face
from agentface.agents import Drawing, Speaker
from agentface.agents.pipecat import FaceProcessor, FaceRequestFrame
from agentface.requests import SetEmotion
from agentface.speech.voices.flite import Flite


class LocalVoice(FrameProcessor):
    """Speaks with flite, in place of a text-to-speech service."""

    async def process_frame(self, frame: Frame, direction: FrameDirection) -> None:
        """Speak what is to be spoken, and pass on the rest."""
        await super().process_frame(frame, direction)
        if not isinstance(frame, TTSSpeakFrame):
            await self.push_frame(frame, direction)
            return
        sound = (await asyncio.to_thread(Flite().speak, frame.text)).sound
        await self.push_frame(TTSStartedFrame())
        for first in range(0, len(sound.samples), sound.rate_hz // 50):
            piece = sound.samples[first : first + sound.rate_hz // 50].tobytes()
            await self.push_frame(TTSAudioRawFrame(audio=piece, sample_rate=sound.rate_hz, num_channels=1))
        await self.push_frame(TTSStoppedFrame())


class Pictures(FrameProcessor):
    """Writes every fifth picture, in place of a transport."""

    def __init__(self, folder: Path, **named: Any) -> None:
        super().__init__(**named)
        self.folder, self.count, self.heard_s = folder, 0, 0.0

    async def process_frame(self, frame: Frame, direction: FrameDirection) -> None:
        """Write a picture."""
        await super().process_frame(frame, direction)
        if isinstance(frame, OutputImageRawFrame):
            if self.count % 5 == 0:
                Image.frombytes(frame.format or "RGB", frame.size, frame.image).save(
                    self.folder / f"{self.count:04d}.png"
                )
            self.count += 1
        elif isinstance(frame, TTSAudioRawFrame):
            self.heard_s += frame.num_frames / frame.sample_rate
        await self.push_frame(frame, direction)


async def run(text: str, folder: Path) -> None:
    """Say a text through the pipeline."""
    with Face(liveliness=0.6) as face:
        pictures = Pictures(folder)
        speaker = Speaker(face, Drawing((384, 384)), rate_hz=16_000)
        worker = PipelineWorker(Pipeline([LocalVoice(), FaceProcessor(speaker), pictures]), enable_rtvi=False)
        await worker.queue_frames([FaceRequestFrame(SetEmotion("happiness", 0.6)), TTSSpeakFrame(text), EndFrame()])
        runner = WorkerRunner()
        await runner.add_workers(worker)
        await runner.run()
    print(f"{folder}: {pictures.count} pictures while {pictures.heard_s:.2f} s were heard")


def main() -> None:
    """Run the example."""
    parser = argparse.ArgumentParser(description="A face in a pipeline of Pipecat.")
    parser.add_argument("text", nargs="?", default="Hello! My name is Amber, and I am happy to meet you.")
    parser.add_argument("folder", nargs="?", default=Path("pipecat"), type=Path)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    asyncio.run(run(options.text, options.folder))


if __name__ == "__main__":
    main()
