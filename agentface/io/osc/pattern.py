"""OSC address patterns: which addresses one message is meant for.

Open Sound Control 1.0, "OSC Message Dispatching and Pattern Matching": part by part between the slashes, ``?`` is any
character, ``*`` any sequence of them, ``[a-z]`` one of some, ``[!a-z]`` one of the others, ``{foo,bar}`` one of some
strings.
"""

from __future__ import annotations

import re
from functools import lru_cache

LONGEST = 256
"""Characters; a longer pattern matches nothing."""
_TOKEN = re.compile(r"\*+|\?|\[([^\]]*)\]|\{([^}]*)\}|[^*?\[\]{}]")
_SPECIAL = frozenset("*?[]{}")


def is_pattern(address: str) -> bool:
    """Whether it may stand for several addresses."""
    return not _SPECIAL.isdisjoint(address)


def matches(pattern: str, address: str) -> bool:
    """Whether ``address`` is one of those that ``pattern`` stands for, in a time that no pattern makes long."""
    return len(pattern) <= LONGEST and _matches(pattern, address)


@lru_cache(maxsize=1024)
def _matches(pattern: str, address: str) -> bool:
    patterns, parts = pattern.split("/"), address.split("/")
    return len(patterns) == len(parts) and all(map(_part, patterns, parts))


def _part(pattern: str, part: str) -> bool:
    """Follow all ways through the pattern at once: ``places`` is how far into ``part`` they may be."""
    places, read = {0}, 0
    for token in _TOKEN.finditer(pattern):
        if token.start() != read:  # a bracket that is not closed
            return False
        read = token.end()
        places = _advance(token, part, places)
    return read == len(pattern) and len(part) in places


def _advance(token: re.Match[str], part: str, places: set[int]) -> set[int]:
    text, some, strings = token[0], token[1], token[2]
    if text[0] == "*":
        return set(range(min(places, default=len(part) + 1), len(part) + 1))
    if strings is not None:
        return {
            place + len(string) for string in strings.split(",") for place in places if part.startswith(string, place)
        }
    return {place + 1 for place in places if place < len(part) and (text == "?" or _is_one(part[place], text, some))}


def _is_one(char: str, text: str, some: str | None) -> bool:
    if some is None:
        return char == text
    negated = some.startswith("!")
    listed = some[negated:]
    ranges = re.findall(r"(.)-(.)|(.)", listed, re.DOTALL)
    return negated != any(first <= char <= last if first else char == single for first, last, single in ranges)
