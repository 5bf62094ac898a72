"""The lattice of a face (Zhang, Prakash and Sung, section 3.1): three layers of its skin, springs, prisms, bone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.head.landmarks import both_sides
from agentface.head.model import HeadModel
from agentface.mesh.graph import Mask, SparseMatrix, adjacency, edges_of, grown, laplacian
from agentface.mesh.normals import doubled_areas
from agentface.tissue.depth import depths
from agentface.tissue.elements import Prisms
from agentface.tissue.layers import DERMIS, EPIDERMIS, HYPODERMIS, area_ratio, inward, thickness
from agentface.tissue.members import Carried, Members, carried_by, members
from agentface.tissue.reading import tissue_of
from agentface.tissue.skull import Skull, fit_skull
from agentface.tissue.tissue_file import HoldTable, SpringsTable, TissueFile

REFERENCE_MM2 = 8.0
"""The area of skin that stiffness across it and force are given for: most of a face's mesh has about that a vertex."""
PERIOSTEUM_MM = 0.4
"""Above the bone, where contact begins: it yields a little, and no node is to enter the bone."""
_AREAS = (0.15, 3.0)
"""Of the reference: what a vertex may count for, at least and at most."""
_AT_A_HOLE = 0.3, 0.7
"""How far muscles may pull on the first two rings of columns round a hole: a thin edge would flap."""
_INSIDE = 0.3
"""Of the mouth's inside, from where on a vertex is no skin that a muscle may end in."""
_LEAST_VOLUME = 0.25
"""Of area times thickness: a prism that leans more has no volume to keep."""


class Springs(NamedTuple):
    """S springs between nodes; node ``layer * V + vertex`` is what lies under a vertex in a layer.

    Attributes:
        ends: ``(S, 2)`` nodes.
        stiffness: ``(S,)`` k0, force per mm.
        length: ``(S,)`` mm at rest.
    """

    ends: Indices
    stiffness: Doubles
    length: Doubles


@dataclass(frozen=True, eq=False)
class Lattice:
    """The tissue at rest: V columns of three nodes, from epidermis to hypodermis.

    Attributes:
        file: the numbers it is made of.
        rest: ``(3, V, 3)`` mm.
        triangles, edges: of the skin.
        normals: ``(V, 3)`` of the skin.
        free: ``(V,)`` the columns that move.
        pulled: ``(V,)`` 0..1, how far muscles may pull on each: less beside what is not in the lattice; all the way on
            skin that is carried, which hands it on.
        members: the others.
        carried: the skin that follows them.
        springs: all of them; those between nodes that stay, or that are not in the lattice, are left out.
        spring_count: with those: 3 E + 2 V + 4 E.
        tether: ``(V, 2)`` stiffness of the hypodermis' springs to the bone, along and across the skin.
        gap: ``(V,)`` mm from the hypodermis down to where contact with the bone begins.
        area: ``(V,)`` of a vertex, in ``REFERENCE_MM2``, within bounds; what forces are scaled with.
        prisms: the elements, epidermis to hypodermis.
        volumes: ``(P,)`` mm3 of these at rest.
        degenerate: triangles of moving skin that have no prism, because theirs would be inverted or lean over.
        depth, thickness: ``(V,)`` mm, of the soft tissue and of the lattice.
        skull: the bone under it.
    """

    file: TissueFile
    rest: Doubles
    triangles: Indices
    edges: Indices
    normals: Doubles
    free: Mask
    pulled: Doubles
    members: Members
    carried: Carried
    springs: Springs
    spring_count: int
    tether: Doubles
    gap: Doubles
    area: Doubles
    prisms: Prisms
    volumes: Doubles
    degenerate: Indices
    depth: Doubles
    thickness: Doubles
    skull: Skull

    @property
    def points(self) -> Doubles:
        """``(3 V, 3)`` mm: the nodes at rest."""
        return self.rest.reshape(-1, 3)


def build_lattice(model: HeadModel, file: TissueFile | None = None) -> Lattice:
    """The lattice of a face, by its ``tissue.yaml`` or by ``file``; raises DataError where there is neither."""
    file = tissue_of(model.folder) if file is None else file
    points, triangles = 1e3 * model.vertices.astype(np.float64), model.triangles
    edges, count = edges_of(triangles), len(points)
    beside, matrix = adjacency(edges, count), laplacian(edges, count)
    normals = model.normals.astype(np.float64)
    ways, where = inward(normals, beside), members(model, edges, file.lattice.carried_mm)
    depth = depths(model, matrix, file.depth_mm)
    thick = thickness(model, file.lattice, depth, ways, beside, where)
    rest = np.stack([points + (part * thick)[:, None] * ways for part in (0.0, file.lattice.dermis, 1.0)])
    skull = fit_skull(model, points + np.maximum(depth, thick + 0.5)[:, None] * ways, beside, file.skull)
    face_area = np.linalg.norm(doubled_areas(points, triangles), axis=1) / 2.0
    area = np.bincount(triangles.ravel(), np.repeat(face_area / 3.0, 3), count) / REFERENCE_MM2
    edge_area = _edge_area(edges, triangles, face_area)
    springs, spring_count = _springs(rest, edges, area, edge_area, file.springs, where)
    prisms, volumes, degenerate = _prisms(rest, triangles, face_area, thick, where)
    return Lattice(
        file=file,
        rest=rest,
        triangles=triangles,
        edges=edges,
        normals=normals,
        free=~(where.fixed | where.absent),
        pulled=_pulled(model, where, beside),
        members=where,
        carried=carried_by(model, edges, where),
        springs=springs,
        spring_count=spring_count,
        tether=_tether(model, file, depth, area, beside),
        gap=np.maximum(-((skull.points - rest[HYPODERMIS]) * normals).sum(axis=1) - PERIOSTEUM_MM, 0.0),
        area=np.clip(area, *_AREAS),
        prisms=prisms,
        volumes=volumes,
        degenerate=degenerate,
        depth=depth,
        thickness=thick,
        skull=skull,
    )


