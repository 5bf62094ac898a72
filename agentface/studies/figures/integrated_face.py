"""Skull, muscles and hypodermis, one over the other: Figure 4 of Zhang, Prakash and Sung.

The muscles are those of the anatomist's table; a face's own are fitted to what the skin does, and some of them are
longer or wider than a muscle is.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from agentface.conventions import Bytes
from agentface.head.model import HeadModel, load_model
from agentface.mesh.normals import vertex_normals
from agentface.studies.figures.bones import Bones, bones_of, draw_bones
from agentface.studies.figures.fibres import Bed, Belly, bellies
from agentface.studies.figures.mesh_view import MeshView
from agentface.studies.figures.overlay import in_colours
from agentface.studies.figures.solids import Scene
from agentface.tissue import tables
from agentface.tissue.lattice import Lattice
from agentface.tissue.layers import HYPODERMIS
from agentface.tissue.reading import anatomy_file, read_tissue
from agentface.view.contact_sheet import sheet

_SIZE = 560
_WIDTH, _BELOW = 3.9, 0.3
"""Eye separations that a picture is wide, and from the pupils down to its middle."""
_TURNED_DEG = 32.0
_NET = (24, 44, 96, 210)
_OVER_M = 0.0015


def figures(face: str | Path) -> dict[str, bytes]:
    """``tissue-skull.png``: the skull, with its 23 muscles, and with the hypodermis over one half."""
    model = load_model(face, asymmetry=0.0)
    lattice = tables.of(model).lattice
    bones, file = bones_of(model, lattice), read_tissue(anatomy_file())
    bed = Bed(bones.points, vertex_normals(bones.points, bones.triangles))
    muscles = bellies(model, lattice, file, bed)
    kinds = "linear red, sheets orange, sphincters crimson"
    panels = [
        (_picture(model, bones, {}, None, 0.0), "the skull", "fitted to the depth of the tissue; the jaw darker"),
        (
            _picture(model, bones, muscles, None, _TURNED_DEG),
            f"the {len(muscles)} muscles, as the anatomist has them",
            kinds,
        ),
        (_picture(model, bones, muscles, lattice, 0.0), "and the hypodermis", "the net, over the left half"),
    ]
    return {"tissue-skull.png": in_colours(sheet(panels, columns=len(panels)))}


def _picture(
    model: HeadModel, bones: Bones, muscles: dict[str, Belly], lattice: Lattice | None, yaw_deg: float
) -> Bytes:
    """Bones, with muscles, and with the left half of the hypodermis where there is a ``lattice``."""
    unit = float(model.landmarks.eye_separation)
    centre = np.array([0.0, model.landmarks["pupil_l"][1] - _BELOW * unit, 0.0], np.float32)
    scene = Scene(MeshView(centre, _WIDTH * unit, yaw_deg, _SIZE))
    draw_bones(scene, model, bones, eyes=bool(muscles))
    for belly in muscles.values():
        scene.surface(*belly)
    if lattice is not None:
        points = 1e-3 * lattice.rest[HYPODERMIS]
        shown = lattice.free & (points[:, 0] > -1e-4) & (points[:, 1] > model.landmarks["menton"][1])
        shown &= lattice.normals[:, 2] > 0.0
        scene.net(points, lattice.edges[shown[lattice.edges].all(axis=1)], _NET, 0.5, _OVER_M)
    return scene.picture()
