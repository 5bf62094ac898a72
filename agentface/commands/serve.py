"""``agentface serve``: a face that listens to OSC."""

from __future__ import annotations

import math
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from agentface.commands.ending import Ending, until_told
from agentface.commands.film import Shot
from agentface.commands.links import Links
from agentface.commands.options import (
    address,
    camera_option,
    deformer_option,
    given,
    live_quality_option,
    liveliness_option,
    look_option,
    make_face,
    size_option,
)
from agentface.commands.pages import PagesAsked, served_pages, web_options
from agentface.commands.streams import say, tell
from agentface.commands.vmc import VmcOptions, check_vmc, vmc_links, vmc_options
from agentface.resources import DEFAULT_FACE

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from agentface.face import Face
    from agentface.io.osc.server import OscServer
    from agentface.io.web.server import WebServer
    from agentface.live.loop import Sink, Source

_RECORD = "Film the face; a name like face-%05d.png gives numbered transparent pictures instead."


@click.command()
@click.option(
    "--osc", default="127.0.0.1:7400", callback=address, metavar="HOST:PORT", show_default=True, help="Where to listen."
)
@vmc_options
@web_options
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
@click.option(
    "--face",
    "names",
    multiple=True,
    default=(DEFAULT_FACE,),
    metavar="NAME|PATH",
    show_default=True,
    help="A face's name, or its folder. Several are several faces, each reached under /agentface/ID/....",
)
@click.option("--id", "ids", multiple=True, metavar="ID", help="What OSC calls a face, if not by its name; for each.")
@deformer_option
@click.pass_context
def serve(
    ctx: click.Context,
    *,
    osc: tuple[str, int],
    vmc: VmcOptions,
    pages: PagesAsked | None,
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
    names: tuple[str, ...],
    ids: tuple[str, ...],
    deformer: str,
) -> None:
    """Show what OSC messages say, until Ctrl-C.

    Listens on this machine alone; --osc 0.0.0.0:7400 takes messages from others, too.

    \b
    agentface serve --view window
    agentface serve --face amber --id left --face onyx --id right
    agentface serve --vmc 127.0.0.1:39539 --vmc-in 127.0.0.1:39540
    """  # noqa: D301 - \b is click's mark of lines to keep
    _check_options(given(ctx), window=view == "window", record=bool(record), several=len(names) > 1, web=bool(pages))
    _check_ids(names, ids)
    check_vmc(given(ctx), vmc)
    from agentface.io.osc.server import OscServer

    made = [
        make_face(name, deformer, look=look, running=True, driven=True, liveliness=liveliness, seed=seed)
        for seed, name in enumerate(names)
    ]
    faces = vmc.first(_by_id(made, ids))
    name = next(iter(faces))
    rate = fps or (30.0 if record else 60.0)
    with until_told() as ending, _heard(faces), ExitStack() as stack:
        ways = _Ways(
            stack.enter_context(OscServer(faces if ids or len(made) > 1 else made[0], *osc)),
            stack.enter_context(vmc_links(name, faces[name], vmc)),
            stack.enter_context(served_pages(faces, pages, deformer, look, rate)),
        )
        end = duration or math.inf
        if view == "window":
            _in_a_window(ways, faces, ending, look, quality, camera)
        elif record is None:
            _run(ways, faces, ending, rate, end)
        else:
            shot = Shot(record, size, camera, quality or "fast", rate, look, live=True)
            again = make_face(names[0], deformer, look=look, liveliness=liveliness) if every_frame else None
            _film(ways, faces, ending, shot, end, again)


def _film(ways: _Ways, faces: Mapping[str, Face], ending: Ending, shot: Shot, end: float, again: Face | None) -> None:
    if again is None:
        _film_now(ways, faces, ending, shot, end)
    else:
        _film_later(ways, faces, ending, shot, end, again)


@dataclass(frozen=True)
class _Ways:
    """How a face is reached, and where its frames go beside what is drawn."""

    osc: OscServer
    vmc: Links
    pages: Sequence[WebServer]

    @property
    def sources(self) -> list[Source]:
        return [self.osc, *self.vmc.sources, *self.pages]

    @property
    def sinks(self) -> list[Sink]:
        return [*self.vmc.sinks, *self.pages]


def _check_options(names: set[str], *, window: bool, record: bool, several: bool, web: bool) -> None:
    """Raise UsageError for the first option that would do nothing, or is for one face."""
    for name, goes_with, there in (
        ("record", "one --face", not several),
        ("view", "one --face", not several or not window),
        ("look", "one --face", not several),
        ("record", "--view none", not window),
        ("duration", "--view none", not window),
        ("fps", "--view none", not window),
        ("every_frame", "--record", record),
        ("size", "--record", record),
        ("look", "--view window, --record or --web", window or record or web),
        ("token", "--web", web),
        ("origins", "--web", web),
        ("quality", "--view window or --record", window or record),
        ("camera", "--view window or --record", window or record),
    ):
        if name in names and not there:
            raise click.UsageError(f"--{name.replace('_', '-')} goes with {goes_with}")


