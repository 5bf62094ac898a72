"""The three layers of the tissue and the springs in and between them: Figure 2 of Zhang, Prakash and Sung."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.head.model import HeadModel, load_model
from agentface.studies.figures.mesh_view import Colour
from agentface.studies.figures.overlay import FINER, in_colours
from agentface.tissue import tables
from agentface.tissue.lattice import Lattice
from agentface.tissue.layers import DERMIS, EPIDERMIS, HYPODERMIS
from agentface.view.contact_sheet import INK

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw

KINDS: dict[str, Colour] = {"layer": (40, 40, 44), "connecting": (200, 52, 44), "crossed": (44, 110, 196)}
"""The kinds of springs and their colours."""
LAYERS: dict[str, Colour] = {"epidermis": (236, 196, 168), "dermis": (240, 174, 160), "hypodermis": (246, 218, 140)}
_SIZE, _LEFT, _TEXT_AT = (1160, 640), 380, 690
_RINGS, _APART = 1, 1.0
"""Rings of neighbours round the middle of the patch; how far its layers are drawn apart, in widths of the patch."""
_TURN, _PITCH = np.radians(16.0), np.radians(24.0)


def figures(face: str | Path) -> dict[str, bytes]:
    """``tissue-springs.png``: a patch of the cheek, its layers drawn apart, its springs by kind, and a count of all."""
    from PIL import Image, ImageDraw

    model = load_model(face, asymmetry=0.0)
    lattice = tables.of(model).lattice
    image = Image.new("RGB", (FINER * _SIZE[0], FINER * _SIZE[1]), (255, 255, 255))
    pen = ImageDraw.Draw(image, "RGBA")
    _draw_patch(pen, lattice, patch(model, lattice))
    _write(pen, lattice)
    return {"tissue-springs.png": in_colours(image.resize(_SIZE, Image.Resampling.BOX))}


def patch(model: HeadModel, lattice: Lattice) -> Indices:
    """The vertices of a small piece of the cheek: the one in its middle, then two rings of neighbours."""
    away = np.linalg.norm(model.vertices - model.landmarks["cheek_l"], axis=1)
    chosen = np.array([away.argmin()])
    for _ in range(_RINGS):
        beside = lattice.edges[np.isin(lattice.edges, chosen).any(axis=1)].ravel()
        chosen = np.concatenate([chosen, np.setdiff1d(beside, chosen)])
    return chosen.astype(np.int32)


def spring_counts(lattice: Lattice) -> dict[str, int]:
    """How many springs of each kind the whole lattice has: 3 E in the layers, 2 V and 4 E between them."""
    edges, vertices = len(lattice.edges), lattice.rest.shape[1]
    return {"layer": 3 * edges, "connecting": 2 * vertices, "crossed": 4 * edges}


def _draw_patch(pen: ImageDraw, lattice: Lattice, chosen: Indices) -> None:
    """Layers from the lowest up, each followed by the springs that stand on it."""
    pixels, local = _pixels(lattice, chosen), {vertex: i for i, vertex in enumerate(chosen.tolist())}
    inside = np.isin(lattice.triangles, chosen).all(axis=1)
    triangles = np.vectorize(local.get)(lattice.triangles[inside])
    edges = np.vectorize(local.get)(lattice.edges[np.isin(lattice.edges, chosen).all(axis=1)])
    for layer in (HYPODERMIS, DERMIS, EPIDERMIS):
        if layer < HYPODERMIS:
            above, below = pixels[layer], pixels[layer + 1]
            for one, other in np.concatenate([edges, edges[:, ::-1]]):
                _line(pen, above[one], below[other], (*KINDS["crossed"], 190), 1.4)
            for one, other in zip(above, below, strict=True):
                _line(pen, one, other, (*KINDS["connecting"], 255), 3.0)
        colour = LAYERS[list(LAYERS)[layer]]
        for triangle in triangles:
            pen.polygon([(float(x), float(y)) for x, y in pixels[layer][triangle]], fill=(*colour, 185))
        for one, other in edges:
            _line(pen, pixels[layer][one], pixels[layer][other], (*KINDS["layer"], 255), 2.2)
        for x, y in pixels[layer]:
            pen.ellipse([x - 9, y - 9, x + 9, y + 9], fill=(255, 255, 255), outline=KINDS["layer"], width=3)


def _pixels(lattice: Lattice, chosen: Indices) -> Doubles:
    """``(3, N, 2)``: the nodes of the patch, its middle's normal upwards, layers apart."""
    middle, up = lattice.rest[EPIDERMIS, chosen[0]], lattice.normals[chosen[0]]
    across = np.cross([0.0, 1.0, 0.0], up)
    across /= np.linalg.norm(across)
    local = (lattice.rest[:, chosen] - middle) @ np.stack([across, np.cross(up, across), up], axis=1)
    wide = np.ptp(local[EPIDERMIS, :, 0])
    # as thick as they are, layers could not be told apart: their undulation is kept, their distance is not
    for layer in range(3):
        local[layer, :, 2] += -layer * _APART * 0.5 * wide - local[layer, :, 2].mean()
    turn, pitch = _TURN, _PITCH
    x = np.cos(turn) * local[..., 0] - np.sin(turn) * local[..., 1]
    back = np.sin(turn) * local[..., 0] + np.cos(turn) * local[..., 1]
    y = np.sin(pitch) * back + np.cos(pitch) * local[..., 2]
    places = np.stack([x, -y], axis=-1)
    low, high = places.reshape(-1, 2).min(axis=0), places.reshape(-1, 2).max(axis=0)
    scale = min(570.0 / (high - low)[0], (_SIZE[1] - 60.0) / (high - low)[1])
    centre = np.array([_LEFT - 20.0, _SIZE[1] / 2])
    return np.asarray(FINER * (scale * (places - 0.5 * (low + high)) + centre))


