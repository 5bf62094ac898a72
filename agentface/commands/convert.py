"""``agentface convert``: one kind of performance to another."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from agentface.commands.ending import Ending, until_told
from agentface.commands.options import face_options, json_option, make_face, write_json
from agentface.commands.progress import progress
from agentface.commands.recordings import Opened, file_fps_option, measured, opened

if TYPE_CHECKING:
    from agentface.io.performances.kinds import FileKind, Recording

_TO = ("fap", "openface", "live-link", "poses-json", "poses-npz", "emotionml")


@click.command()
@click.argument("source", type=click.Path(path_type=Path), metavar="IN")
@click.argument("output", type=click.Path(path_type=Path), metavar="OUT")
@click.option("--to", type=click.Choice(_TO), help="The kind of OUT; if not given, what its name ends in says it.")
@click.option(
    "--fps",
    type=click.FloatRange(0.001, 1000),
    help="Frames a second of FAPs (those of IN, or 30, if not given) and of emotions (25).",
)
@file_fps_option
@json_option
@face_options
def convert(
    *,
    source: Path,
    output: Path,
    to: str | None,
    fps: float | None,
    file_fps: float | None,
    json_file: str | None,
    face: str,
    deformer: str,
) -> None:
    """Write a performance as another kind of file: FAPs, action units, ARKit's weights, emotions, or poses.

    \b
    agentface convert openface.csv smile.fap
    agentface convert smile.fap smile.npz
    agentface convert smile.json smile.csv --to openface
    """  # noqa: D301 - \b is click's mark of lines to keep
    from agentface.io.files import check_writable
    from agentface.io.performances.writing import kind_of_output, write

    kind = kind_of_output(output, to)
    check_writable(output)
    found = opened(source, file_fps)
    with until_told() as ending:
        recording = _in_terms_of(kind, found, output, face, deformer, fps, ending)
        if ending.told():
            raise SystemExit(ending.code)
        write(output, kind, recording)
    if json_file is not None:
        write_json(
            json_file, {"in": _summary(source, found.kind, found.recording), "out": _summary(output, kind, recording)}
        )


def _in_terms_of(
    kind: FileKind, found: Opened, output: Path, face: str, deformer: str, fps: float | None, ending: Ending
) -> Recording:
    """What is written: the recording itself where it has these terms already."""
    from agentface.emotion.inference import default_inference
    from agentface.io.performances.performing import Performer
    from agentface.io.performances.writing import action_units_of, terms_of
    from agentface.motion.scored import score_of_performance

    terms = terms_of(kind)
    if isinstance(found.recording, terms) and fps is None:
        return found.recording
    made = make_face(face, deformer, running=True)
    if kind.name == "fap":
        return measured(found, made, fps, ending.told)
    performance = found.performance(made)
    if kind.name == "emotionml":
        return score_of_performance(performance, default_inference(), fps or 25.0)
    if kind.name == "openface":
        return action_units_of(performance)
    if kind.name == "live-link":
        with progress(output.name, len(performance)) as told:
            return Performer(made.model).arkit_stream(performance, told)
    return performance


def _summary(path: Path, kind: FileKind, recording: Recording) -> dict[str, Any]:
    """The facts of one of the two files, JSON-ready."""
    from agentface.bml.block import Block
    from agentface.emotion.score import Score
    from agentface.mpeg4.fap_stream import FapStream

    last_s: float | None
    if isinstance(recording, Block):
        frames, rate, last_s = None, None, None
    elif isinstance(recording, Score):
        frames, rate, last_s = None, None, recording.duration_s
    elif isinstance(recording, FapStream):
        frames, rate, last_s = len(recording), recording.rate, (len(recording) - 1) / recording.rate
    else:
        frames, rate, last_s = len(recording), getattr(recording, "rate_hz", None), float(recording.times_s[-1])
    return {
        "file": str(path),
        "kind": kind.name,
        "frames": frames,
        "rate_hz": rate,
        "duration_s": None if last_s is None else round(last_s, 6),
        "notes": [str(note) for note in getattr(recording, "notes", ())],
    }
