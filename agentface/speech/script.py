"""A text as it will be performed: its sentences, and what the face is to show at which word of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from agentface.speech.tags import Tag, split_tags
from agentface.speech.text import check_text, nothing_to_say, sentences, spoken


@dataclass(frozen=True, slots=True)
class Line:
    """One sentence; ``at`` of its tags counts the sentence's own characters."""

    text: str
    tags: tuple[Tag, ...] = ()


@dataclass(frozen=True, slots=True)
class Script:
    """The sentences of a text, one or more, and the tags that nobody knows."""

    lines: tuple[Line, ...]
    unknown: tuple[str, ...] = ()

    @classmethod
    def of(cls, text: str, known: Callable[[str], str | None] = lambda _: None) -> Script:
        """What is spoken of ``text``; ``known`` gives the emotion that a tag's name means, or None.

        Raises InvalidValueError for what is no text, too long, or holds nothing that can be spoken.
        """
        tagged = split_tags(spoken(check_text(text)), known)
        found = sentences(tagged.text)
        if not found:
            raise nothing_to_say(text)
        lines = []
        for number, sentence in enumerate(found):
            last = number == len(found) - 1
            # what stands before the first word belongs to the first sentence, what stands between two to the second
            before = -1 if number == 0 else found[number - 1].start + len(found[number - 1].text) - 1
            end = len(tagged.text) if last else sentence.start + len(sentence.text) - 1
            tags = tuple(
                replace(tag, at=min(max(tag.at - sentence.start, 0), len(sentence.text)))
                for tag in tagged.tags
                if before < tag.at <= end
            )
            lines.append(Line(sentence.text, tags))
        return cls(tuple(lines), tagged.unknown)
