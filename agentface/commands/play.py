"""``agentface play``: an EmotionML document in the window, or as a film."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from agentface.commands.film import Film, terminated_as_interrupted
from agentface.commands.options import (
    camera_option,
    face_options,
    live_quality_option,
    look_option,
    make_face,
    size_option,
)
from agentface.errors import DataError, Fault, GraphicsError

if TYPE_CHECKING:
    from agentface.emotion.score import Score
    from agentface.face import Face

_MOST_NOTES = 5
_STOPPED = 130
"""The exit code of a command that Ctrl-C stopped."""


@click.command()
@click.argument("document", type=click.Path(path_type=Path), metavar="FILE.xml")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    metavar="FILE.mp4",
    help="Film it instead; a name like face-%05d.png gives numbered transparent pictures.",
)
@click.option("--loop", is_flag=True, help="Play it again and again, until the window is closed.")
@click.option(
    "--fps", type=click.FloatRange(1, 240), default=30.0, show_default=True, help="Frames a second of a film."
)
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
    loop: bool,
    fps: float,
    look: str | None,
    size: tuple[int, int],
    quality: str | None,
    camera: str,
    face: str,
    deformer: str,
) -> None:
    """Play the emotions of an EmotionML document: in a window, in real time, or into a film.

    \b
    agentface play moods.xml
    agentface play moods.xml -o moods.mp4 --quality portrait
    """  # noqa: D301 - \b is click's mark of lines to keep
    of_a_film = [name for name in ("fps", "size") if ctx.get_parameter_source(name) is ParameterSource.COMMANDLINE]
    if output is None and of_a_film:
        raise click.UsageError(f"--{of_a_film[0]} goes with -o")
    if output is not None and loop:
        raise click.UsageError("--loop goes without -o")
    score = _score(document)
    shown = make_face(face, deformer, look=look)
    with terminated_as_interrupted():
        if output is not None:
            _film(shown, score, Film(output, size, camera, quality or "fast", fps))
            return
        shown.warm_up()
        try:
            _show(shown, score, look, camera, quality, loop=loop)
        except GraphicsError as error:
            hint = f"To film the document instead:  agentface play {document} -o FILE.mp4"
            raise GraphicsError(f"{error}\n{hint}") from error


def _score(document: Path) -> Score:
    from agentface.io.emotionml import load_emotionml

    if document.suffix.lower() == ".fap":
        got = "an MPEG-4 FAP file"
        raise DataError([Fault(document, None, "", "EmotionML, which is all that this version plays", got)])
    score = load_emotionml(document)
    if not score.cues:
        raise DataError([Fault(document, None, "", "at least one emotion", "none")])
    for note in score.notes[:_MOST_NOTES]:
        click.echo(f"note: {note}", err=True)
    return score


def _follower(face: Face, score: Score) -> Callable[[float], None]:
    """Told the time, tells the face what is new in the score."""
    from agentface.requests import SetEmotions

    told = None

    def follow(time_s: float) -> None:
        nonlocal told
        change = score.change(time_s)
        if change is not told:
            told = change
            face.apply(SetEmotions(change.state, change.fade_s))

    return follow


def _show(face: Face, score: Score, look: str | None, camera: str, quality: str | None, *, loop: bool) -> None:
    from agentface.commands.show import make_window

    window = make_window(face, look=look, quality=quality)
    window.controls.look(camera)
    follow = _follower(face, score)
    start: float | None = None

    def each_frame() -> None:
        nonlocal start
        start = window.clock() if start is None else start
        time_s = window.clock() - start
        window.controls.closing |= time_s >= score.length_s and not loop
        follow(time_s % score.length_s if loop else time_s)

    with suppress(KeyboardInterrupt):
        window.run(each_frame)


def _film(face: Face, score: Score, film: Film) -> None:
    frames = math.ceil(score.length_s * film.fps - 1e-6)
    follow, time_s = _follower(face, score), 0.0
    try:
        with film.open(face, (frames - 1) / film.fps) as draw:
            for frame in range(frames):
                if frame:
                    face.step(1.0 / film.fps)
                time_s = frame / film.fps
                follow(time_s)
                draw(None, time_s)
    except KeyboardInterrupt:
        click.echo(f"{film.path}: stopped at {time_s:.1f} s of {score.length_s:.1f} s", err=True)
        raise SystemExit(_STOPPED) from None
