"""What solving for the artists' shapes needs beforehand: features, Jacobian, what serves a shape; made once a model."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from agentface.arkit.sampled_shapes import SampledShapes, basis_of, sample_shapes
from agentface.cache import stamp_of
from agentface.conventions import Doubles, Floats, Indices
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep
from agentface.mpeg4.jacobian import Looks, mean_jacobian
from agentface.mpeg4.natural import natural_poses
from agentface.mpeg4.sight import Features
from agentface.parameters import COUNT, HIGH, LOW, PARAMETERS, indices_of
from agentface.resources import rules_file

Flags = npt.NDArray[np.bool_]
_SOLVED = {"vector", "pseudo", "morph", "jaw"}
_NO_SHAPE = {"ears"}
"""Groups of parameters for which ARKit has no weight: nobody asks for them."""
_LEVELS = (0.3, 1.0)
_FALL = 0.2
"""Of a signed parameter's lower end, the step of differences."""
_MEAN = 20
"""Poses for the Jacobian: natural ones, half as strong."""
_COUPLED = ("orbicularis_oculi_palpebralis", "orbicularis_oculi_orbitalis")
"""Muscles that do something else on one side than on both: their columns are of both eyes, each for its own half."""
_ASIDE, _SERVES = 0.15, 0.35
"""Cosines between what a parameter and a shape do, from which on the parameter serves the shape a little, and fully."""
_FLAT_MM = 1.0
"""mm, a root of a sum of squares over the face: what moves less serves nothing."""


class ShapeFit(NamedTuple):
    """For K features, S skin shapes, F parameters.

    Attributes:
        features: K numbers, a basis of what the shapes and the face do, in mm.
        shapes: ``(S, K)``, the artists' shapes in these features.
        free: ``(F,)`` int32, the parameters that are solved for.
        up, down: ``(K, F)``, features a parameter that grows from 0, and one that falls; the same where there is one.
        serves: ``(S, F)`` 0..1, which parameters serve a shape.
    """

    features: Features
    shapes: Doubles
    free: Indices
    up: Doubles
    down: Doubles
    serves: Doubles


def shape_fit(model: HeadModel, looks: Callable[[Features], Looks]) -> ShapeFit:
    """The fit of a face, kept with its model; ``looks`` makes what looks at poses for some features."""
    fit: ShapeFit = model.derived(f"arkit.shape_fit.{rules_stamp()}", lambda _: _fit(model, looks))
    return fit


def rules_stamp() -> str:
    """A name that changes with the rules that natural poses are made by."""
    return stamp_of(rules_file(name) for name in ("emotions.yaml", "blends.yaml", "visemes.yaml"))


def _fit(model: HeadModel, looks: Callable[[Features], Looks]) -> ShapeFit:
    sampled = sample_shapes(model)
    served = [known.index for known in PARAMETERS if known.kind in _SOLVED and known.group not in _NO_SHAPE]
    free = np.array(served, np.int32)
    plain = looks(Features(sampled.readings, np.eye(sampled.ways.shape[1])))
    basis = basis_of(sampled, plain(_single_poses(free)))
    features = Features(sampled.readings, basis)
    look = looks(features)
    poses, signed = _poses(), LOW[free] < 0.0
    up = np.ascontiguousarray(mean_jacobian(look, poses, free)[:, free])
    down = up.copy()
    down[:, signed] = _falling(look, poses, free[signed])
    for name in _COUPLED:
        _couple(model, sampled, basis, plain, (up, down), free, name)
    shapes = sampled.ways @ basis.T
    return ShapeFit(features, shapes, free, up, down, _serving(shapes, up, down, signed))


def _single_poses(places: Indices) -> Floats:
    """``(.., COUNT)``: every parameter by itself, some of its way to both ends of its range, and all of it."""
    rows = []
    for level in _LEVELS:
        for end in (LOW, HIGH):
            part = np.zeros((len(places), COUNT), np.float32)
            part[np.arange(len(places)), places] = level * end[places]
            rows.append(part[end[places] != 0.0])
    return np.concatenate(rows)


def _poses() -> Floats:
    """Natural poses, half as strong, with signed parameters, eyes and head at rest."""
    poses = np.float32(0.5) * natural_poses(_MEAN, np.random.default_rng(7))
    poses[:, [known.index for known in PARAMETERS if known.low < 0.0 or known.kind not in _SOLVED]] = 0.0
    return poses


def _falling(look: Looks, poses: Floats, places: Indices) -> Doubles:
    """``(K, N)``: features a parameter where it falls from 0, in the mean over poses."""
    step = _FALL * LOW[places]
    total: Doubles | float = 0.0
    for pose in poses:
        trials = np.repeat(pose[None], len(places) + 1, axis=0)
        trials[np.arange(len(places)) + 1, places] = step
        shown = look(trials)
        total = total + (shown[1:] - shown[0]) / step[:, None]
    return np.asarray(total).T / len(poses)


def _couple(
    model: HeadModel, sampled: SampledShapes, basis: Doubles, plain: Looks,
    jacobians: tuple[Doubles, Doubles], free: Indices, name: str,
) -> None:  # fmt: skip
    """Set the columns of a muscle of both sides to what the two do together, each on its own half."""
    pair, level = list(indices_of(name)), 0.5
    poses = np.zeros((2, COUNT), np.float32)
    poses[1, pair] = level
    both = np.diff(plain(poses), axis=0)[0] / level
    left = model.vertices[sampled.readings.vertex, 0] > 0.0
    for index, half in zip(pair, (left, ~left), strict=True):
        place = int(np.flatnonzero(free == index)[0])
        for jacobian in jacobians:
            jacobian[:, place] = basis @ (both * half)


def _serving(shapes: Doubles, up: Doubles, down: Doubles, signed: Flags) -> Doubles:
    """``(S, F)``: by the cosine of what parameter and shape do; of a signed one, the better of its two ways."""

    def cosines(columns: Doubles) -> Doubles:
        sizes = np.linalg.norm(columns, axis=0)
        unit = columns * np.where(sizes > _FLAT_MM, 1.0 / np.maximum(sizes, _FLAT_MM), 0.0)
        return (shapes / np.maximum(np.linalg.norm(shapes, axis=1, keepdims=True), _FLAT_MM)) @ unit

    best = np.where(signed, np.maximum(cosines(up), -cosines(down)), cosines(up))
    return np.asarray(smoothstep(_ASIDE, _SERVES, best))
