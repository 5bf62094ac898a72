"""Hair of the head: where it begins, a surface that covers the scalp, and fine hairs along its edge."""

from __future__ import annotations

import numpy as np

from agentface.anatomy.model import HeadModel
from agentface.conventions import Doubles, Floats
from agentface.view.anchored import Anchored
from agentface.view.look import HairLook
from agentface.view.refine import refine, vertex_normals
from agentface.view.ribbons import Hairs, Roots, unit_rows

# The hairline over the azimuth about the head's vertical axis: 0 the forehead, 180 the nape; heights over the eyes
# in distances between the pupils.
_AZIMUTH_DEG = (0, 12, 24, 32, 38, 43, 47, 51, 55, 59, 63, 67, 84, 90, 97, 105, 118, 150, 180)
_HEIGHT = (
    1.0,
    1.0,
    0.985,
    0.94,
    0.83,
    0.64,
    0.40,
    0.10,
    -0.22,
    -0.38,
    -0.10,
    0.12,
    0.12,
    -0.12,
    -0.50,
    -0.85,
    -1.05,
    -1.18,
    -1.22,
)
_AXIS_Z = -0.69
_BAND = 0.010
_EDGE_HAIRS = {"tied": 1700, "cropped": 0, "none": 0}


class Hairline:
    """How far points lie behind the hairline of a face."""

    def __init__(self, model: HeadModel, height: float) -> None:
        self.unit = model.landmarks.eye_separation
        self.top = height * float(model.landmarks["hairline_middle"][1])
        turns = np.arange(181.0)
        table = np.interp(turns, _AZIMUTH_DEG, _HEIGHT)
        padded = np.concatenate([table[4:0:-1], table, table[-2:-6:-1]])
        self._turns, self._heights = turns, np.convolve(padded, np.hanning(11)[1:-1] / np.hanning(11).sum(), "valid")

    def behind(self, points: Floats | Doubles) -> Doubles:
        """``(N,)`` metres above the hairline at each point ``(N, 3)`` of the head; negative on the face."""
        turn = np.degrees(np.arctan2(np.abs(points[:, 0]), points[:, 2] - _AXIS_Z * self.unit))
        height = np.interp(turn, self._turns, self._heights)
        # the forehead's part is fixed by the landmark, the rest by the size of the face
        return np.asarray(points[:, 1] - np.where(height > 0, height * self.top, height * self.unit))

    def over(self, model: HeadModel) -> Doubles:
        """``(V,)`` metres behind the hairline for the vertices of the skin; ears stay free."""
        _, y, z = model.vertices.T / self.unit
        ear = model.material[:, 3] * np.clip((0.23 - y) / 0.19, 0, 1) * np.clip((z + 0.72) / 0.12, 0, 1)
        return np.asarray(self.behind(model.vertices) - 0.06 * ear)


def knot_of(model: HeadModel) -> Doubles:
    """Where tied hair runs to: behind the back of the head."""
    return np.array([0.0, 0.30 * model.landmarks.eye_separation, float(model.vertices[:, 2].min()) - 0.022])


def scalp_cap(model: HeadModel, line: Hairline, look: HairLook) -> Anchored:
    """The hair as one surface: the scalp twice refined and lifted, thin at the hairline.

    Material: strand, place along it, depth behind the hairline 0..1, ambient light.
    """
    behind, behind_plain = line.over(model), line.behind(model.vertices)
    chosen = (behind[model.triangles].max(1) > -0.006) & (model.vertices[model.triangles, 1].min(1) > -0.095)
    used, local = np.unique(model.triangles[chosen], return_inverse=True)
    triangles = local.reshape(-1, 3).astype(np.int32)
    all_normals = vertex_normals(model.vertices, model.triangles)
    places, normals = model.vertices[used], all_normals[used]
    light = np.column_stack([model.shade[used, 0], line.over(model)[used] - behind_plain[used]]).astype(np.float32)
    anchors = used.astype(np.int32)[:, None]
    for _ in range(2):
        mesh = refine(triangles, len(places))
        places = mesh.positions(places, normals)
        normals = unit_rows(mesh.mean(normals)).astype(np.float32)
        light, triangles = mesh.mean(light), mesh.triangles
        anchors = np.concatenate([anchors[mesh.ends[:, 0]], anchors[mesh.ends[:, 1]]], axis=1)
    depth = line.behind(places) + light[:, 1]
    lifted = places + normals * _thickness(places, depth, look.style)[:, None].astype(np.float32)
    away = lifted - knot_of(model)
    strand = np.arctan2(away[:, 0], away[:, 1] + 0.03)
    along = np.linalg.norm(away, axis=1) * 10
    material = np.column_stack(
        [strand, along, np.clip((depth + 0.002) / 0.030, 0, 1), np.clip(1.3 * light[:, 0], 0, 1)]
    )
    return Anchored(lifted, vertex_normals(lifted, triangles), triangles, anchors, material.astype(np.float32))


