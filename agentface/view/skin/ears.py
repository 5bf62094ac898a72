"""The relief of the ears, whose folds are narrower than the light that reaches skin elsewhere tells apart."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.head.model import HeadModel
from agentface.mesh.evening import evened
from agentface.mesh.smoothstep import smoothstep

_FROM, _WHOLLY = 0.55, 0.95
"""Of ``material``'s ear, from where on and where wholly skin is that of the auricle."""
_WIDTHS = ((2, 0.0009, 0.45), (8, 0.0030, 0.65))
"""Furrows and the bowl: the times that the surface is evened out to find them, metres below it where they are as deep
as they get, and how much of the light they lack."""


def auricle(model: HeadModel) -> Doubles:
    """``(V,)`` 0..1: the skin of the ears that stands off the head."""
    return smoothstep(_FROM, _WHOLLY, model.material[:, 3])


def ear_light(model: HeadModel) -> Doubles:
    """``(V,)`` 0..1: of the light that reaches the ears what their hollows leave; 1 elsewhere."""
    light, ear = np.ones(len(model.vertices)), auricle(model)
    for times, deepest, lacking in _WIDTHS:
        off = evened(model.vertices, model.triangles, times) - model.vertices
        below = (off * model.normals).sum(axis=1)
        light *= 1.0 - lacking * ear * smoothstep(0.0, deepest, below)
    return light


def sharp_ears(model: HeadModel, sharp: Floats, soft: Floats) -> Floats:
    """``(V, 3)``: normals ``soft``, at the ears ``sharp``: light does not get from fold to fold through them."""
    part = auricle(model)[:, None]
    mixed = (1.0 - part) * soft + part * sharp
    return np.asarray(mixed / np.maximum(np.linalg.norm(mixed, axis=1, keepdims=True), 1e-9), np.float32)
