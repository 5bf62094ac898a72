"""What only a table and a face together show is told with the place in the table."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from agentface.errors import InvalidValueError, Place
from agentface.head.muscles import Anchor, anchor_point
from agentface.tissue import soundness
from agentface.tissue.lattice import build_lattice
from agentface.tissue.layers import HYPODERMIS
from agentface.tissue.muscles import belly_field, nodal_forces


def with_row(lattice, name, **changes):
    file = lattice.file
    rows = file.muscles | {name: file.muscles[name].model_copy(update=changes)}
    return dataclasses.replace(lattice, file=file.model_copy(update={"muscles": rows}))


def test_a_belly_pushes_out_of_the_face_and_nowhere_else(model, lattice):
    row = lattice.file.muscles["zygomaticus_major"]
    left, right = (belly_field(model, lattice, row, side) for side in "lr")
    assert np.abs(left[model.mirror] * [-1.0, 1.0, 1.0] - right).max() < 1e-6
    away = np.linalg.norm(lattice.rest[HYPODERMIS] * 1e-3 - anchor_point(row.belly, "l", model.landmarks), axis=1)
    size = (left * lattice.normals).sum(axis=1)
    assert (size >= 0.0).all()
    assert np.allclose(size, np.linalg.norm(left, axis=1))
    assert not size[away > row.belly.radius * model.landmarks.eye_separation].any()
    assert size.max() > 0.5 * row.belly.strength
    assert not belly_field(model, lattice, row.model_copy(update={"belly": None}), "l").any()


def test_a_muscle_of_no_length_is_told(model, lattice):
    end = lattice.file.muscles["risorius"].insertion
    with pytest.raises(InvalidValueError, match="a point apart from the origin") as caught:
        nodal_forces(model, with_row(lattice, "risorius", origin=end))
    assert caught.value.place == Place("tissue.yaml", ("muscles", "risorius", "insertion"))


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("mentalis", {"regions": ["upper_eyelid"]}),
        ("risorius", {"origin": Anchor(at="cheek", offset=[5.0, 5.0, 5.0])}),
        ("orbicularis_oris", {"centre": Anchor(at="nasion", offset=[0.0, 5.0, 0.0])}),
        ("frontalis_inner", {"half_width": 1e-6}),
    ],
)
def test_a_muscle_that_pulls_on_nothing_is_told(model, lattice, name, changes):
    """Its response would be 0, and the face's dynamics, which divide by it, no numbers at all."""
    with pytest.raises(InvalidValueError, match="pulls on some of the tissue") as caught:
        nodal_forces(model, with_row(lattice, name, **changes))
    assert caught.value.place == Place("tissue.yaml", ("muscles", name))


def test_degenerate_prisms_are_told_with_their_region(model, lattice, monkeypatch):
    triangle = int(np.flatnonzero(model.regions.region_of[lattice.triangles[:, 0]] == 1)[0])
    folded = dataclasses.replace(lattice, degenerate=np.array([triangle], np.int32))
    monkeypatch.setattr(soundness, "build_lattice", lambda *_: folded)
    with pytest.raises(InvalidValueError, match=r"no prism is degenerate.*lattice.regions.middle_face") as caught:
        soundness.check_tissue(model)
    assert caught.value.place == Place("tissue.yaml", ("lattice", "thickness"))


@pytest.mark.slow
def test_layers_that_would_be_inverted_are_left_out_and_counted(model, lattice):
    """A fold that no thinning helps: one vertex of the cheek drawn up over its neighbours."""
    vertex = int(((model.vertices - model.landmarks["cheek_l"]) ** 2).sum(axis=1).argmin())
    vertices = model.vertices.copy()
    vertices[vertex, 1] += 0.03
    found = build_lattice(dataclasses.replace(model, vertices=vertices), lattice.file)
    assert not len(lattice.degenerate)
    assert len(found.degenerate)
    assert len(found.prisms.corners) + len(found.degenerate) == len(lattice.prisms.corners)
    assert (found.volumes > 0.0).all()
