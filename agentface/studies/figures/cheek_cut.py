"""A level cut through one cheek, at rest and in happiness: the layers, the bone, the gap, and the volume kept."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.emotion.inference import default_inference
from agentface.head.model import HeadModel, load_model
from agentface.studies.figures.mesh_view import Colour
from agentface.studies.figures.overlay import FINER, in_colours
from agentface.tissue import tables
from agentface.tissue.columns import unpacked
from agentface.tissue.lattice import Lattice
from agentface.tissue.layers import DERMIS, EPIDERMIS, HYPODERMIS
from agentface.tissue.solvers.equilibrium import equilibrium
from agentface.tissue.tables import TissueTables
from agentface.view.contact_sheet import INK, sheet

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw

EXPRESSION = "happiness"
_SIZE = 640
_COLOURS: dict[str, Colour] = {
    "epidermis to dermis": (238, 186, 158),
    "dermis to hypodermis": (246, 214, 136),
    "gap": (244, 240, 234),
    "bone": (206, 196, 176),
}
BONE = 3
"""After the three layers."""
_BETWEEN = {
    "gap": (HYPODERMIS, BONE),
    "dermis to hypodermis": (DERMIS, HYPODERMIS),
    "epidermis to dermis": (EPIDERMIS, DERMIS),
}
_LINES: dict[int, Colour] = {
    BONE: (84, 74, 58),
    HYPODERMIS: (168, 116, 18),
    DERMIS: (196, 96, 84),
    EPIDERMIS: (150, 66, 44),
}
_BEFORE: Colour = (52, 88, 176)
_ROUND = ((0, 1), (1, 2), (2, 0))
_INWARD_MM, _INSIDE = 7.0, 0.02
"""How far into the bone it is filled; from where on skin is inside the mouth."""


class Cut(NamedTuple):
    """What a level cut through three layers and bone shows.

    Attributes:
        surfaces: ``(4, V, 3)`` mm: epidermis, dermis, hypodermis, bone.
        height: mm, of the cut.
    """

    surfaces: Doubles
    height: float


def figures(face: str | Path) -> dict[str, bytes]:
    """``tissue-cheek.png``: the left cheek cut level with its landmark, seen from above."""
    model = load_model(face, asymmetry=0.0)
    tissue = tables.of(model)
    height = 1e3 * float(model.landmarks["cheek_l"][1])
    rest, smile = (cut(tissue, contractions, height) for contractions in (None, contractions_of(tissue, EXPRESSION)))
    frame = _frame(model, tissue.lattice)
    below = 1e3 * float(model.landmarks["pupil_l"][1]) - height
    kept = 100.0 * volume_ratio(tissue.lattice, rest, smile)
    panels = [
        (
            _picture(frame, rest),
            "at rest",
            f"{below:.0f} mm below the pupils, seen from above: nose to the left, ear to the right",
        ),
        (
            _picture(frame, smile, rest),
            EXPRESSION,
            f"the cut prisms keep {kept:.1f} % of their volume; dots: the skin at rest",
        ),
    ]
    return {"tissue-cheek.png": in_colours(sheet(panels, columns=2))}


def contractions_of(tissue: TissueTables, expression: str) -> Doubles:
    """``(23,)``: what an emotion at full intensity contracts."""
    pose = default_inference().pose({expression: 1.0})
    return tissue.drive.contractions(pose.array.astype(np.float64))


def cut(tissue: TissueTables, contractions: Doubles | None, height: float) -> Cut:
    """The layers in equilibrium with ``contractions (23,)``, at rest with None, and the bone."""
    lattice = tissue.lattice
    moved = np.zeros_like(lattice.rest)
    if contractions is not None:
        moved = unpacked(tissue.columns, equilibrium(tissue, contractions)) - lattice.rest
        moved[:, ~lattice.free] = 0.0
        for layer in moved:
            lattice.carried.apply(layer)
    return Cut(np.concatenate([lattice.rest + moved, lattice.skull.points[None]]), height)


def volume_ratio(lattice: Lattice, rest: Cut, other: Cut) -> float:
    """The volume of the free prisms of the left half that both cuts go through, of that at rest."""
    corners = lattice.prisms.corners
    crossed = np.ones(len(corners), np.bool_)
    volumes = []
    for one in (rest, other):
        points = one.surfaces[: HYPODERMIS + 1].reshape(-1, 3)
        y = points[corners, 1]
        crossed &= (y.min(axis=1) < one.height) & (y.max(axis=1) > one.height)
        volumes.append(lattice.prisms.volumes(points))
    crossed &= (rest.surfaces[EPIDERMIS, corners[:, 0], 0] > 0.0) & lattice.free[corners[:, :3]].any(axis=1)
    return float(volumes[1][crossed].sum() / volumes[0][crossed].sum())


class _Frame(NamedTuple):
    """What a picture shows: ``near (T, 3)`` triangles, seen from above, ``left`` and ``front`` in mm, ``wide`` mm."""

    near: Indices
    left: float
    front: float
    wide: float

    def pixels(self, points: Doubles) -> list[tuple[float, float]]:
        """Points ``(N, 3)`` mm seen from above, the nose at the lower left; the face looks down."""
        scale = FINER * _SIZE / self.wide
        return [(float(scale * (x - self.left)), float(scale * (z - self.front + self.wide))) for x, _, z in points]


def _frame(model: HeadModel, lattice: Lattice) -> _Frame:
    """The left half before the ear, without the inside of the mouth."""
    unit, cheek = 1e3 * float(model.landmarks.eye_separation), 1e3 * model.landmarks["cheek_l"]
    outside = model.material[:, 1] < _INSIDE
    shown = outside & (lattice.rest[EPIDERMIS, :, 0] > -0.1 * unit) & (lattice.rest[EPIDERMIS, :, 2] > -0.2 * unit)
    near = lattice.triangles[shown[lattice.triangles].all(axis=1)]
    return _Frame(near, float(cheek[0]) - 0.66 * unit, float(cheek[2]) + 0.56 * unit, 1.3 * unit)


def _picture(frame: _Frame, shown: Cut, before: Cut | None = None) -> Image:
    from PIL import Image, ImageDraw

    side = FINER * _SIZE
    image = Image.new("RGB", (side, side), (255, 255, 255))
    pen = ImageDraw.Draw(image)
    corners = shown.surfaces[:, frame.near].swapaxes(0, 1)  # (T, 4, 3, 3)
    _fill_bone(pen, frame, corners[:, BONE], shown.height)
    for name, (upper, lower) in _BETWEEN.items():
        for prism in corners[:, [upper, lower]]:
            inside = section(prism, shown.height)
            if len(inside) > 2:
                pen.polygon(frame.pixels(inside), fill=_COLOURS[name])
    for layer, colour in _LINES.items():
        for ends in _segments(corners[:, layer], shown.height):
            pen.line(frame.pixels(ends), fill=colour, width=2 * FINER)
    if before is not None:
        for ends in _segments(before.surfaces[EPIDERMIS][frame.near], before.height):
            (x, y), r = frame.pixels(ends.mean(axis=0)[None])[0], 2.0 * FINER
            pen.ellipse([x - r, y - r, x + r, y + r], fill=_BEFORE)
    _legend(pen, frame)
    return image.resize((_SIZE, _SIZE), Image.Resampling.BOX)


def _fill_bone(pen: ImageDraw, frame: _Frame, triangles: Doubles, height: float) -> None:
    """The bone some millimetres deep, towards the middle of the head."""
    centre = np.array([0.0, height, float(triangles[..., 2].min())])
    for ends in _segments(triangles, height):
        ways = centre - ends
        inner = ends + _INWARD_MM * ways / np.linalg.norm(ways, axis=1, keepdims=True)
        pen.polygon(frame.pixels(np.concatenate([ends, inner[::-1]])), fill=_COLOURS["bone"])


def _segments(triangles: Doubles, height: float) -> Iterator[Doubles]:
    """The ``(2, 3)`` ends of each cut through ``triangles (T, 3, 3)``."""
    for triangle in triangles:
        ends = section(triangle[None], height)
        if len(ends) == 2:
            yield ends


def section(corners: Doubles, height: float) -> Doubles:
    """``(N, 3)``: where a level plane cuts a triangle ``(1, 3, 3)`` or a prism ``(2, 3, 3)``, in order round it."""
    flat = corners.reshape(-1, 3)
    edges = [(3 * layer + one, 3 * layer + other) for layer in range(len(corners)) for one, other in _ROUND]
    edges += [(one, one + 3) for one in range(3)] if len(corners) > 1 else []
    start, end = (flat[list(side)] for side in zip(*edges, strict=True))
    crossed = (start[:, 1] < height) != (end[:, 1] < height)
    start, end = start[crossed], end[crossed]
    part = (height - start[:, 1]) / (end[:, 1] - start[:, 1]) if len(start) else np.zeros(0)
    found = start + part[:, None] * (end - start)
    away = found - found.mean(axis=0) if len(found) else found
    return np.asarray(found[np.argsort(np.arctan2(away[:, 2], away[:, 0]))])


def _legend(pen: ImageDraw, frame: _Frame) -> None:
    """The colours, and 10 mm."""
    from PIL import ImageFont

    font = ImageFont.load_default(FINER * 16)
    row, left = FINER * (_SIZE - 180), FINER * (_SIZE - 206)
    for name, colour in _COLOURS.items():
        pen.rectangle([left, row - 16, left + 44, row + 16], fill=colour, outline=INK)
        pen.text((left + 60, row), name, fill=INK, font=font, anchor="lm")
        row += FINER * 25
    length, right = 10.0 * FINER * _SIZE / frame.wide, FINER * (_SIZE - 24)
    row = FINER * (_SIZE - 30)
    pen.line([(right - length, row), (right, row)], fill=INK, width=3 * FINER)
    for end in (right - length, right):
        pen.line([(end, row - 12), (end, row + 12)], fill=INK, width=FINER)
    pen.text((right - 0.5 * length, row - 26), "10 mm", fill=INK, font=font, anchor="mm")
