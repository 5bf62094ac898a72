"""What agent kits call a face by: a :class:`Speaker`, and adapters that are thin around it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from agentface.agents.drawing import Drawing
    from agentface.agents.pieces import Piece, SegmentEnd, SoundPiece, VideoFrame
    from agentface.agents.speaker import Speaker

_HOMES = {
    "Drawing": "drawing",
    "Piece": "pieces",
    "SegmentEnd": "pieces",
    "SoundPiece": "pieces",
    "Speaker": "speaker",
    "VideoFrame": "pieces",
}

__all__ = ["Drawing", "Piece", "SegmentEnd", "SoundPiece", "Speaker", "VideoFrame"]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'agentface.agents' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(f"agentface.agents.{_HOMES[name]}"), name)
