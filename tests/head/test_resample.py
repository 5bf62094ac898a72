"""The same face at other densities: what must not change with the number of vertices."""

from functools import cache

import numpy as np
import pytest

from agentface.conventions import SIDES
from agentface.deform.muscles.combine import Combiner, parallel
from agentface.deform.pipeline import GeometricDeformer
from agentface.head.regions import REGIONS, SUB_REGIONS
from agentface.head.resample import subdivided, thinned
from agentface.parameters import VECTOR_MUSCLES, FacePose
from tests.heads import head_model

FACES = {face: head_model(face) for face in ("amber", "onyx")}


POSES = (
    FacePose.of(zygomaticus_major=0.8, frontalis_medialis=0.5, procerus=0.6, jaw_open=0.7, orbicularis_oris_pucker=0.6),
    FacePose.of(orbicularis_oculi_palpebralis=0.8, levator_palpebrae=0.3, orbicularis_oculi_orbitalis_l=0.5),
)


@cache
def resampled(face, way):
    return subdivided(FACES[face]) if way == "finer" else thinned(FACES[face], 2500)


@pytest.fixture(params=[("amber", "finer"), ("onyx", "finer"), ("amber", "coarser")], ids="-".join)
def both(request):
    """The face and what was made of it."""
    return FACES[request.param[0]], resampled(*request.param)


def kept(model, made):
    """For each vertex of ``made`` that is one of ``model``: which one, and where it is now."""
    now = np.flatnonzero(made.parents[:, 0] == made.parents[:, 1])
    return made.parents[now, 0], now


def ring_vertices(model):
    rings = [*model.lips.rings, *(ring for side in SIDES for ring in model.eyelids.rings[side])]
    return [vertex for ring in rings for vertex in (*ring.upper, *ring.lower)]


@pytest.mark.slow
def test_there_are_as_many_vertices_as_asked_for():
    for face, model in FACES.items():
        edges = {tuple(sorted(pair)) for a, b, c in model.triangles.tolist() for pair in ((a, b), (b, c), (c, a))}
        assert len(resampled(face, "finer").vertices) == len(model.vertices) + len(edges)
    assert abs(len(resampled("amber", "coarser").vertices) - 2500) <= 1


def test_every_vertex_is_used_and_no_triangle_has_lost_its_area(both):
    _, made = both
    np.testing.assert_array_equal(np.unique(made.triangles), np.arange(len(made.vertices)))
    corners = made.vertices[made.triangles].astype(np.float64)
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.linalg.norm(across, axis=1).min() > 1e-8


def test_vertices_lie_on_the_old_surface():
    for face, model in FACES.items():
        finer = resampled(face, "finer")
        old = model.vertices[model.triangles].astype(np.float64)
        new = finer.vertices[finer.triangles].astype(np.float64)
        area = [np.linalg.norm(np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]), axis=1).sum() for t in (old, new)]
        assert area[1] == pytest.approx(area[0], rel=1e-6)
    known = {tuple(point) for point in FACES["amber"].vertices.tolist()}
    assert all(tuple(point) in known for point in resampled("amber", "coarser").vertices.tolist())


def test_triangles_still_face_outward(both):
    model, made = both

    def normals(mesh):
        corners = mesh.vertices[mesh.triangles].astype(np.float64)
        return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])

    volume = [(mesh.vertices[mesh.triangles].mean(axis=1) * normals(mesh)).sum() / 6 for mesh in (model, made)]
    assert volume[1] == pytest.approx(volume[0], rel=0.02)


def test_the_mirror_image_is_an_involution_that_keeps_places_triangles_and_regions(both):
    _, made = both
    mirror = made.mirror
    np.testing.assert_array_equal(mirror[mirror], np.arange(len(mirror)))
    np.testing.assert_allclose(made.vertices[mirror] * [-1, 1, 1], made.vertices, atol=1e-7)
    np.testing.assert_array_equal(made.jaw_weights[mirror], made.jaw_weights)
    triangles = {tuple(sorted(triangle)) for triangle in made.triangles.tolist()}
    assert {tuple(sorted(triangle)) for triangle in mirror[made.triangles].tolist()} == triangles
    names = [REGIONS[index] for index in made.regions.region_of]
    for vertex, image in enumerate(mirror):
        if vertex != image:
            swapped = names[vertex][:-2] + {"_l": "_r", "_r": "_l"}.get(names[vertex][-2:], names[vertex][-2:])
            assert names[image] == swapped


