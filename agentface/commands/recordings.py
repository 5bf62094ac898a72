"""What commands that read performances share: the file, what the face makes of it, and what is measured of that."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import click

from agentface.commands.progress import progress
from agentface.commands.streams import tell
from agentface.errors import DataError, Fault

if TYPE_CHECKING:
    from agentface.bml.block import Block
    from agentface.conventions import Floats
    from agentface.deform.geometry import FaceGeometry
    from agentface.face import Face
    from agentface.io.performances.kinds import FileKind, Recording
    from agentface.live.loop import Source
    from agentface.motion.performance import Performance
    from agentface.mpeg4.fap_stream import FapStream
    from agentface.speech.sound import Sound

_MOST_NOTES = 5
USUAL_HZ = 30.0

file_fps_option = click.option(
    "--file-fps",
    type=click.FloatRange(0, 1000, min_open=True),
    help="Frames a second of a file that does not say it: py-feat's (30 if not given), Live Link Face's timecode.",
)


@dataclass(frozen=True)
class Opened:
    """A file that was read, and what it holds."""

    path: Path
    kind: FileKind
    recording: Recording

    def tell_notes(self, notes: tuple[Fault, ...] | None = None) -> None:
        """Print what of the file is not shown as it is written; a few of many."""
        found = getattr(self.recording, "notes", ()) if notes is None else notes
        for note in found[:_MOST_NOTES]:
            tell(f"note: {note}")
        if len(found) > _MOST_NOTES:
            tell(f"note: {self.path}: {len(found) - _MOST_NOTES} more")

    def performance(self, face: Face) -> Performance:
        """What ``face`` makes of it, with a bar while that takes long; raises DataError."""
        from agentface.io.performances.performing import Performer

        with progress(self.path.name, self._frames) as told:
            performance = Performer(face.model).performance(self.recording, self.path, told)
        own = len(getattr(self.recording, "notes", ()))
        self.tell_notes(performance.notes[own:])
        return performance

    def sound(self) -> Sound | None:
        """What is heard with it, if it says so; raises DataError for a sound that cannot be read.

        Of BML, what the voice says; raises what :attr:`voiced` raises.
        """
        from agentface.bml.block import Block
        from agentface.io.sound import read_sound
        from agentface.io.video import SOUND_HZ
        from agentface.motion.performance import Performance
        from agentface.talk.block_speech import block_sound

        if isinstance(self.recording, Block):
            return block_sound(self.voiced, SOUND_HZ)
        if not isinstance(self.recording, Performance) or self.recording.sound is None:
            return None
        return read_sound(self.path.parent / self.recording.sound, SOUND_HZ)

    @cached_property
    def voiced(self) -> Block:
        """The block of BML with its speeches spoken; raises SpeechError where there is no voice."""
        from contextlib import closing

        from agentface.bml.block import Block
        from agentface.speech.voices.choose import open_voice
        from agentface.talk.block_speech import speak_block

        assert isinstance(self.recording, Block), "it is BML"  # noqa: S101 - for the type checker
        if not self.recording.speeches:
            return self.recording
        with closing(open_voice()) as voice:
            return speak_block(voice, self.recording)

    @property
    def _frames(self) -> float | None:
        from agentface.arkit.stream import ArkitStream
        from agentface.mpeg4.fap_stream import FapStream

        return len(self.recording) if isinstance(self.recording, FapStream | ArkitStream) else None


def opened(path: str | Path, file_fps: float | None, *, strict: bool = False) -> Opened:
    """Read a file of any kind, and tell its notes; raises DataError, with ``strict`` also for notes."""
    from agentface.io.performances.kinds import load

    path = Path(path)
    found = Opened(path, *load(path, file_fps))
    if strict and (notes := getattr(found.recording, "notes", ())):
        raise DataError(notes)
    found.tell_notes()
    return found


def player_of(found: Opened, face: Face, *, again: bool = False) -> tuple[Source, float]:
    """What plays the file to ``face``, and how many seconds it takes until the face has let go of it.

    Raises DataError for BML whose times cannot be, and SpeechError where there is no voice for it.
    """
    from agentface.bml.block import Block
    from agentface.emotion.score import Score
    from agentface.live.performances import PerformancePlayer
    from agentface.live.scores import ScorePlayer

    if isinstance(found.recording, Block):
        return _block_source(found, face, again=again)
    if isinstance(found.recording, Score):
        return ScorePlayer(face, found.recording, again=again), found.recording.length_s
    performance = found.performance(face)
    return PerformancePlayer(face, performance, again=again), performance.length_s


def measured(found: Opened, face: Face, fps: float | None, stopped: Callable[[], bool]) -> FapStream:
    """The FAPs that ``face`` shows while it plays the file, without a picture.

    Of FAPs, as many frames at the same rate, unless ``fps`` is given; of others, ``fps`` or their own rate, or 30.
    """
    from agentface.bml.block import Block
    from agentface.clock import FrameClock
    from agentface.emotion.score import Score
    from agentface.live.fap_recorder import FapRecorder
    from agentface.live.loop import run
    from agentface.live.performances import PerformancePlayer
    from agentface.live.scores import ScorePlayer

    source: Source
    if isinstance(found.recording, Block):
        (source, last_s), own = _block_source(found, face), None
    elif isinstance(found.recording, Score):
        source, last_s, own = ScorePlayer(face, found.recording), found.recording.length_s, None
    else:
        performance = found.performance(face)
        source, last_s, own = PerformancePlayer(face, performance), performance.duration_s, performance.rate_hz
    rate = fps or own or USUAL_HZ
    frames = math.floor(last_s * rate + 1e-6) + 1
    with progress(found.path.name, last_s) as told:
        recorder = FapRecorder(_measure(face), told)
        run(face, FrameClock(rate), [source], [recorder], fps=rate, duration=(frames - 0.5) / rate, stopped=stopped)
    return recorder.stream(rate, getattr(found.recording, "name", "") or found.path.stem)


def _block_source(found: Opened, face: Face, *, again: bool = False) -> tuple[Source, float]:
    from agentface.live.blocks import SETTLES_S, BlockSource
    from agentface.talk.block_speech import spoken_timetable

    length_s = spoken_timetable(found.voiced).end_s + SETTLES_S
    return BlockSource(face, found.voiced, again=again), length_s


def _measure(face: Face) -> Callable[[FaceGeometry], Floats]:
    from agentface.mpeg4.meter import FapMeter

    return FapMeter(face.model).measure
