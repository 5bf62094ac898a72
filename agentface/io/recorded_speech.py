"""Recordings of speech: heard by a recogniser, or with a file that says when each phone is said."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Literal

from agentface.config import Document, Table
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.io.files import write_file
from agentface.io.sound import HEARD_HZ, read_sound
from agentface.io.video import SOUND_HZ
from agentface.requests.say import script_of
from agentface.speech.alphabets import phone_table
from agentface.speech.hearing import aligned, heard
from agentface.speech.phones import Phone, phones_of
from agentface.speech.spoken import Spoken
from agentface.speech.voices.flite import Flite

FORMAT = "agentface phones"
_HEAD = 200


class RecordedSpeechFile(Table):
    """The times of a recording's phones."""

    format: Literal["agentface phones"]
    version: Literal[1]
    sound: str
    text: str = ""
    phones: list[list[str | float]]


def is_phones_file(path: str | Path) -> bool:
    """Whether a file says that it is one."""
    try:
        with Path(path).open("rb") as file:
            return f'"{FORMAT}"'.encode() in file.read(_HEAD)
    except OSError:
        return False


def read_recorded(path: str | Path) -> Spoken:
    """A recording with the times of its phones: a JSON object, and beside it the ``sound`` that it names.

    ``phones`` are rows of symbol, start and end in seconds, in any alphabet of ``rules/phones.yaml``. Raises DataError
    with every fault.
    """
    path = Path(path)
    document = Document(path)
    file = document.parse(RecordedSpeechFile)
    phones: list[Phone] = []
    for number, row in enumerate(file.phones):
        try:
            phones_of((*phones[-1:], *phones_of([row])))
            phone_table().looks([str(row[0])])
        except InvalidValueError as error:
            document.fault(("phones", number), error.expected, repr(error.got))
        except UnknownNameError as error:
            document.fault(("phones", number), "a phone of rules/phones.yaml", repr(error.got))
        else:
            phones += phones_of([row])
    if not file.phones:
        document.fault(("phones",), "one phone or more", "none")
    document.check()
    return Spoken(read_sound(path.parent / file.sound, SOUND_HZ), tuple(phones), (), file.text)


def write_recorded(path: str | Path, spoken: Spoken, sound: str) -> None:
    """Write the times of the phones beside ``sound``, the name of its file there; raises OutputError."""
    head = {"format": FORMAT, "version": 1, "sound": sound, "text": spoken.text}
    rows = [json.dumps([p.symbol, round(p.start_s, 3), round(p.end_s, 3)], ensure_ascii=False) for p in spoken.phones]
    lines = [f"  {json.dumps(name)}: {json.dumps(value, ensure_ascii=False)}," for name, value in head.items()]
    table = ",\n".join(f"    {row}" for row in rows)
    content = "\n".join(["{", *lines, '  "phones": [', table, "  ]", "}", ""])
    write_file(path, content.encode())


def hear(path: str | Path, text: str | None = None) -> Spoken:
    """What is said in a sound file, in English: by ear, or, better, as it is the recording of ``text``.

    Raises DataError for a file that is no sound, SpeechError where there is no recogniser, InvalidValueError for a
    text that is not what is said.
    """
    sound = read_sound(path, HEARD_HZ)
    if text is None:
        spoken = Spoken.of(heard(sound))
    else:
        lines = script_of(text).lines
        starts = [sum(len(line.text) + 1 for line in lines[:number]) for number in range(len(lines))]
        tags = [replace(tag, at=start + tag.at) for line, start in zip(lines, starts, strict=True) for tag in line.tags]
        plain = " ".join(line.text for line in lines)
        found = aligned(sound, plain, _pronounce, [tag.at for tag in tags])
        spoken = Spoken(sound, found.phones, tuple(zip(found.marks_s, tags, strict=True)), plain)
    return replace(spoken, sound=read_sound(path, SOUND_HZ))


@cache
def _flite() -> Flite:
    return Flite()


def _pronounce(word: str) -> tuple[str, ...]:
    return _flite().pronounce(word)
