"""The kinds of files that are performances, each known by what is in it, and how each is read."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from agentface.arkit.stream import ArkitStream
from agentface.bml.block import Block
from agentface.emotion.score import Score
from agentface.errors import DataError, Fault
from agentface.io.bml.reader import is_bml, load_bml
from agentface.io.emotionml import load_emotionml
from agentface.io.performances import poses_json, poses_npz
from agentface.io.performances.live_link import is_live_link, read_live_link
from agentface.io.performances.openface import is_openface, read_openface
from agentface.io.performances.poses_json import read_json
from agentface.io.performances.poses_npz import read_npz
from agentface.io.performances.py_feat import USUAL_HZ, is_py_feat, read_py_feat
from agentface.io.performances.reading import LONGEST_LINE, lines_of, open_file, read_bytes, unreadable
from agentface.io.performances.unit_stream import ActionUnitStream
from agentface.motion.performance import Performance
from agentface.mpeg4.fap_file import read_fap
from agentface.mpeg4.fap_stream import FapStream

Recording: TypeAlias = Performance | FapStream | ActionUnitStream | ArkitStream | Score | Block
"""What a file holds, in its own terms."""
LARGEST_FAP = 64 * 1024 * 1024
"""Bytes: about two hours of all FAPs at 25 frames a second."""
_FAP = re.compile(rb"\d+\.\d+[ \t]+\S.*?[ \t]+\S+[ \t]+\S+")


@dataclass(frozen=True)
class FileKind:
    """A kind of file.

    Attributes:
        name: as options and summaries have it.
        title: for people.
        suffix: what such files end in.
        knows: whether the beginning of a file, ``LONGEST_LINE`` bytes at most, is one of this kind.
        load: reads a file; the number is its frames a second, for kinds that do not say it; raises DataError.
    """

    name: str
    title: str
    suffix: str
    knows: Callable[[bytes], bool]
    load: Callable[[Path, float | None], Recording]


def kind_of(path: str | Path) -> FileKind:
    """The kind of a file, by its content; where that is none of them, by its name, so that its reader says why.

    Raises DataError for a file that cannot be read, and for one of no kind.
    """
    path = Path(path)
    with open_file(path) as file:
        try:
            begin = file.read(LONGEST_LINE)
        except OSError as error:
            raise unreadable(path, error) from error
    suffix = path.suffix.lower()
    known = [kind for kind in KINDS if kind.knows(begin)] + [kind for kind in KINDS if kind.suffix == suffix]
    if known:
        return known[0]
    expected = ", ".join(kind.title for kind in KINDS)
    raise DataError([Fault(path, None, "", f"one of: {expected}", "none of them" if begin else "an empty file")])


def load(path: str | Path, rate_hz: float | None = None) -> tuple[FileKind, Recording]:
    """What the file at ``path`` holds, and its kind; ``rate_hz`` is its frames a second, if it does not say so itself.

    Raises DataError with the faults of the file; nothing is read by halves.
    """
    path = Path(path)
    kind = kind_of(path)
    return kind, kind.load(path, rate_hz)


def kind_named(name: str) -> FileKind:
    """The kind of this name; raises KeyError."""
    return next(kind for kind in KINDS if kind.name == name)


def _is_zip(begin: bytes) -> bool:
    return begin.startswith(b"PK")


def _is_xml(begin: bytes) -> bool:
    wide = begin.startswith((b"\xff\xfe", b"\xfe\xff"))
    return wide or _unmarked(begin).startswith(b"<")


def _is_json(begin: bytes) -> bool:
    return _unmarked(begin).startswith((b"{", b"["))


def _is_fap(begin: bytes) -> bool:
    lines = (line.strip() for line in _unmarked(begin).splitlines())
    head = next((line for line in lines if line and not line.startswith(b"#")), b"")
    return _FAP.fullmatch(head) is not None


def _unmarked(begin: bytes) -> bytes:
    return begin.removeprefix(b"\xef\xbb\xbf").lstrip()


def _columns(known: Callable[[str], bool]) -> Callable[[bytes], bool]:
    """Whether the first line of a file is one that ``known`` says it is."""
    return lambda begin: known(_unmarked(begin).split(b"\n", 1)[0].decode(errors="replace").strip())


def _load_fap(path: Path, _: float | None) -> FapStream:
    data = read_bytes(path, LARGEST_FAP)
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:  # names of old files
        text = data.decode("latin-1")
    return read_fap(text, path)


def _load_emotionml(path: Path, _: float | None) -> Score:
    return load_emotionml(path)


def _load_bml(path: Path, _: float | None) -> Block:
    return load_bml(path)


def _load_json(path: Path, _: float | None) -> Performance:
    return read_json(read_bytes(path, poses_json.LARGEST_FILE), path)


def _load_npz(path: Path, _: float | None) -> Performance:
    return read_npz(read_bytes(path, poses_npz.LARGEST_FILE), path)


def _load_live_link(path: Path, rate_hz: float | None) -> ArkitStream:
    return read_live_link(lines_of(path), path, rate_hz)


def _load_openface(path: Path, _: float | None) -> ActionUnitStream:
    return read_openface(lines_of(path), path)


def _load_py_feat(path: Path, rate_hz: float | None) -> ActionUnitStream:
    return read_py_feat(lines_of(path), path, USUAL_HZ if rate_hz is None else rate_hz)


KINDS: tuple[FileKind, ...] = (
    FileKind("poses-npz", "poses in NPZ (.npz)", ".npz", _is_zip, _load_npz),
    FileKind("bml", "BML (.bml)", ".bml", is_bml, _load_bml),
    FileKind("emotionml", "EmotionML (.xml)", ".xml", _is_xml, _load_emotionml),
    FileKind("poses-json", "poses in JSON (.json)", ".json", _is_json, _load_json),
    FileKind("fap", "MPEG-4 FAPs (.fap)", ".fap", _is_fap, _load_fap),
    FileKind("openface", "OpenFace (.csv)", ".csv", _columns(is_openface), _load_openface),
    FileKind("live-link", "Live Link Face (.csv)", ".csv", _columns(is_live_link), _load_live_link),
    FileKind("py-feat", "py-feat (.csv)", ".csv", _columns(is_py_feat), _load_py_feat),
)
"""The last three are told apart by the names of their columns; a table with others is taken for OpenFace's."""
