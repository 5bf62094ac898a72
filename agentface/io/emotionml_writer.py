"""Scores as EmotionML documents, in the vocabulary of the six.

Source: Emotion Markup Language 1.0, W3C Recommendation 22 May 2014.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from xml.sax.saxutils import escape, quoteattr

import numpy as np

from agentface.emotion.score import Cue, Score
from agentface.emotion.state import EMOTIONS, NEUTRAL
from agentface.io.emotion_vocabularies import BIG6
from agentface.io.emotionml_grammar import NAMESPACE

_OWN = "agentface"
"""The vocabulary of documents in which ``neutral`` is shown, which big6 does not have."""


def write_emotionml(score: Score, *, reference: str | None = None, info: str | None = None) -> str:
    """The document of a score; what is read of it is the same score, its times rounded to milliseconds.

    Emotions that begin and end together are one ``<emotion>``. Their times count from the beginning of the document, or
    of what the URI ``reference`` names, a film for example. ``info`` is text for people.
    """
    used = {cue.emotion for cue in score.cues}
    lines = ['<?xml version="1.0" encoding="UTF-8"?>']
    lines.append(f'<emotionml version="1.0" xmlns="{NAMESPACE}" category-set={quoteattr(_set(used))}>')
    if info is not None:
        lines.append(f"  <info>{escape(_plain(info))}</info>")
    if NEUTRAL in used:
        items = "".join(f'<item name="{name}"/>' for name in (*EMOTIONS, NEUTRAL))
        lines.append(f'  <vocabulary type="category" id="{_OWN}">{items}</vocabulary>')
    of = "" if reference is None else f" time-ref-uri={quoteattr(_plain(reference))}"
    last_s = max((cue.end_s for cue in score.cues), default=0.0)
    rest = [Cue(EMOTIONS[0], last_s, score.duration_s, (0.0,))] if score.duration_s > last_s else []
    for start, end, cues in _together([*score.cues, *rest]):
        lines.append(f'  <emotion offset-to-start="{start}" duration="{end - start}"{of}>')
        lines += [f"    {_category(cue)}" for cue in cues]
        lines.append("  </emotion>")
    return "\n".join([*lines, "</emotionml>", ""])


def _plain(text: str) -> str:
    """A text without what XML cannot hold."""
    return "".join(letter for letter in text if letter.isprintable() or letter in "\n\t")


def _set(used: set[str]) -> str:
    return f"#{_OWN}" if NEUTRAL in used else BIG6


def _together(told: Iterable[Cue]) -> Iterator[tuple[int, int, list[Cue]]]:
    """Start and end in milliseconds, and the cues of them, each emotion once."""
    open_: dict[tuple[int, int], list[dict[str, Cue]]] = {}
    for cue in told:
        start = round(1000.0 * cue.start_s)
        groups = open_.setdefault((start, max(round(1000.0 * cue.end_s), start + 1)), [])
        group = next((group for group in groups if cue.emotion not in group), None)
        if group is None:
            group = {}
            groups.append(group)
        group[cue.emotion] = cue
    for (start, end), groups in open_.items():
        for group in groups:
            yield start, end, list(group.values())


def _category(cue: Cue) -> str:
    if len(cue.samples) == 1:
        return f'<category name="{cue.emotion}" value="{cue.samples[0]:.7g}"/>'
    rate = np.format_float_positional(cue.rate_hz, trim="-")
    samples = " ".join(f"{sample:.7g}" for sample in cue.samples)
    return f'<category name="{cue.emotion}"><trace freq="{rate}Hz" samples="{samples}"/></category>'
