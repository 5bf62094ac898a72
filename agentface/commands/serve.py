"""``agentface serve``: a face that listens to OSC."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import click

from agentface.commands.ending import Ending, until_told
from agentface.commands.film import Shot
from agentface.commands.options import (
    address,
    camera_option,
    face_options,
    given,
    live_quality_option,
    liveliness_option,
    look_option,
    make_face,
    size_option,
)
from agentface.commands.streams import say, tell

if TYPE_CHECKING:
    from agentface.face import Face
    from agentface.io.osc.server import OscServer

_RECORD = "Film the face; a name like face-%05d.png gives numbered transparent pictures instead."


@click.command()
@click.option(
    "--osc", default="127.0.0.1:7400", callback=address, metavar="HOST:PORT", show_default=True, help="Where to listen."
)
@click.option("--view", type=click.Choice(["window", "none"]), default="none", show_default=True)
@click.option("--record", type=click.Path(path_type=Path), metavar="FILE.mp4", help=_RECORD)
@click.option(
    "--every-frame",
    is_flag=True,
    help="Film without gaps: note in real time what the face is asked, draw the frames when the server stops.",
)
@click.option("--duration", type=click.FloatRange(min=0, min_open=True), metavar="S", help="Stop after S seconds.")
@click.option("--fps", type=click.FloatRange(1, 240), default=None, help="Frames a second: 60, or 30 when recording.")
@look_option
@liveliness_option
@size_option
@live_quality_option
@camera_option
@face_options
@click.pass_context
def serve(
    ctx: click.Context,
    *,
    osc: tuple[str, int],
    view: str,
    record: Path | None,
    every_frame: bool,
    duration: float | None,
    fps: float | None,
    look: str | None,
    liveliness: float,
    size: tuple[int, int],
    quality: str | None,
    camera: str,
    face: str,
    deformer: str,
) -> None:
    """Show what OSC messages say, until Ctrl-C.

    Listens on this machine alone; --osc 0.0.0.0:7400 takes messages from others, too.
    """
    _check_options(given(ctx), window=view == "window", record=record is not None)
    from agentface.io.osc.server import OscServer
    from agentface.io.voice_output import VoiceOutput

    shown = make_face(face, deformer, look=look, running=True, liveliness=liveliness)
    shown.talker.failed.append(lambda error: tell(str(error)))
    with until_told() as ending, OscServer(shown, *osc) as server, VoiceOutput(shown.talker, tell):
        if view == "window":
            _in_a_window(server, shown, ending, look, quality, camera)
            return
        rate = fps or (30.0 if record else 60.0)
        end = duration or math.inf
        if record is None:
            _run(server, shown, ending, rate, end)
            return
        shot = Shot(record, size, camera, quality or "fast", rate, look, live=True)
        if every_frame:
            _film_later(server, shown, ending, shot, end, make_face(face, deformer, look=look, liveliness=liveliness))
        else:
            _film_now(server, shown, ending, shot, end)


def _check_options(names: set[str], *, window: bool, record: bool) -> None:
    """Raise UsageError for the first option that would do nothing."""
    for name, goes_with, there in (
        ("record", "--view none", not window),
        ("duration", "--view none", not window),
        ("fps", "--view none", not window),
        ("every_frame", "--record", record),
        ("size", "--record", record),
        ("look", "--view window or --record", window or record),
        ("quality", "--view window or --record", window or record),
        ("camera", "--view window or --record", window or record),
    ):
        if name in names and not there:
            raise click.UsageError(f"--{name.replace('_', '-')} goes with {goes_with}")


def _announce(face: Face, server: OscServer) -> None:
    say(f"{face.model.name} listens to OSC on {server.host}:{server.port}")


def _in_a_window(
    server: OscServer, face: Face, ending: Ending, look: str | None, quality: str | None, camera: str
) -> None:
    from agentface.commands.show import make_window

    window = make_window(face, look=look, quality=quality, camera=camera)
    _announce(face, server)
    window.run([server], stopped=ending.told)


def _run(server: OscServer, face: Face, ending: Ending, fps: float, duration: float) -> None:
    from agentface.clock import SystemClock
    from agentface.live.loop import run

    _announce(face, server)
    run(face, SystemClock(), [server], fps=fps, duration=duration, stopped=ending.told)


def _film_now(server: OscServer, face: Face, ending: Ending, shot: Shot, duration: float) -> None:
    from agentface.clock import SystemClock
    from agentface.live.loop import run
    from agentface.live.newest import LiveSink

    with LiveSink(lambda: shot.open(face.model, duration if math.isfinite(duration) else None)) as film:
        _announce(face, server)
        frames = run(face, SystemClock(), [server], [film], fps=shot.fps, duration=duration, stopped=ending.told)
    if film.dropped:
        lost = f"{film.dropped} of {frames} frames are left out, as this machine draws too slowly for them"
        tell(f"{shot.path}: {lost}; --every-frame films all of them")


def _film_later(server: OscServer, face: Face, ending: Ending, shot: Shot, duration: float, again: Face) -> None:
    """As :func:`_film_now`, but ``again``, a face like the first, goes through it all when it is over.

    A slow machine films as smoothly as a fast one, and a deformer with memory has the same one.
    """
    from agentface.clock import FrameClock, SystemClock
    from agentface.io.video import SOUND_HZ
    from agentface.live.heard import HeardRecorder
    from agentface.live.loop import run
    from agentface.live.notes import Recorder, Replay

    with shot.open(face.model):
        pass  # what cannot be written or drawn is told before the recording
    _announce(face, server)
    with Recorder(face) as recorder, HeardRecorder(face, recorder, shot.fps) as heard:
        run(face, SystemClock(), [server], [recorder], fps=shot.fps, duration=duration, stopped=ending.told)
    if recorder.last_s is None:
        return
    ending.go_on()  # told to stop again, it keeps what is drawn
    last = round(recorder.last_s * shot.fps)
    replay = Replay(again, recorder.notes, shot.fps)
    with shot.open(face.model, last / shot.fps, heard.sound(SOUND_HZ)) as film:
        end = (last + 0.5) / shot.fps
        drawn = run(again, FrameClock(shot.fps), [replay], [film], fps=shot.fps, duration=end, stopped=ending.told)
    if drawn <= last:
        tell(f"{shot.path}: stopped at {(drawn - 1) / shot.fps:.1f} s of {last / shot.fps:.1f} s")
        raise SystemExit(ending.code)