def _thickness(places: Floats, depth: Doubles, style: str) -> Doubles:
    """How far the hair stands off the scalp, metres."""
    if style == "cropped":
        return np.asarray(0.0004 + 0.0042 * np.clip(depth / 0.030, 0, 1) ** 0.8)
    back = np.clip((0.03 - places[:, 2]) / 0.12, 0, 1)
    return np.asarray(0.0008 + 0.0100 * np.clip(depth / 0.045, 0, 1) ** 0.7 * (0.65 + 0.45 * back))


def edge_hairs(model: HeadModel, normals: Floats, line: Hairline, look: HairLook, rng: np.random.Generator) -> Hairs:
    """Fine hairs along the hairline, that soften the edge of the surface."""
    count = _EDGE_HAIRS[look.style]
    # over the forehead and down the temples; the surface alone ends softly enough elsewhere
    near = (
        (np.abs(line.over(model)) < 2.5 * _BAND) & (model.vertices[:, 2] > 0) & (model.vertices[:, 1] > 0.3 * line.unit)
    )
    chosen = model.triangles[near[model.triangles].all(1)]
    a, b, c = (model.vertices[chosen[:, corner]] for corner in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    drawn = rng.choice(len(chosen), 8 * count, p=area / area.sum())
    u, v = np.sqrt(rng.random(8 * count)), rng.random(8 * count)
    weights = np.stack([1 - u, u * (1 - v), u * v], axis=1)
    places = (model.vertices[chosen[drawn]] * weights[..., None]).sum(1)
    depth = line.behind(places)
    kept = np.flatnonzero((depth > -0.15 * _BAND - 0.25 * _BAND * rng.random(8 * count) ** 2) & (depth < 0.8 * _BAND))[
        :count
    ]
    roots = Roots(chosen[drawn[kept]], weights[kept].astype(np.float32))
    places, n = places[kept], roots.frames(model.vertices, normals)[1][:, :, 2]
    bends, tips = _combed(model, places, n, look.style, rng)
    shade = np.asarray(look.colour) * (0.5 + 0.9 * rng.random((len(kept), 1)))
    paint = np.column_stack([shade, np.full(len(kept), 0.75)])
    radii = 0.00013 + 0.00010 * rng.random(len(kept))
    return Hairs.grown(roots, (model.vertices, normals), bends, tips, radii, paint)


def _combed(
    model: HeadModel, places: Doubles, n: Doubles, style: str, rng: np.random.Generator
) -> tuple[Doubles, Doubles]:
    """Control points of hairs at ``places`` with the skin's normals ``n``."""
    count = len(places)
    flow = knot_of(model) - places
    flow = unit_rows(flow - n * (flow * n).sum(1, keepdims=True))
    if style == "cropped":
        across = unit_rows(rng.normal(size=(count, 3)))
        length = 0.0035 + 0.002 * rng.random((count, 1))
        return 0.5 * length * (n + 0.3 * across), length * (0.55 * n + 0.25 * flow + 0.6 * across)
    across = np.cross(n, flow) * rng.normal(0, 0.20, (count, 1))
    length = 0.018 + 0.020 * rng.random((count, 1))
    lift = 0.16 + 0.14 * rng.random((count, 1))
    return length * (0.5 * flow + lift * n), length * (flow + across + 0.8 * lift * n)