def _springs(
    rest: Doubles, edges: Indices, area: Doubles, edge_area: Doubles, table: SpringsTable, where: Members
) -> tuple[Springs, int]:
    """Layer, connecting and crossed springs; what goes across the layers is as stiff as the skin over it is wide."""
    count = rest.shape[1]
    (low, high), every = _AREAS, np.arange(count)
    per_vertex, per_edge = np.clip(area, low, high), np.sqrt(np.clip(edge_area, low, high))
    layers = (table.layers.epidermis, table.layers.dermis, table.layers.hypodermis)
    ends = [edges + layer * count for layer in range(3)]
    stiffness = [np.full(len(edges), layer) for layer in layers]
    for upper, connecting, crossed in zip(
        range(2),
        (table.connecting.upper, table.connecting.lower),
        (table.crossed.upper, table.crossed.lower),
        strict=True,
    ):
        above, below = upper * count, (upper + 1) * count
        ends += [np.stack([every + above, every + below], axis=1), edges + np.array([above, below])]
        ends.append(edges + np.array([below, above]))
        stiffness += [connecting * per_vertex, crossed * per_edge, crossed * per_edge]
    both, all_stiffness = np.concatenate(ends).astype(np.int32), np.concatenate(stiffness)
    stays, absent = np.tile(where.fixed, 3)[both], np.tile(where.absent, 3)[both]
    kept = ~stays.all(axis=1) & ~absent.any(axis=1)
    points = rest.reshape(-1, 3)
    length = np.linalg.norm(points[both[:, 0]] - points[both[:, 1]], axis=1)
    return Springs(both[kept], all_stiffness[kept], length[kept]), len(both)


def _edge_area(edges: Indices, triangles: Indices, face_area: Doubles) -> Doubles:
    """``(E,)`` the area that belongs to each edge, in thirds of ``REFERENCE_MM2``."""
    count = int(triangles.max()) + 1
    ends = np.sort(np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1).astype(np.int64)
    place = np.searchsorted(edges[:, 0].astype(np.int64) * count + edges[:, 1], ends[:, 0] * count + ends[:, 1])
    return np.bincount(place, np.tile(face_area / 3.0, 3), len(edges)) / (REFERENCE_MM2 / 3.0)


def _prisms(
    rest: Doubles, triangles: Indices, face_area: Doubles, thick: Doubles, where: Members
) -> tuple[Prisms, Doubles, Indices]:
    """The prisms under moving skin, their volumes, and the triangles whose prism would be degenerate."""
    due = ~where.fixed[triangles].all(axis=1) & ~where.absent[triangles].any(axis=1)
    corners = np.concatenate([triangles, triangles + HYPODERMIS * rest.shape[1]], axis=1)
    volumes = Prisms(corners).volumes(rest.reshape(-1, 3))
    sound = volumes > _LEAST_VOLUME * thick[triangles].mean(axis=1) * face_area
    for layer in (DERMIS, HYPODERMIS):
        sound &= area_ratio(rest[EPIDERMIS], rest[layer], triangles) > 0.0
    kept = due & sound
    return Prisms(corners[kept].astype(np.int32)), volumes[kept], np.flatnonzero(due & ~sound).astype(np.int32)


def _pulled(model: HeadModel, where: Members, beside: SparseMatrix) -> Doubles:
    free = ~(where.fixed | where.absent)
    near, next_to_it = (grown(where.absent, beside, rings) for rings in (1, 2))
    field = free * np.where(near, _AT_A_HOLE[0], np.where(next_to_it, _AT_A_HOLE[1], 1.0))
    return np.asarray(np.where(where.carried & (model.material[:, 1] < _INSIDE), 1.0, field))


def _tether(model: HeadModel, file: TissueFile, depth: Doubles, area: Doubles, beside: SparseMatrix) -> Doubles:
    """Weaker along the skin under the cheek's fat and the lips; stronger at the orbit's rim and where it is held."""
    table, per_vertex = file.skull, np.clip(area, 0.1, 4.0)
    soft = np.clip(6.0 / depth, 0.3, 1.2)
    lids = model.regions.mask(["lower_eyelid", "upper_eyelid"]) | (model.material[:, 2] > 0.5)
    soft *= np.where(grown(lids, beside, 2), 2.0, 1.0)
    bone = around(model, table.holds)
    return np.stack([table.along * soft * bone * per_vertex, table.across * bone * per_vertex], axis=1)


def around(model: HeadModel, places: dict[str, HoldTable]) -> Doubles:
    """``(V,)``: how much more firmly the skin round the landmarks is held, 1 elsewhere."""
    field = np.ones(len(model.vertices))
    for name, place in places.items():
        for full in both_sides(name):
            away = 1e3 * np.linalg.norm(model.vertices - model.landmarks[full], axis=1)
            field *= place.times ** np.clip(2.0 - away / place.radius_mm, 0.0, 1.0)
    return field
