"""The order in which the adaptive scheme goes through the mesh: Figure 5 of Zhang, Prakash and Sung."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from agentface.conventions import Bytes, Doubles, Indices
from agentface.head.model import HeadModel, load_model
from agentface.mesh.graph import edges_of
from agentface.studies.figures.cheek_cut import contractions_of
from agentface.studies.figures.mesh_view import MeshView
from agentface.studies.figures.overlay import FINER, in_colours
from agentface.studies.figures.solids import Scene
from agentface.tissue import tables
from agentface.tissue.solvers.adaptive import NodeSets, prepare
from agentface.view.contact_sheet import INK, sheet

EXPRESSION = "happiness"
DYNAMIC, STATIC = np.array([204.0, 62.0, 50.0]), np.array([216.0, 214.0, 210.0])
_NEAR = np.array([[250.0, 214.0, 92.0], [92.0, 186.0, 140.0], [40.0, 78.0, 150.0]])
_SIZE = 560
_WIDTH, _BELOW, _TURNED_DEG = 3.5, 0.4, 38.0
"""Eye separations that a picture is wide, and from the pupils to its middle; how far the second is turned."""
_WIRE = (60, 56, 52, 120)
_BAR = 250


def figures(face: str | Path) -> dict[str, bytes]:
    """``tissue-order.png``: the sets of one expression on the mesh, quasi-static columns by their distance."""
    model = load_model(face, asymmetry=0.0)
    tissue = tables.of(model)
    sets = prepare(tissue, contractions_of(tissue, EXPRESSION)).sets
    colours = column_colours(sets)
    nodes = sets.nodes
    panels = [
        (_picture(model, colours, 0.0), EXPRESSION, f"the sets of its {sum(nodes.values()):,} nodes".replace(",", " ")),
        (_picture(model, colours, _TURNED_DEG), "and from the left", "the wave goes out from the dynamic nodes"),
        (_legend(sets), "columns by set", "q: springs from the nearest dynamic column"),
    ]
    return {"tissue-order.png": in_colours(sheet(panels, columns=len(panels)))}


def column_colours(sets: NodeSets) -> Doubles:
    """``(V, 3)``: of the set that each column is in; the quasi-static ones by their distance."""
    colours = np.tile(STATIC, (len(sets.distance), 1))
    colours[sets.dynamic] = DYNAMIC
    distance = sets.distance[sets.quasi_static]
    colours[sets.quasi_static] = _ramp(distance, int(distance.max(initial=1)))
    return colours


def _ramp(distance: Indices, farthest: int) -> Doubles:
    """``(N, 3)``: from the nearest, 1, to the farthest."""
    part = (np.asarray(distance, np.float64) - 1.0) / max(farthest - 1, 1)
    return np.stack([np.interp(part, (0.0, 0.4, 1.0), channel) for channel in _NEAR.T], axis=1)


def _picture(model: HeadModel, colours: Doubles, yaw_deg: float) -> Bytes:
    """The skin, of every triangle the third at each corner in the corner's colour."""
    unit = float(model.landmarks.eye_separation)
    centre = np.array([0.0, model.landmarks["pupil_l"][1] - _BELOW * unit, 0.0], np.float32)
    scene = Scene(MeshView(centre, _WIDTH * unit, yaw_deg, _SIZE))
    outside = (model.material[:, 1] < 0.5)[model.triangles].all(axis=1)
    points, normals = model.vertices.astype(np.float64), model.normals.astype(np.float64)
    thirds, owners = _thirds(points, model.triangles[outside])
    quads = (np.arange(0, len(thirds), 4)[:, None] + np.array([0, 1, 2, 0, 2, 3])).reshape(-1, 3).astype(np.int32)
    scene.surface(thirds, quads, np.repeat(colours[owners], 4, axis=0), normals=np.repeat(normals[owners], 4, axis=0))
    for side in ("l", "r"):
        eye = model.parts[f"eye_{side}"]
        scene.surface(eye.attributes["POSITION"].astype(np.float64), eye.triangles, np.full(3, 244.0))
    scene.net(points, edges_of(model.triangles[outside]), _WIRE, 0.5, 0.0006)
    return scene.picture()


def _thirds(points: Doubles, triangles: Indices) -> tuple[Doubles, Indices]:
    """``(12 T, 3)``: four corners of each triangle's three parts, and ``(3 T,)`` the vertices that these belong to."""
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    middle = (a + b + c) / 3.0
    parts = [
        np.stack([one, 0.5 * (one + after), middle, 0.5 * (one + last)], axis=1)
        for one, after, last in ((a, b, c), (b, c, a), (c, a, b))
    ]
    return np.concatenate(parts).reshape(-1, 3), triangles.T.ravel()


def _legend(sets: NodeSets) -> Bytes:
    """Each set's colour and how many columns it has."""
    from PIL import Image, ImageDraw, ImageFont

    image = Image.new("RGB", (FINER * _SIZE, FINER * _SIZE), (255, 255, 255))
    pen, font = ImageDraw.Draw(image), ImageFont.load_default(FINER * 16)
    distance = sets.distance[sets.quasi_static]
    farthest = int(distance.max(initial=1))
    rows = [("dynamic", DYNAMIC, len(sets.dynamic))]
    rows += [
        (f"q = {q}", _ramp(np.array([q]), farthest)[0], int((distance == q).sum())) for q in range(1, farthest + 1)
    ]
    rows += [("static", STATIC, sets.static)]
    step = min(30.0, (_SIZE - 40.0) / len(rows))
    most = max(count for *_, count in rows)
    for place, (name, colour, count) in enumerate(rows):
        row, left = FINER * (30 + step * place), FINER * 116
        long = FINER * _BAR * count / most
        pen.text((left - FINER * 12, row), name, fill=INK, font=font, anchor="rm")
        pen.rectangle(
            [left, row - FINER * 0.38 * step, left + long, row + FINER * 0.38 * step],
            fill=tuple(colour.astype(int).tolist()),
        )
        pen.text((left + long + FINER * 8, row), str(count), fill=INK, font=font, anchor="lm")
    return np.asarray(image.resize((_SIZE, _SIZE), Image.Resampling.BOX))
