"""The faces that ship, read once a process: nothing may write to their arrays."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from agentface.deform import tables as frame
from agentface.deform.pipeline import GeometricDeformer
from agentface.head.model import HeadModel, load_model
from agentface.head.muscle_set import MuscleSet
from agentface.head.muscles import MusclesFile
from agentface.resources import DEFAULT_FACE, face_names

_read = cache(load_model)
_prepare = frame.prepare
_prepared = cache(_prepare)


def head_model(
    face: str | Path = DEFAULT_FACE, muscles: MusclesFile | None = None, asymmetry: float = 0.0
) -> HeadModel:
    """As :func:`load_model`, which reads a folder anew each time; its own mirror image if nothing else is said."""
    if face in face_names() and muscles is None:
        return _read(face, asymmetry=asymmetry)
    return load_model(face, muscles, asymmetry)


def uneven_model(
    face: str | Path = DEFAULT_FACE, muscles: MusclesFile | None = None, asymmetry: float = 1.0
) -> HeadModel:
    """As :func:`load_model`."""
    return head_model(face, muscles, asymmetry)


def tables(model: HeadModel) -> tuple[frame.PartTables, MuscleSet]:
    """As :func:`frame.prepare`, whose tables deformers share anyway: each has points of its own."""
    shipped = any(_read(face, asymmetry=part) is model for face in face_names() for part in (0.0, 1.0))
    return _prepared(model) if shipped else _prepare(model)


@cache
def deformer_of(face: str = DEFAULT_FACE, *, compiled: bool = True) -> GeometricDeformer:
    """A deformer that other tests have used before and will use: keep copies of what it gives, write to none of it."""
    return GeometricDeformer(head_model(face), compiled=compiled)
