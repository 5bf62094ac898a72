"""``agentface play``: a file that moves the face, in the window, as a film, or measured in FAPs."""

from __future__ import annotations

import math
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

import click

from agentface.commands.ending import Ending, until_told
from agentface.commands.film import Shot
from agentface.commands.options import (
    camera_option,
    face_options,
    given,
    live_quality_option,
    look_option,
    make_face,
    size_option,
)
from agentface.commands.recordings import Opened, file_fps_option, measured, opened, player_of
from agentface.commands.streams import tell
from agentface.errors import GraphicsError

if TYPE_CHECKING:
    from agentface.face import Face


@click.command()
@click.argument("document", type=click.Path(path_type=Path), metavar="FILE")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    metavar="FILE.mp4",
    help="Film it instead; a name like face-%05d.png gives numbered transparent pictures.",
)
@click.option(
    "--fap-out",
    type=click.Path(path_type=Path),
    metavar="FILE.fap",
    help="Measure the face that is shown in MPEG-4 FAPs instead: no window, no picture. FAPs give as many frames back.",
)
@click.option("--loop", is_flag=True, help="Play it again and again, until the window is closed.")
@click.option(
    "--fps",
    type=click.FloatRange(1, 240),
    default=30.0,
    show_default=True,
    help="Frames a second of a film, or of --fap-out, which has the file's own if it is not given.",
)
@click.option("--strict", is_flag=True, help="Play nothing of a document that says what the face does not show.")
@file_fps_option
@look_option
@size_option
@live_quality_option
@camera_option
@face_options
@click.pass_context
def play(
    ctx: click.Context,
    *,
    document: Path,
    output: Path | None,
    fap_out: Path | None,
    loop: bool,
    fps: float,
    strict: bool,
    file_fps: float | None,
    look: str | None,
    size: tuple[int, int],
    quality: str | None,
    camera: str,
    face: str,
    deformer: str,
) -> None:
    """Play a file: in a window, in real time, or into a film.

    EmotionML, BML with what it says, MPEG-4 FAPs (.fap), OpenFace's, py-feat's and Live Link Face's tables (.csv),
    and poses (.json, .npz); what is in the file says which it is.

    \b
    agentface play moods.xml
    agentface play smile.fap -o smile.mp4 --quality portrait
    agentface play smile.fap --fap-out shown.fap
    """  # noqa: D301 - \b is click's mark of lines to keep
    _check_usage(given(ctx), output=output, fap_out=fap_out, loop=loop)
    found = opened(document, file_fps, strict=strict)
    if fap_out is not None:
        _measure(found, make_face(face, deformer, running=True), fap_out, fps if "fps" in given(ctx) else None)
        return
    shown = make_face(face, deformer, look=look, running=output is None)
    with until_told() as ending:
        if output is not None:
            _film(shown, found, Shot(output, size, camera, quality or "fast", fps, look), ending)
            return
        try:
            _show(shown, found, ending, look, camera, quality, loop=loop)
        except GraphicsError as error:
            hint = f"To film the document instead:  agentface play {document} -o FILE.mp4"
            raise GraphicsError(f"{error}\n{hint}") from error


def _check_usage(options: set[str], *, output: Path | None, fap_out: Path | None, loop: bool) -> None:
    if output is not None and fap_out is not None:
        raise click.UsageError("--fap-out goes without -o")
    if loop and (output or fap_out):
        raise click.UsageError(f"--loop goes without {'-o' if output else '--fap-out'}")
    if output is None and "size" in options:
        raise click.UsageError("--size goes with -o")
    if output is None and fap_out is None and "fps" in options:
        raise click.UsageError("--fps goes with -o")


def _show(
    face: Face, found: Opened, ending: Ending, look: str | None, camera: str, quality: str | None, *, loop: bool
) -> None:
    from agentface.commands.show import make_window

    player, length_s = player_of(found, face, again=loop)
    window = make_window(face, look=look, quality=quality, camera=camera)
    with _heard(found, face):
        window.run([player], duration=math.inf if loop else length_s, stopped=ending.told)


def _heard(found: Opened, face: Face) -> AbstractContextManager[object]:
    """The face's voice on the machine's device, where the file lets it speak."""
    from agentface.bml.block import Block
    from agentface.io.voice_output import VoiceOutput

    speaks = isinstance(found.recording, Block) and found.recording.speeches
    return VoiceOutput(face.talker, tell) if speaks else nullcontext()


def _film(face: Face, found: Opened, shot: Shot, ending: Ending) -> None:
    from agentface.clock import FrameClock
    from agentface.live.loop import run

    player, length_s = player_of(found, face)
    fps, sound = shot.fps, found.sound()
    frames = math.ceil(length_s * fps - 1e-6)
    with shot.open(face.model, (frames - 1) / fps, sound) as film:
        end = (frames - 0.5) / fps
        drawn = run(face, FrameClock(fps), [player], [film], fps=fps, duration=end, stopped=ending.told)
    if drawn < frames:
        filmed_s = max(drawn - 1, 0) / fps
        tell(f"{shot.path}: stopped at {filmed_s:.1f} s of {length_s:.1f} s")
        raise SystemExit(ending.code)


def _measure(found: Opened, face: Face, path: Path, fps: float | None) -> None:
    from agentface.io.files import check_writable
    from agentface.io.performances.kinds import kind_named
    from agentface.io.performances.writing import write

    check_writable(path)
    with until_told() as ending:
        stream = measured(found, face, fps, ending.told)
    if ending.told():
        tell(f"{path}: stopped after {len(stream)} frames; nothing is written")
        raise SystemExit(ending.code)
    write(path, kind_named("fap"), stream)
