"""What every deformer keeps to, and the one list of them by name.

A program adds a deformer of its own with :func:`register`; everything that takes ``deformer=`` or ``--deformer`` finds
it there.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Protocol, TypeAlias

from agentface.conventions import Floats
from agentface.deform.geometry import FaceArrays, FaceGeometry
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.head.model import HeadModel
from agentface.kernel import can_compile
from agentface.parameters import FacePose


class Deformer(Protocol):
    """Makes a face of a pose, or of the poses that it went through."""

    def reset(self, pose: FacePose) -> None:
        """Stand still in ``pose``, whatever came before."""

    def step(self, pose: FacePose, dt: float) -> FaceGeometry:
        """The face after ``dt`` seconds in which it was on its way to ``pose``.

        Its arrays hold until this deformer's next step, and nothing else overwrites them.
        """

    def at(self, pose: FacePose) -> FaceGeometry:
        """The face at rest in ``pose``, in arrays of its own: what a still picture shows. Changes nothing."""


Frames: TypeAlias = Callable[[int, int, Floats, FaceArrays], None]
"""``frames(first, last, poses, faces)`` writes the faces of the rows ``first..last - 1`` of ``poses (B, COUNT)``."""


class ParallelDeformer(Deformer, Protocol):
    """A deformer without memory that can do many faces at once."""

    def worker(self) -> Frames:
        """Writes rows of poses into rows of faces; each worker may be at work at the same time as the others."""


class DeformerFactory(Protocol):
    """Makes a deformer of a face."""

    def __call__(self, model: HeadModel, *, compiled: bool = True) -> Deformer:
        """``compiled=False`` asks for numpy forms: ready at once, slow a frame."""


Factory: TypeAlias = DeformerFactory | str
"""A factory, or ``module:name`` of one, which is imported when it is first asked for."""
DEFAULT_DEFORMER = "geometric"
_DEFORMERS: dict[str, Factory] = {
    DEFAULT_DEFORMER: "agentface.deform.pipeline:GeometricDeformer",
    "tissue": "agentface.tissue.deformer:TissueDeformer",
    "tissue-semi-implicit": "agentface.tissue.deformer:SemiImplicitTissue",
    "tissue-adaptive": "agentface.tissue.deformer:AdaptiveTissue",
}
TISSUE_DEFORMERS = tuple(name for name, factory in _DEFORMERS.items() if str(factory).startswith("agentface.tissue."))
"""Those that need a face's ``tissue.yaml``."""


def register(name: str, factory: Factory) -> Callable[[], None]:
    """Add a deformer under a new name; the function that is returned takes it away again.

    Raises InvalidValueError for a name that is taken.
    """
    if name in _DEFORMERS:
        raise InvalidValueError("deformer", "a name of its own", name, f"taken: {', '.join(_DEFORMERS)}")
    _DEFORMERS[name] = factory

    def take_away() -> None:
        _DEFORMERS.pop(name, None)

    return take_away


def deformer_names() -> tuple[str, ...]:
    """The names that ``deformer=`` takes."""
    return tuple(_DEFORMERS)


def check_deformer(name: str) -> None:
    """Raise UnknownNameError for a deformer that is not there."""
    if name not in _DEFORMERS:
        raise UnknownNameError("deformer", name, deformer_names())


def make_deformer(name: str, model: HeadModel, *, compiled: bool = True) -> Deformer:
    """The deformer ``name`` of a face, by numpy forms where nothing can be compiled; raises UnknownNameError."""
    check_deformer(name)
    factory = _DEFORMERS[name]
    if isinstance(factory, str):
        module, _, attribute = factory.partition(":")
        factory = getattr(import_module(module), attribute)
    made: Deformer = factory(model, compiled=compiled and can_compile())
    return made
