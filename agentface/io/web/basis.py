""":class:`Basis`: a face's movements as weights of a few modes, for all that its deformer can do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from agentface.conventions import Floats
from agentface.deform.crowd import Crowd
from agentface.deform.geometry import FaceGeometry
from agentface.head.model import HeadModel
from agentface.io.web.modes import Modes, principal_modes, stored
from agentface.io.web.poses import natural_poses, random_mixtures
from agentface.io.web.unfinished import Unfinished

SKIN_MODES, TONGUE_MODES = 128, 68
_SAMPLES = {True: (1600, 800), False: (500, 300)}
"""Random mixtures and natural poses that a basis is made of: of a deformer that does many at once, and of another."""
_MARGIN = 1.25  # beyond the farthest sample
_SEED = 14
_CHUNK = 64


@dataclass(frozen=True, eq=False)
class Basis:
    """The modes of the skin before its last stages (:mod:`agentface.io.web.unfinished`), and of the tongue.

    Attributes:
        skin: of the V vertices of the skin.
        tongue: of the T vertices of the tongue, before the jaw moves it.
    """

    skin: Modes
    tongue: Modes


class Projector:
    """Finds the weights of geometries.

    Args:
        model: the face.
        basis: its modes.
    """

    def __init__(self, model: HeadModel, basis: Basis) -> None:
        self._unfinished = Unfinished(model)
        self._skin, self._tongue = _inverse(basis.skin), _inverse(basis.tongue)
        self._at_rest = model.vertices, model.parts["tongue"].attributes["POSITION"]

    def weights(self, geometry: FaceGeometry) -> tuple[Floats, Floats]:
        """The weights of the skin's modes and of the tongue's; they lie in -1..1 but for what is past all samples."""
        skin = self._unfinished.skin(geometry) - self._at_rest[0]
        tongue = geometry.tongue - self._at_rest[1]
        return self._skin @ skin.ravel(), self._tongue @ tongue.ravel()


def make_basis(
    model: HeadModel, deformer: str, told: Callable[[float], object] = lambda _: None, *, many: bool = True
) -> Basis:
    """The basis of a face and a deformer; ``told`` is told how much of the work is done, 0..1.

    ``many``: whether the deformer is quick enough for some thousand faces.
    """
    rng = np.random.default_rng(_SEED)
    with Crowd(model, deformer=deformer) as crowd:
        mixtures, natural = _SAMPLES[many]
        poses = np.concatenate([random_mixtures(mixtures, rng), natural_poses(model, natural, rng)])
        skin, tongue = sampled(crowd, poses, told)
    return Basis(_modes(skin, SKIN_MODES, rng), _modes(tongue, TONGUE_MODES, rng))


def sampled(crowd: Crowd, poses: Floats, told: Callable[[float], object] = lambda _: None) -> tuple[Floats, Floats]:
    """How far ``poses (S, COUNT)`` move the unfinished skin ``(S, 3 V)`` and the tongue ``(S, 3 T)``, in m."""
    model = crowd.model
    unfinished, rest = Unfinished(model), model.parts["tongue"].attributes["POSITION"]
    skin = np.empty((len(poses), model.vertices.size), np.float32)
    tongue = np.empty((len(poses), rest.size), np.float32)
    for first in range(0, len(poses), _CHUNK):
        part = slice(first, first + _CHUNK)
        faces = crowd.deform(poses[part])
        skin[part] = (unfinished.skin(faces) - model.vertices).reshape(len(faces), -1)
        tongue[part] = (faces.tongue - rest).reshape(len(faces), -1)
        told(min(1.0, (first + _CHUNK) / len(poses)))
    return skin, tongue


def _modes(samples: Floats, count: int, rng: np.random.Generator) -> Modes:
    rows = principal_modes(samples, count, rng)
    return stored(rows, _MARGIN * np.abs(samples @ rows.T).max(axis=0))


def _inverse(modes: Modes) -> Floats:
    """``(K, 3 N)``: what takes movements to the weights that come nearest to them."""
    shapes = modes.shapes.reshape(len(modes.shapes), -1).astype(np.float32)
    solved = np.linalg.solve((shapes @ shapes.T).astype(np.float64), shapes)
    return np.ascontiguousarray(solved / modes.scales[:, None], np.float32)
