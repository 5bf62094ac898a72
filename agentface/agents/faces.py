"""``rules/agents.yaml``: what the names mean that agent kits give to faces."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from agentface.config import Table, load
from agentface.emotion.state import NEUTRAL, EmotionState
from agentface.errors import DataError, Fault
from agentface.resources import rules_file

AGENTS_FILE = "agents.yaml"
_Emotion = Literal["happiness", "sadness", "anger", "fear", "disgust", "surprise"]
_Share = Annotated[float | int, Field(gt=0.0, le=1.0)]


class _Names(Table):
    faces: Annotated[dict[str, dict[_Emotion, _Share]], Field(min_length=1)]


def load_faces(path: str | Path) -> dict[str, EmotionState]:
    """What each name in a file shows; raises DataError with every fault."""
    faces = load(path, _Names).faces
    if faces.get(NEUTRAL) != {}:
        got = "none" if NEUTRAL not in faces else str(dict(faces[NEUTRAL]))
        raise DataError([Fault(Path(path), None, f"faces.{NEUTRAL}", "an empty mixture", got)])
    return {
        name: EmotionState.of({str(emotion): share for emotion, share in shares.items()})
        for name, shares in faces.items()
    }


@cache
def default_faces() -> Mapping[str, EmotionState]:
    """Those of ``rules/agents.yaml``."""
    return load_faces(rules_file(AGENTS_FILE))
