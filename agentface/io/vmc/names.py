"""What blend shapes are called in the VMC protocol.

Its senders must offer the names of VRM 0's presets, its receivers must know those of VRM 0 and 1 (specification 3.1).
Avatars with "Perfect Sync" have ARKit's 52 shapes beside them: the first letter large where they are VRM 0's, and as
ARKit writes them where they are VRM 1's.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from agentface.errors import UnknownNameError
from agentface.head.arkit import ARKIT_SHAPES
from agentface.vrm.expressions import PRESETS, expression_table

NAMES = ("vrm0", "vrm1", "perfect-sync", "arkit")
"""What a sender may use: presets as VRM 0 or VRM 1 calls them, or the 52 as VRM 0 or VRM 1 avatars do."""


def names_of(kind: str) -> tuple[str, ...]:
    """The names of ``NAMES`` in the order of ``PRESETS`` or of ``ARKIT_SHAPES``; raises UnknownNameError."""
    if kind not in NAMES:
        raise UnknownNameError("kind of names", kind, NAMES)
    if kind == "vrm0":
        return tuple(row.vrm0 for row in expression_table().values())
    if kind == "perfect-sync":
        return tuple(name[0].upper() + name[1:] for name in ARKIT_SHAPES)
    return PRESETS if kind == "vrm1" else ARKIT_SHAPES


def looks_of(kind: str) -> list[int]:
    """Where among the names those stand by which eyes turn."""
    return [place for place, name in enumerate(names_of(kind)) if name.lower().startswith(("look", "eyelook"))]


def are_presets(kind: str) -> bool:
    """Whether these are names of presets and not of ARKit's weights."""
    return kind.startswith("vrm")


@cache
def presets_by_name() -> Mapping[str, str]:
    """VRM 1's preset by each name that a tracker may use."""
    return {name: preset for kind in ("vrm0", "vrm1") for name, preset in zip(names_of(kind), PRESETS, strict=True)}


@cache
def weights_by_name() -> Mapping[str, str]:
    """ARKit's weight by each name that a tracker may use."""
    kinds = ("perfect-sync", "arkit")
    return {name: shape for kind in kinds for name, shape in zip(names_of(kind), ARKIT_SHAPES, strict=True)}