def test_regions_cover_every_vertex_and_hold_their_sub_regions(both):
    model, made = both
    owner = np.full(len(made.vertices), -1)
    for index, name in enumerate(REGIONS):
        members = owner[made.regions.members(name)]
        assert len(members)
        assert (members == -1).all()
        owner[made.regions.members(name)] = index
    np.testing.assert_array_equal(owner, made.regions.region_of)
    for sub, region in SUB_REGIONS.items():
        for side in SIDES:
            inside = made.regions.region_of[made.regions.members(f"{sub}_{side}")]
            assert len(inside)
            assert (inside == REGIONS.index(f"{region}_{side}")).all()
    before, now = kept(model, made)
    np.testing.assert_array_equal(made.regions.region_of[now], model.regions.region_of[before])


def test_rings_go_through_the_same_points(both):
    model, made = both
    np.testing.assert_array_equal(made.vertices[ring_vertices(made)], model.vertices[ring_vertices(model)])
    np.testing.assert_array_equal(made.material[ring_vertices(made)], model.material[ring_vertices(model)])


def test_shapes_are_the_same_at_the_old_vertices(both):
    model, made = both
    before, now = kept(model, made)
    for name, shape in model.shapes.items():
        dense = made.shapes[name].dense(len(made.vertices))
        np.testing.assert_allclose(dense[now], shape.dense(len(model.vertices))[before], atol=5e-6)


def test_the_muscles_move_the_old_vertices_as_before(both):
    model, made = both
    before, now = kept(model, made)
    assert made.muscles.names == VECTOR_MUSCLES
    for levels in np.random.default_rng(0).random((3, len(VECTOR_MUSCLES))):
        moved = parallel(made.vertices, made.muscles, levels)[now]
        np.testing.assert_allclose(moved, parallel(model.vertices, model.muscles, levels)[before], atol=1e-12)


def test_the_compiled_muscles_agree_at_every_density(both):
    _, made = both
    levels = np.random.default_rng(1).random(len(VECTOR_MUSCLES))
    out = np.empty_like(made.vertices)
    Combiner(made.vertices, made.muscles).apply(levels, out)
    np.testing.assert_allclose(out, parallel(made.vertices, made.muscles, levels), atol=1e-6)


def test_what_lies_between_rings_stays_in_the_middle():
    model = resampled("amber", "finer")
    finest = subdivided(model)
    for made in (model, finest):
        done = set(made.ringed.tolist())
        for vertex, one, other in made.between.tolist():
            assert {one, other} <= done
            assert vertex not in done
            done.add(vertex)
        middle = 0.5 * (made.vertices[made.between[:, 1]] + made.vertices[made.between[:, 2]])
        np.testing.assert_allclose(made.vertices[made.between[:, 0]], middle, atol=1e-8)
    # a patch of the mesh has four times the vertices and, at its border, a few less
    assert 3.5 < (len(finest.between) + len(finest.ringed)) / (len(model.between) + len(model.ringed)) < 4.0


@pytest.mark.slow
@pytest.mark.untraced
def test_the_finer_and_the_coarser_face_move_alike(both):
    model, made = both
    before, now = kept(model, made)
    for pose in POSES:
        expected = GeometricDeformer(model, compiled=False).at(pose).vertices[before]
        moved = GeometricDeformer(made, compiled=False).at(pose).vertices[now]
        # wrinkles rise along normals, which a coarse mesh has others of
        nearly = 1e-4 if len(made.vertices) > len(model.vertices) else 5e-4
        apart = np.linalg.norm(moved - expected, axis=1)
        assert np.quantile(apart, 0.97) < nearly
        assert apart.max() < 2.5e-3  # where muscles press the skin together, each mesh creases at its own scale


def test_subdividing_twice_keeps_what_subdividing_once_keeps():
    model = resampled("amber", "finer")
    finest = subdivided(model)
    assert len(finest.vertices) == 97_923
    np.testing.assert_array_equal(finest.mirror[finest.mirror], np.arange(len(finest.mirror)))
    np.testing.assert_array_equal(finest.vertices[ring_vertices(finest)], model.vertices[ring_vertices(model)])


def test_what_cannot_be_thinned_stays():
    model = resampled("amber", "coarser")
    made = thinned(model, 100)
    np.testing.assert_array_equal(made.vertices[ring_vertices(made)], model.vertices[ring_vertices(model)])
    assert 800 < len(made.vertices) < 2500
