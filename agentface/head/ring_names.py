"""The rings round the mouth and the eyes by name: their places in ``lips.yaml`` and ``eyelids.yaml``."""

from __future__ import annotations

from enum import IntEnum


class LipRing(IntEnum):
    """From where the lips' red begins inside the mouth outward."""

    LINING = 0
    """Where the lining of the mouth begins."""
    CONTACT = 1
    """Where closed lips touch."""
    RED = 4
    """The middle of the red that is seen."""
    BORDER = 7
    """The border of the red."""
    SKIN = 8


class LidRing(IntEnum):
    """From the inner margin of the lids outward; the upper half runs over the fold above the lid."""

    INNER_MARGIN = 0
    """Against the eyeball, where the lids' lining begins."""
    WET_LINE = 1
    """Where tears stand."""
    LASHES = 2
    EDGE = 3
    """The outer edge, where closed lids meet."""
    PLATE = 5
    """The plate of the upper lid, the soft skin of the lower one."""
    CREASE = 8
    """The bottom of the crease above the lid."""
    FOLD = 10
    """The skin that hangs over the crease."""
    ORBIT = 11
    """Where the rim of the orbit begins."""


LIP_RINGS = LipRing.SKIN + 1
RINGS_BEYOND, RINGS_WITHIN = 2, 7
"""Further rings on the skin and inside the mouth that the lips count on, one column to one."""
LID_RINGS = 13
