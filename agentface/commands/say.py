"""``agentface say``: a talking face, as a film with its sound, or in the window."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from agentface.commands.ending import Ending, until_told
from agentface.commands.film import Shot
from agentface.commands.options import (
    camera_option,
    emotion_option,
    face_options,
    given,
    live_quality_option,
    liveliness_option,
    look_option,
    make_face,
    size_option,
)
from agentface.commands.streams import tell
from agentface.errors import AgentFaceError, GraphicsError

if TYPE_CHECKING:
    from agentface.face import Face
    from agentface.speech.spoken import Spoken

_AFTER_S = 1.0
"""The film goes on for so long when all is said."""


@click.command()
@click.argument("text", required=False)
@click.option(
    "--audio",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="A recording instead of a voice, of TEXT if it is given; both in English. Needs the extra speech.",
)
@click.option(
    "--phones",
    type=click.Path(path_type=Path),
    metavar="FILE.json",
    help="A recording and the times of its phones, such as examples/hello.json, instead of a voice.",
)
@click.option("--voice", metavar="NAME", help="slt, rms, awb, kal16 or kal of flite, or espeak.")
@click.option("--language", default="en", metavar="NAME", show_default=True, help="The language of TEXT, like de.")
@click.option("--rate", type=click.FloatRange(0.5, 2), default=1.0, show_default=True, help="How fast the voice is.")
@emotion_option
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="FILE.mp4", help="Film it instead, with its sound."
)
@click.option(
    "--fps", type=click.FloatRange(1, 240), default=30.0, show_default=True, help="Frames a second of a film."
)
@liveliness_option
@look_option
@size_option
@live_quality_option
@camera_option
@face_options
@click.pass_context
def say(
    ctx: click.Context,
    *,
    text: str | None,
    audio: Path | None,
    phones: Path | None,
    voice: str | None,
    language: str,
    rate: float,
    emotions: dict[str, float],
    output: Path | None,
    fps: float,
    liveliness: float,
    look: str | None,
    size: tuple[int, int],
    quality: str | None,
    camera: str,
    face: str,
    deformer: str,
) -> None:
    """Say TEXT, - for the standard input, in a window, in real time, or into a film.

    Words in brackets are emotions, shown at the word that follows: [joy], [surprise:0.5], [neutral].

    \b
    agentface say "[joy] Hello, how are you?" -o hello.mp4
    agentface say "Guten Morgen" --language de
    agentface say --audio speech.wav -o speech.mp4
    """  # noqa: D301 - \b is click's mark of lines to keep
    _check_usage(given(ctx), text=text, recording=audio or phones, output=output)
    if text == "-":
        from agentface.speech.text import MOST_CHARACTERS

        text = sys.stdin.read(MOST_CHARACTERS + 1)
    told_of_tags(text)
    recorded = _recorded(text, audio, phones)
    if output is not None:
        spoken = recorded or _voiced(text or "", voice, language, rate)
        shown = _made(face, deformer, look, emotions, liveliness)
        with until_told() as ending:
            _film(shown, spoken, Shot(output, size, camera, quality or "fast", fps, look), ending)
        return
    shown = _made(face, deformer, look, emotions, liveliness)
    with until_told() as ending:
        if recorded is not None:
            shown.talker.perform(recorded)
        else:
            shown.say(text or "", voice=voice, language=language, rate=rate)
        try:
            _show(shown, ending, look, camera, quality)
        except GraphicsError as error:
            raise GraphicsError(f"{error}\nTo film it instead:  agentface say ... -o FILE.mp4") from error


def _check_usage(options: set[str], *, text: str | None, recording: Path | None, output: Path | None) -> None:
    if {"audio", "phones"} <= options:
        raise click.UsageError("--phones goes without --audio")
    if text is None and recording is None:
        raise click.UsageError("expected a TEXT, --audio or --phones")
    if text is not None and "phones" in options:
        raise click.UsageError("--phones goes without a TEXT")
    for name in ("voice", "language", "rate"):
        if recording is not None and name in options:
            raise click.UsageError(f"--{name} goes without a recording")
    for name in ("size", "fps"):
        if output is None and name in options:
            raise click.UsageError(f"--{name} goes with -o")


def told_of_tags(text: str | None) -> None:
    """Check a text, and print which of its tags nobody knows; raises InvalidValueError."""
    from agentface.requests.say import script_of

    if text is not None:
        for tag in script_of(text).unknown:
            tell(f"note: {tag} names no emotion; it is left out")


def _recorded(text: str | None, audio: Path | None, phones: Path | None) -> Spoken | None:
    """What is said in a recording; None without one."""
    from agentface.io.recorded_speech import hear, read_recorded

    if phones is not None:
        return read_recorded(phones)
    return None if audio is None else hear(audio, text)


def _voiced(text: str, voice: str | None, language: str, rate: float) -> Spoken:
    from contextlib import closing

    from agentface.requests.say import script_of
    from agentface.speech.spoken import speak_script
    from agentface.speech.voices.choose import open_voice

    with closing(open_voice(voice, language)) as speaker:
        return speak_script(speaker, script_of(text), rate)


def _made(face: str, deformer: str, look: str | None, emotions: dict[str, float], liveliness: float) -> Face:
    made = make_face(face, deformer, look=look, running=True, liveliness=liveliness)
    if emotions:
        made.set_emotion(emotions, fade=0.0)
    return made


def _film(face: Face, spoken: Spoken, shot: Shot, ending: Ending) -> None:
    from agentface.clock import FrameClock
    from agentface.live.loop import run

    length_s = spoken.duration_s + _AFTER_S
    frames = math.ceil(length_s * shot.fps - 1e-6)
    face.talker.perform(spoken)
    with shot.open(face.model, (frames - 1) / shot.fps, spoken.sound) as film:
        end = (frames - 0.5) / shot.fps
        drawn = run(face, FrameClock(shot.fps), [], [film], fps=shot.fps, duration=end, stopped=ending.told)
    if drawn < frames:
        tell(f"{shot.path}: stopped at {max(drawn - 1, 0) / shot.fps:.1f} s of {length_s:.1f} s")
        raise SystemExit(ending.code)


def _show(face: Face, ending: Ending, look: str | None, camera: str, quality: str | None) -> None:
    from agentface.clock import SystemClock
    from agentface.commands.show import make_window
    from agentface.io.voice_output import VoiceOutput

    clock = SystemClock()
    failed: list[AgentFaceError] = []
    done_at: list[float] = []
    window = make_window(face, look=look, quality=quality, camera=camera)
    face.talker.failed.append(failed.append)
    face.talker.ended.append(lambda _text: done_at.append(clock.now() + _AFTER_S))
    with VoiceOutput(face.talker, tell):
        window.run(stopped=lambda: ending.told() or bool(failed or (done_at and clock.now() >= done_at[0])))
    if failed:
        raise failed[0]
