"""The faces that ship, and deformers of them that tests share: nothing may write to their arrays."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from agentface.deform.pipeline import GeometricDeformer
from agentface.head.model import HeadModel, load_model
from agentface.head.muscles import MusclesFile
from agentface.resources import DEFAULT_FACE


def head_model(
    face: str | Path = DEFAULT_FACE, muscles: MusclesFile | None = None, asymmetry: float = 0.0
) -> HeadModel:
    """As :func:`load_model`; its own mirror image if nothing else is said."""
    return load_model(face, muscles, asymmetry)


@cache
def deformer_of(face: str = DEFAULT_FACE, *, compiled: bool = True) -> GeometricDeformer:
    """A deformer that other tests have used before and will use."""
    return GeometricDeformer(head_model(face), compiled=compiled)
