"""A facial animation engine for conversational agents: an emotion message comes in, a face shows it.

The names below are imported when they are first used, so that importing agentface costs about as much as numpy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from agentface.deform.geometry import FaceGeometry
    from agentface.emotion.state import EMOTIONS, EmotionState
    from agentface.errors import AgentFaceError
    from agentface.face import Face
    from agentface.head.model import HeadModel, load_model
    from agentface.parameters import FacePose

    __version__: str

_HOMES = {
    "AgentFaceError": "errors",
    "EMOTIONS": "emotion.state",
    "EmotionState": "emotion.state",
    "Face": "face",
    "FaceGeometry": "deform.geometry",
    "FacePose": "parameters",
    "HeadModel": "head.model",
    "load_model": "head.model",
}

__all__ = [
    "EMOTIONS",
    "AgentFaceError",
    "EmotionState",
    "Face",
    "FaceGeometry",
    "FacePose",
    "HeadModel",
    "__version__",
    "load_model",
]


def __getattr__(name: str) -> Any:
    if name == "__version__":
        from importlib.metadata import version

        return version("agentface")
    if name not in _HOMES:
        raise AttributeError(f"module 'agentface' has no attribute {name!r}")
    from importlib import import_module

    value = getattr(import_module(f"agentface.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