def _write(pen: ImageDraw, lattice: Lattice) -> None:
    """Names of layers and springs in their colours, and the count."""
    from PIL import ImageFont

    def text(row: float, words: str, size: int = 18, indent: float = 0.0) -> None:
        font = ImageFont.load_default(FINER * size)
        pen.text((FINER * (_TEXT_AT + indent), FINER * row), words, fill=INK, font=font, anchor="lm")

    row = 50.0
    for name, colour in LAYERS.items():
        pen.rectangle(
            [FINER * v for v in (_TEXT_AT, row - 9, _TEXT_AT + 34, row + 9)], fill=colour, outline=INK, width=2
        )
        text(row, name, indent=48)
        row += 30
    edges, vertices = len(lattice.edges), lattice.rest.shape[1]
    counts, row = spring_counts(lattice), row + 24
    lines = {
        "layer": ("between neighbours of a layer", f"3 E = 3 x {edges}"),
        "connecting": ("to the node right below", f"2 V = 2 x {vertices}"),
        "crossed": ("to the neighbours of that one", f"4 E = 4 x {edges}"),
    }
    for name, (what, sum_) in lines.items():
        _line(
            pen,
            np.array([FINER * _TEXT_AT, FINER * row]),
            np.array([FINER * (_TEXT_AT + 34), FINER * row]),
            (*KINDS[name], 255),
            3.0,
        )
        text(row, f"{name} springs", indent=48)
        text(row + 24, what, 15, 48)
        text(row + 46, f"{sum_} = {counts[name]:,}".replace(",", " "), 15, 48)
        row += 88
    text(row, f"all: 3 E + 2 V + 4 E = {sum(counts.values()):,}".replace(",", " "))
    text(row + 28, f"{len(lattice.springs.ends):,} of them have an end that moves".replace(",", " "), 15)
    text(row + 56, "The layers are drawn apart. On the face they are", 15)
    thick = lattice.thickness[lattice.free]
    text(row + 76, f"{thick.min():.1f} to {thick.max():.1f} mm from the first to the third", 15)


def _line(pen: ImageDraw, start: Doubles, end: Doubles, colour: tuple[int, ...], width: float) -> None:
    pen.line([(float(x), float(y)) for x, y in (start, end)], fill=colour, width=round(FINER * width))
