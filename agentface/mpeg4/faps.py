"""The 68 facial animation parameters by number and by name."""

from __future__ import annotations

from agentface.errors import InvalidValueError, UnknownNameError
from agentface.mpeg4.fap_table import FAP_COUNT, HIGH_LEVEL, Fap, load_faps

__all__ = ["FAPS", "FAP_COUNT", "FAP_NAMES", "LOW_LEVEL", "Fap", "fap"]

FAPS: tuple[Fap, ...] = load_faps()
"""FAP n is ``FAPS[n - 1]``."""
FAP_NAMES: tuple[str, ...] = tuple(each.name for each in FAPS)
LOW_LEVEL: tuple[Fap, ...] = FAPS[HIGH_LEVEL:]
"""The 66 that move feature points."""
_BY_NAME = {each.name: each for each in FAPS}


def fap(which: int | str) -> Fap:
    """The FAP of a number or a name; raises InvalidValueError or UnknownNameError."""
    if isinstance(which, str):
        if which not in _BY_NAME:
            raise UnknownNameError("FAP", which, FAP_NAMES)
        return _BY_NAME[which]
    if isinstance(which, bool) or not isinstance(which, int) or not 1 <= which <= FAP_COUNT:
        raise InvalidValueError("FAP", f"a number in 1..{FAP_COUNT}, or a name", which)
    return FAPS[which - 1]
