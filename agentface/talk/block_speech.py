"""The speeches of a BML block: what is said, and when its sync points are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from agentface.bml.block import STARTS, Block, SyncPoint, Text
from agentface.bml.timetable import Timetable, schedule
from agentface.requests.say import emotion_of
from agentface.speech.script import Script
from agentface.speech.sound import Sound, mixed
from agentface.speech.spoken import Spoken, speak_script
from agentface.speech.voices.voice import Voice

_MARK = "bml-sync-"
"""Sync points go through the voice as tags of this name, whose words it times."""


def script_of_speech(text: Text) -> Script:
    """The sentences of a speech, its sync points among their tags; raises InvalidValueError."""
    pieces = [piece.replace(f"[{_MARK}", "[") for piece in text.pieces]
    marked = pieces[0]
    for number, piece in enumerate(pieces[1:]):
        marked += f"[{_MARK}{number}]" + (f" {piece}" if piece.startswith("(") else piece)  # not a link of Markdown
    return Script.of(marked, lambda name: name if name.startswith(_MARK) else emotion_of(name))


def without_syncs(spoken: Spoken, text: Text) -> tuple[Spoken, tuple[float, ...]]:
    """A speech as it is performed, and the seconds from each of its sync points to the next."""
    times = {tag.name: at for at, tag in spoken.tags if tag.name.startswith(_MARK)}
    tags = tuple((at, tag) for at, tag in spoken.tags if not tag.name.startswith(_MARK))
    points, last = [0.0], 0.0
    for number in range(len(text.syncs)):
        last = min(max(times.get(f"{_MARK}{number}", last), last), spoken.duration_s)
        points.append(last)
    points.append(spoken.duration_s)
    steps = tuple(later - earlier for earlier, later in pairwise(points))
    return replace(spoken, tags=tags), steps


def speak_block(voice: Voice, block: Block) -> Block:
    """The block with all its speeches spoken; raises what the voice raises."""
    found: dict[str, Spoken] = {}
    for behavior in block.speeches:
        if isinstance(behavior.does, Text):
            found[behavior.id] = speak_script(voice, script_of_speech(behavior.does))
    return block.voiced(found)


def performed(block: Block, spoken: Mapping[str, Spoken]) -> dict[str, tuple[Spoken, Sequence[float]]]:
    """By the id of a speech, what is performed of it and the seconds from each sync point to the next."""
    return {
        behavior.id: without_syncs(spoken[behavior.id], behavior.does)
        for behavior in block.speeches
        if isinstance(behavior.does, Text)
    }


def spoken_timetable(block: Block) -> Timetable:
    """When everything is in a block whose speeches are spoken; raises DataError for times that cannot be."""
    return schedule(block, {name: steps for name, (_, steps) in performed(block, dict(block.spoken)).items()})


def block_sound(block: Block, rate_hz: int) -> Sound | None:
    """What is heard of a block whose speeches are spoken, from its start on; None where it says nothing."""
    times = spoken_timetable(block).times
    parts = [(times[SyncPoint(name, STARTS)], spoken.sound) for name, spoken in block.spoken]
    return mixed(parts, rate_hz) if parts else None
