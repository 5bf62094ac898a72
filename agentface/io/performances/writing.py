"""Performances to files of every kind that is written."""

from __future__ import annotations

from pathlib import Path

from agentface.arkit.stream import ArkitStream
from agentface.emotion.score import Score
from agentface.errors import OutputError
from agentface.io.emotionml_writer import write_emotionml
from agentface.io.files import write_file
from agentface.io.performances.kinds import FileKind, Recording, kind_named
from agentface.io.performances.live_link import write_live_link
from agentface.io.performances.openface import WRITTEN, write_openface
from agentface.io.performances.poses_json import write_json
from agentface.io.performances.poses_npz import write_npz
from agentface.io.performances.unit_stream import ActionUnitStream
from agentface.motion.performance import Performance
from agentface.mpeg4.fap_file import write_fap
from agentface.mpeg4.fap_stream import FapStream

WRITERS = ("fap", "openface", "live-link", "poses-json", "poses-npz", "emotionml")
"""The kinds that are written, by name; of several with one suffix, the first is meant."""


def kind_of_output(path: str | Path, name: str | None = None) -> FileKind:
    """The kind of a file that is to be written: ``name``, or what its suffix means. Raises OutputError."""
    path = Path(path)
    for known in WRITERS:
        kind = kind_named(known)
        if name == known or (name is None and path.suffix.lower() == kind.suffix):
            return kind
    expected = ", ".join(f"{kind_named(known).suffix} ({known})" for known in WRITERS)
    raise OutputError(f"{path}: expected a name that ends in one of {expected}")


def terms_of(kind: FileKind) -> type[Recording]:
    """What a kind of file holds."""
    terms: dict[str, type[Recording]] = {
        "fap": FapStream,
        "openface": ActionUnitStream,
        "live-link": ArkitStream,
        "emotionml": Score,
    }
    return terms.get(kind.name, Performance)


def action_units_of(performance: Performance) -> ActionUnitStream:
    """The action units of OpenFace's own tables that a performance shows."""
    return ActionUnitStream.of(performance, WRITTEN)


def write(path: str | Path, kind: FileKind, recording: Recording) -> None:
    """Write a recording in the terms of ``kind`` to a file, as a whole or not at all; raises OutputError."""
    write_file(path, _bytes_of(kind, recording))


def _bytes_of(kind: FileKind, recording: Recording) -> bytes:
    if isinstance(recording, Performance) and kind.name == "poses-npz":
        return write_npz(recording)
    if isinstance(recording, Performance):
        return write_json(recording).encode()
    if isinstance(recording, FapStream):
        return write_fap(recording).encode()
    if isinstance(recording, ActionUnitStream):
        return write_openface(recording).encode()
    if isinstance(recording, ArkitStream):
        return write_live_link(recording).encode()
    assert isinstance(recording, Score), "what is written is of a kind that can be"  # noqa: S101 - for the type checker
    return write_emotionml(recording).encode()
