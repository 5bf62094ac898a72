"""``agentface serve``: a face that listens to OSC."""

from __future__ import annotations

import math
import signal
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING

import click

from agentface.commands.film import Film, terminated_as_interrupted
from agentface.commands.options import (
    address,
    camera_option,
    face_options,
    live_quality_option,
    look_option,
    make_face,
    size_option,
)

if TYPE_CHECKING:
    from agentface.face import Face
    from agentface.parameters import FacePose

_OnFrame = Callable[[float], None]
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
    help="Film without gaps: note the face in real time, draw the frames when the server stops.",
)
@click.option("--duration", type=click.FloatRange(min=0, min_open=True), metavar="S", help="Stop after S seconds.")
@click.option("--fps", type=click.FloatRange(1, 240), default=None, help="Frames a second: 60, or 30 when recording.")
@look_option
@size_option
@live_quality_option
@camera_option
@face_options
def serve(
    *,
    osc: tuple[str, int],
    view: str,
    record: Path | None,
    every_frame: bool,
    duration: float | None,
    fps: float | None,
    look: str | None,
    size: tuple[int, int],
    quality: str | None,
    camera: str,
    face: str,
    deformer: str,
) -> None:
    """Show what OSC messages say, until Ctrl-C.

    Listens on this machine alone; --osc 0.0.0.0:7400 takes messages from others, too.
    """
    if view == "window" and (record or duration or fps):
        raise click.UsageError("--record, --duration and --fps go with --view none")
    if every_frame and not record:
        raise click.UsageError("--every-frame goes with --record")
    if look and view == "none" and not record:
        raise click.UsageError("--look goes with --view window or --record")
    from agentface.io.osc.server import OscServer

    shown = make_face(face, deformer, look=look)
    shown.warm_up()
    with OscServer(shown, *osc) as server:
        place = f"{server.host}:{server.port}"
        if view == "window":
            _open_window(shown, place, look, quality)
            return
        rate = fps or (30.0 if record else 60.0)
        film = Film(record, size, camera, quality or "fast", rate) if record else None
        # told to stop while it draws what it has noted, it keeps what is drawn
        with (
            terminated_as_interrupted(),
            _filming(shown, film, duration, every_frame) as on_frame,
            _until_told() as stop,
        ):
            from agentface.clock import SystemClock
            from agentface.live.loop import run_live

            _announce(shown, place)
            run_live(shown, SystemClock(), stop, fps=rate, duration=duration or math.inf, on_frame=on_frame)


def _announce(face: Face, place: str) -> None:
    click.echo(f"{face.model.name} listens to OSC on {place}")


def _open_window(face: Face, place: str, look: str | None, quality: str | None) -> None:
    from agentface.commands.show import make_window

    window = make_window(face, look=look, quality=quality)
    _announce(face, place)
    with terminated_as_interrupted(), suppress(KeyboardInterrupt):
        window.run()


def _filming(
    face: Face, film: Film | None, duration: float | None, every_frame: bool
) -> AbstractContextManager[_OnFrame]:
    if film is None:
        return nullcontext(lambda _: None)
    return _film_later(face, film) if every_frame else _film_now(face, film, duration)


@contextmanager
def _film_now(face: Face, film: Film, duration: float | None) -> Iterator[_OnFrame]:
    with film.open(face, duration) as draw:
        face.render(film.size, film.camera, film.quality)
        yield lambda time_s: draw(None, time_s)


@contextmanager
def _film_later(face: Face, film: Film) -> Iterator[_OnFrame]:
    """As :func:`_film_now`, but drawn after the end: a slow machine films as smoothly as a fast one."""
    with _film_now(face, film, None):
        pass  # what cannot be written or drawn is told before the recording
    noted: list[tuple[FacePose, float]] = []
    yield lambda time_s: noted.append((face.pose, time_s))
    with film.open(face, noted[-1][1] if noted else None) as draw:
        for pose, time_s in noted:
            draw(pose, time_s)


@contextmanager
def _until_told() -> Iterator[Event]:
    stop = Event()
    before = {kind: signal.signal(kind, lambda *_: stop.set()) for kind in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield stop
    finally:
        for kind, handler in before.items():
            signal.signal(kind, handler)
