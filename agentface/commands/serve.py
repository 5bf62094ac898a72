"""``agentface serve``: a face that listens to OSC."""

from __future__ import annotations

import math
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Event
from typing import TYPE_CHECKING

import click

from agentface.commands.options import (
    address,
    camera_option,
    face_options,
    make_face,
    quality_option,
    size_option,
)

if TYPE_CHECKING:
    from agentface.face import Face
    from agentface.io.sequence import SequenceWriter
    from agentface.io.video import VideoWriter
    from agentface.parameters import FacePose

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
@size_option
@quality_option
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
    size: tuple[int, int],
    quality: str,
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
    from agentface.io.osc.server import OscServer

    shown = make_face(face, deformer)
    shown.warm_up()
    with OscServer(shown, *osc) as server:
        place = f"{server.host}:{server.port}"
        if view == "window":
            _open_window(shown, place)
            return
        rate = fps or (30.0 if record else 60.0)
        film = _film_later if every_frame else _film
        with film(shown, record, size, camera, quality, rate, duration) as on_frame, _until_told() as stop:
            from agentface.io.live import run_live
            from agentface.motion.clock import SystemClock

            _announce(shown, place)
            run_live(shown, SystemClock(), stop, fps=rate, duration=duration or math.inf, on_frame=on_frame)


def _announce(face: Face, place: str) -> None:
    click.echo(f"{face.model.name} listens to OSC on {place}")


def _open_window(face: Face, place: str) -> None:
    from agentface.commands.show import make_window

    window = make_window(face)
    _announce(face, place)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with suppress(KeyboardInterrupt):
        window.run()


@contextmanager
def _film(
    face: Face, path: Path | None, size: tuple[int, int], camera: str, quality: str, fps: float, duration: float | None
) -> Iterator[Callable[[float], None]]:
    if path is None:
        yield lambda _: None
        return
    with _writer(face, path, size, camera, quality, fps, duration) as draw:
        face.render(size, camera, quality)
        yield lambda time: draw(time, face.pose)


@contextmanager
def _film_later(
    face: Face, path: Path | None, size: tuple[int, int], camera: str, quality: str, fps: float, duration: float | None
) -> Iterator[Callable[[float], None]]:
    """As :func:`_film`, but drawn after the end: a slow machine films as smoothly as a fast one."""
    del duration
    assert path is not None, "every-frame goes with a file"  # noqa: S101 - checked above, said to the type checker
    with _film(face, path, size, camera, quality, fps, None):
        pass  # what cannot be written or drawn is told before the recording
    noted: list[tuple[float, FacePose]] = []
    yield lambda time: noted.append((time, face.pose))
    with _writer(face, path, size, camera, quality, fps, noted[-1][0] if noted else None) as draw:
        for time, pose in noted:
            draw(time, pose)


@contextmanager
def _writer(
    face: Face, path: Path, size: tuple[int, int], camera: str, quality: str, fps: float, duration: float | None
) -> Iterator[Callable[[float, FacePose], None]]:
    with _open_film(path, size, fps) as film, _progress(path, duration) as advance:

        def draw(time: float, pose: FacePose) -> None:
            film.add(face.render(size, camera, quality, pose=pose, alpha=path.suffix.lower() == ".png"), time)
            advance(time)

        yield draw


def _open_film(path: Path, size: tuple[int, int], fps: float) -> VideoWriter | SequenceWriter:
    if path.suffix.lower() == ".png":
        from agentface.io.sequence import SequenceWriter

        return SequenceWriter(path, size, fps)
    from agentface.io.video import VideoWriter

    return VideoWriter(path, size, fps)


@contextmanager
def _progress(path: Path, duration: float | None) -> Iterator[Callable[[float], None]]:
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    if duration is None or not console.is_terminal:
        yield lambda _: None
        return
    with Progress(console=console) as progress:
        task = progress.add_task(path.name, total=duration)
        yield lambda time: progress.update(task, completed=time)


@contextmanager
def _until_told() -> Iterator[Event]:
    stop = Event()
    before = {kind: signal.signal(kind, lambda *_: stop.set()) for kind in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield stop
    finally:
        for kind, handler in before.items():
            signal.signal(kind, handler)
