"""What a stranger sees of a smile, in numbers: the cheek bulges, and the laugh line is a soft fold."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.emotion.inference import default_inference
from agentface.head.model import HeadModel, load_model
from agentface.mesh.normals import doubled_areas
from agentface.resources import face_names
from agentface.tissue.deformer import TissueDeformer

BULGE_MM, NOSE_MM, SHARPEST_DEG = 3.0, 2.0, 34.0
BESIDE_THE_MOUTH_MM = np.array([8.0, -25.0, -40.0]), np.array([30.0, 18.0, 20.0])


@pytest.fixture(scope="module", params=face_names())
def smiling(request):
    model = load_model(request.param, asymmetry=0.0)
    return model, TissueDeformer(model).at(default_inference().pose({"happiness": 1.0})).vertices


def dihedral_degrees(model: HeadModel, vertices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The angle between the triangles on both sides of every inner edge, and the edges."""
    triangles = model.triangles
    edges = np.sort(np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    order = np.lexsort(edges.T)
    edges, owner = edges[order], np.tile(np.arange(len(triangles)), 3)[order]
    twice = np.flatnonzero((edges[1:] == edges[:-1]).all(axis=1))
    normals = doubled_areas(vertices.astype(np.float64), triangles)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    cosine = (normals[owner[twice]] * normals[owner[twice + 1]]).sum(axis=1)
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))), edges[twice]


def test_the_cheek_bulges_over_the_smile(smiling):
    model, vertices = smiling
    middle = (model.landmarks["cheek_l"] + model.landmarks["cheekbone_l"]) / 2
    cheek = np.linalg.norm(model.vertices - middle, axis=1) < 0.25 * model.landmarks.eye_separation
    out = ((vertices - model.vertices) * model.normals).sum(axis=1)[cheek]
    assert 1e3 * out.mean() > BULGE_MM


def test_the_laugh_line_is_a_soft_fold(smiling):
    model, vertices = smiling
    angles, edges = dihedral_degrees(model, vertices)
    place = 1e3 * (model.vertices[edges].mean(axis=1) - model.landmarks["mouth_corner_l"])
    beside = ((place > BESIDE_THE_MOUTH_MM[0]) & (place < BESIDE_THE_MOUTH_MM[1])).all(axis=1)
    assert beside.sum() > 200
    assert angles[beside].max() < SHARPEST_DEG


def test_the_nose_stays_where_it_is(smiling):
    model, vertices = smiling
    tip = np.linalg.norm(model.vertices - model.landmarks["nose_tip"], axis=1).argmin()
    assert 1e3 * np.linalg.norm((vertices - model.vertices)[tip]) < NOSE_MM
