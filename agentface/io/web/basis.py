""":class:`Basis`: a face's movements as weights of a few modes, for all that its deformer can do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform import tables as deform_tables
from agentface.deform.crowd import Crowd
from agentface.deform.geometry import FaceGeometry
from agentface.head.model import HeadModel
from agentface.io.web.modes import ModeSet, principal_modes, stored
from agentface.io.web.poses import natural_poses, random_mixtures
from agentface.io.web.unfinished import Unfinished

SKIN_MODES, TONGUE_MODES = 116, 79
SAMPLES, FEW_SAMPLES = (1600, 800), (500, 300)
"""Random mixtures and natural poses that a basis is made of: of a deformer that does many at once, and of another."""
_TONGUE = 0.35
_MEASURED = 1200  # points
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

    skin: ModeSet
    tongue: ModeSet


class Projector:
    """Finds the weights of geometries.

    Args:
        model: the face.
        basis: its modes.
    """

    def __init__(self, model: HeadModel, basis: Basis) -> None:
        neck = deform_tables.of(model).finish.neck.where
        self._skin = _Part(basis.skin, model.vertices, _MEASURED, neck)
        self._tongue = _Part(basis.tongue, model.parts["tongue"].attributes["POSITION"], _MEASURED)

    def weights(self, geometry: FaceGeometry) -> tuple[Floats, Floats]:
        """The weights of the skin's modes and of the tongue's; they lie in -1..1 but for what is past all samples."""
        there = self._skin.places
        lying = geometry.vertices[there] - geometry.wrinkles[there, None] * geometry.smooth_normals[there]
        return self._skin.weights(lying), self._tongue.weights(geometry.tongue[self._tongue.places])


class _Part:
    """Finds weights by some of the points, which know all but as much as all of them do.

    Args:
        modes: the movements.
        rest: ``(N, 3)`` m, the points at rest.
        count: how many points are measured; those that move more are likelier to be among them.
        without: points that are not.

    Attributes:
        places: which points are measured.
    """

    def __init__(self, modes: ModeSet, rest: Floats, count: int, without: Indices | None = None) -> None:
        shapes = modes.shapes.astype(np.float64)
        likely = np.sqrt((shapes / np.linalg.norm(shapes, axis=(1, 2), keepdims=True)) ** 2).sum(axis=(0, 2))
        if without is not None:
            likely[without] = 0.0
        count = min(count, int(np.count_nonzero(likely)))
        drawn = np.random.default_rng(_SEED).choice(len(rest), count, replace=False, p=likely / likely.sum())
        self.places = np.sort(drawn).astype(np.int32)
        self._rest = rest[self.places]
        measured = shapes[:, self.places].reshape(len(shapes), -1) * modes.scales[:, None].astype(np.float64)
        size = np.linalg.norm(measured, axis=1, keepdims=True)
        measured /= size
        self._inverse = np.ascontiguousarray(np.linalg.solve(measured @ measured.T, measured) / size, np.float32)

    def weights(self, points: Floats) -> Floats:
        """``(K,)`` of the measured points ``(M, 3)`` m."""
        # einsum, not a product: BLAS would wake up its threads, and wait for a core that another program has
        found: Floats = np.einsum("kn,n->k", self._inverse, (points - self._rest).ravel())
        return found


def make_basis(
    model: HeadModel,
    deformer: str,
    samples: tuple[int, int] = SAMPLES,
    told: Callable[[float], object] = lambda _: None,
) -> Basis:
    """The basis of a face and a deformer, made of so many random mixtures and natural poses.

    ``told`` is told how much of the work is done, 0..1.
    """
    rng = np.random.default_rng(_SEED)
    with Crowd(model, deformer=deformer) as crowd:
        mixtures, natural = samples
        poses = np.concatenate([random_mixtures(mixtures, rng, tongue=_TONGUE), natural_poses(model, natural, rng)])
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


def _modes(samples: Floats, count: int, rng: np.random.Generator) -> ModeSet:
    rows = principal_modes(samples, count, rng)
    return stored(rows, _MARGIN * np.abs(samples @ rows.T).max(axis=0))