def _check_ids(names: Sequence[str], ids: Sequence[str]) -> None:
    from agentface.io.osc.addresses import check_id
    from agentface.io.osc.receiver import MOST_FACES

    if len(names) > MOST_FACES:
        raise click.UsageError(f"expected at most {MOST_FACES} faces, got {len(names)}")
    if ids and len(ids) != len(names):
        raise click.UsageError(f"expected an --id for each --face or none, got {len(ids)} for {len(names)}")
    for name in ids:
        check_id(name)
    _check_apart(ids)


def _check_apart(ids: Sequence[str]) -> None:
    twice = next((name for name in ids if ids.count(name) > 1), None)
    if twice is not None:
        raise click.UsageError(f"expected each id once, got {twice!r} twice; give each --face an --id of its own")


def _by_id(faces: Sequence[Face], ids: Sequence[str]) -> dict[str, Face]:
    names = ids or [face.model.name for face in faces]
    _check_apart(names)
    return dict(zip(names, faces, strict=True))


@contextmanager
def _heard(faces: Mapping[str, Face]) -> Iterator[None]:
    """The faces' voices on the machine's device, and in the terminal what goes wrong with them."""
    from agentface.io.voice_output import VoiceOutput

    def complain(name: str, error: object) -> None:
        tell(f"{name}: {error}" if len(faces) > 1 else str(error))

    with ExitStack() as outputs:
        for name, face in faces.items():
            face.talker.failed.append(partial(complain, name))
            outputs.enter_context(VoiceOutput(face.talker, tell))
        yield


def _announce(faces: Mapping[str, Face], ways: _Ways) -> None:
    called = [name if name == face.model.name else f"{name} ({face.model.name})" for name, face in faces.items()]
    say(f"{' and '.join(called)} listen{'s' * (len(called) == 1)} to OSC on {ways.osc.host}:{ways.osc.port}")
    ways.vmc.announce()


def _only(faces: Mapping[str, Face]) -> Face:
    (face,) = faces.values()
    return face


def _in_a_window(
    ways: _Ways,
    faces: Mapping[str, Face],
    ending: Ending,
    look: str | None,
    quality: str | None,
    camera: str,
) -> None:
    from agentface.commands.show import make_window

    window = make_window(_only(faces), look=look, quality=quality, camera=camera)
    _announce(faces, ways)
    window.run(ways.sources, ways.sinks, stopped=ending.told)


def _run(
    ways: _Ways,
    faces: Mapping[str, Face],
    ending: Ending,
    fps: float,
    duration: float,
) -> None:
    from agentface.clock import SystemClock
    from agentface.live.loop import run

    face, *beside = faces.values()
    _announce(faces, ways)
    clock, end = SystemClock(), ending.told
    run(face, clock, ways.sources, ways.sinks, fps=fps, duration=duration, stopped=end, beside=beside)


def _film_now(ways: _Ways, faces: Mapping[str, Face], ending: Ending, shot: Shot, duration: float) -> None:
    from agentface.clock import SystemClock
    from agentface.io.video import SOUND_HZ
    from agentface.live.heard import LiveSound
    from agentface.live.loop import run
    from agentface.live.newest import LiveSink

    face, last_s = _only(faces), duration if math.isfinite(duration) else None
    with LiveSound(face, SOUND_HZ) as sound, LiveSink(lambda: shot.open(face.model, last_s, sound)) as film:
        _announce(faces, ways)
        sinks: list[Sink] = [sound, film, *ways.sinks]
        frames = run(face, SystemClock(), ways.sources, sinks, fps=shot.fps, duration=duration, stopped=ending.told)
    if film.dropped:
        lost = f"{film.dropped} of {frames} frames are left out, as this machine draws too slowly for them"
        tell(f"{shot.path}: {lost}; --every-frame films all of them")


def _film_later(
    ways: _Ways,
    faces: Mapping[str, Face],
    ending: Ending,
    shot: Shot,
    duration: float,
    again: Face,
) -> None:
    """As :func:`_film_now`, but ``again``, a face like the first, goes through it all when it is over.

    A slow machine films as smoothly as a fast one, and a deformer with memory has the same one.
    """
    from agentface.clock import FrameClock, SystemClock
    from agentface.io.video import SOUND_HZ
    from agentface.live.heard import HeardRecorder
    from agentface.live.loop import run
    from agentface.live.notes import Recorder, Replay

    face = _only(faces)
    with shot.open(face.model):
        pass  # what cannot be written or drawn is told before the recording
    _announce(faces, ways)
    with Recorder(face) as recorder, HeardRecorder(face, recorder, shot.fps) as heard:
        sinks: list[Sink] = [recorder, *ways.sinks]
        run(face, SystemClock(), ways.sources, sinks, fps=shot.fps, duration=duration, stopped=ending.told)
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
