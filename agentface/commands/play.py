"""``agentface play``: an EmotionML document in the window, or as a film."""

from __future__ import annotations

import math
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
from agentface.commands.streams import tell
from agentface.errors import DataError, Fault, GraphicsError

if TYPE_CHECKING:
    from agentface.emotion.score import Score
    from agentface.face import Face

_MOST_NOTES = 5


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
@click.option("--strict", is_flag=True, help="Play nothing of a document that says what the face does not show.")
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
    strict: bool,
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
    of_a_film = sorted(given(ctx) & {"fps", "size"})
    if output is None and of_a_film:
        raise click.UsageError(f"--{of_a_film[0]} goes with -o")
    if output is not None and loop:
        raise click.UsageError("--loop goes without -o")
    score = _score(document, strict=strict)
    shown = make_face(face, deformer, look=look, running=output is None)
    with until_told() as ending:
        if output is not None:
            _film(shown, score, Shot(output, size, camera, quality or "fast", fps, look), ending)
            return
        try:
            _show(shown, score, ending, look, camera, quality, loop=loop)
        except GraphicsError as error:
            hint = f"To film the document instead:  agentface play {document} -o FILE.mp4"
            raise GraphicsError(f"{error}\n{hint}") from error


def _score(document: Path, *, strict: bool) -> Score:
    from agentface.io.emotionml import load_emotionml

    if document.suffix.lower() == ".fap":
        got = "an MPEG-4 FAP file"
        raise DataError([Fault(document, None, "", "EmotionML, which is all that this version plays", got)])
    score = load_emotionml(document, strict=strict)
    for note in score.notes[:_MOST_NOTES]:
        tell(f"note: {note}")
    return score


def _show(
    face: Face, score: Score, ending: Ending, look: str | None, camera: str, quality: str | None, *, loop: bool
) -> None:
    from agentface.commands.show import make_window
    from agentface.live.scores import ScorePlayer

    window = make_window(face, look=look, quality=quality, camera=camera)
    duration = math.inf if loop else score.length_s
    window.run([ScorePlayer(face, score, again=loop)], duration=duration, stopped=ending.told)


def _film(face: Face, score: Score, shot: Shot, ending: Ending) -> None:
    from agentface.clock import FrameClock
    from agentface.live.loop import run
    from agentface.live.scores import ScorePlayer

    fps, player = shot.fps, ScorePlayer(face, score)
    frames = math.ceil(score.length_s * fps - 1e-6)
    with shot.open(face.model, (frames - 1) / fps) as film:
        end = (frames - 0.5) / fps
        drawn = run(face, FrameClock(fps), [player], [film], fps=fps, duration=end, stopped=ending.told)
    if drawn < frames:
        filmed_s = max(drawn - 1, 0) / fps
        tell(f"{shot.path}: stopped at {filmed_s:.1f} s of {score.length_s:.1f} s")
        raise SystemExit(ending.code)
