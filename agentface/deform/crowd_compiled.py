"""Whole frames of many faces without a return to Python; one face's frame is :mod:`agentface.deform.pipeline`'s."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from numba import njit

from agentface.conventions import Doubles, Floats
from agentface.deform import midpoints_compiled as between
from agentface.deform.eyes import eyeballs_compiled as eyes
from agentface.deform.eyes import eyelids_compiled as eyelids
from agentface.deform.finish import head_turn_compiled as head
from agentface.deform.finish import wrinkle_normals_compiled as shading
from agentface.deform.finish import wrinkles_compiled as wrinkles
from agentface.deform.mouth import contact_compiled as contact
from agentface.deform.mouth import jaw_compiled as jaw
from agentface.deform.mouth import lips_compiled as lips
from agentface.deform.muscles import combine_compiled as contraction
from agentface.deform.muscles import limits_compiled as limits
from agentface.deform.muscles import squash_compiled as squash
from agentface.deform.muscles import volumes_compiled as volumes
from agentface.deform.muscles.blocks import Blocks
from agentface.deform.muscles.combine import STEP
from agentface.deform.tables import PartTables
from agentface.mesh import normals_compiled as normals
from agentface.parameters import VECTOR_MUSCLES, indices_of

_PACKAGE = Path(__file__).parents[1]
_FIRST_MUSCLE = indices_of(VECTOR_MUSCLES[0])[0]


class Scratch(NamedTuple):
    """What one worker overwrites for each face: M contractions, their parts in S steps, P moved points in metres."""

    levels: Doubles
    """``(M,)``."""
    parts: Floats
    """``(S, M)``."""
    points: Floats
    """``(P, 3)``."""


class Faces(NamedTuple):
    """Where the frames of B faces go; fields as in :class:`agentface.deform.geometry.FaceGeometry`, a row a face."""

    vertices: Floats
    normals: Floats
    smooth_normals: Floats
    wrinkles: Floats
    wrinkle_levels: Floats
    eye_rotations: Floats
    jaw: Floats
    head: Floats


@njit(nogil=True, error_model="numpy")
def _contract(rest: Floats, blocks: Blocks, values: Floats, scratch: Scratch) -> None:
    """The vector muscles, which move every point from where it rests."""
    scratch.levels[:] = values[_FIRST_MUSCLE : _FIRST_MUSCLE + scratch.levels.shape[0]]
    contraction.slice_steps(scratch.levels, STEP, scratch.parts)
    contraction.contract(
        rest, blocks.home, blocks.vertex, blocks.first, blocks.owner, blocks.slack, blocks.strongest,
        blocks.pull, blocks.fibre, scratch.parts, scratch.points,
    )  # fmt: skip


@njit(nogil=True, error_model="numpy")
def _shade(tables: PartTables, values: Floats, points: Floats, faces: Faces, face: int) -> None:
    """The face's vertices with their wrinkles, and the normals before and after these rise."""
    vertices, smooth, heights = faces.vertices[face], faces.smooth_normals[face], faces.wrinkles[face]
    moved, shown = points.ravel(), vertices.ravel()
    for index in range(shown.shape[0]):
        shown[index] = moved[index]
    normals.vertex_normals(vertices, tables.triangles, smooth)
    wrinkles.levels(tables.wrinkles, values, faces.wrinkle_levels[face])
    wrinkles.heights(tables.wrinkles, values, heights)
    wrinkles.raise_vertices(tables.wrinkles, heights, smooth, vertices)
    shading.apply(tables.shading, heights, vertices, smooth, faces.normals[face])


def _sources() -> str:
    """Changes with every file that a frame is compiled from."""
    files = (path.stat() for folder in ("deform", "mesh") for path in sorted((_PACKAGE / folder).rglob("*.py")))
    return " ".join(f"{file.st_mtime_ns:x}.{file.st_size:x}" for file in files)


def _compile(sources: str) -> Callable[..., None]:
    """The kernel; numba's cache looks at what a function encloses, but at no file besides the function's own."""

    @njit(cache=True, nogil=True, error_model="numpy")
    def deform(
        tables: PartTables, blocks: Blocks, poses: Floats, first: int, last: int, scratch: Scratch, faces: Faces
    ) -> None:
        _ = sources
        points = scratch.points
        for face in range(first, last):
            values = poses[face]
            _contract(tables.rest, blocks, values, scratch)
            volumes.apply(tables.volumes, values, points)
            limits.apply(tables.limits, points)
            lips.contract(tables.lips, values, points)
            eyelids.apply(tables.eyelids, values, points)
            jaw.apply(tables.jaw, values, points)
            lips.surface(tables.lips, points)
            contact.apply(tables.contact, values, points)
            squash.apply(tables.creases, points)
            between.apply(tables.between, points)
            _shade(tables, values, points, faces, face)
            eyes.apply(tables.eyes, values, faces.eye_rotations[face])
            jaw.transform(tables.jaw, values, faces.jaw[face])
            head.apply(tables.head, values, faces.head[face])

    compiled: Callable[..., None] = deform
    return compiled


deform = _compile(_sources())
"""``deform(tables, blocks, poses, first, last, scratch, faces)`` writes the faces of ``poses[first:last]``.

``poses`` is float32 ``(B, COUNT)``, contractions in 0..1; the GIL is free meanwhile.
"""
