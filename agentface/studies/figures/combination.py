"""Three ways to combine muscles, side by side: Figures 4 and 5 of Bui, Heylen and Nijholt.

The muscles are those of the anatomist's table, each made as strong as the strongest, so that the mesh is pulled
far: the ways differ most where vertices go far.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Bytes, Doubles
from agentface.deform.muscles.combine import REFERENCE, Method
from agentface.head.model import HeadModel, load_model
from agentface.head.muscle_set import MuscleSet
from agentface.head.muscles import read_muscles
from agentface.studies.calibration.calibrate import anatomy_file
from agentface.studies.figures.mesh_view import FOLDED, SKIN, Colour, MeshView, draw_arrow, draw_mesh, folded
from agentface.view.contact_sheet import INK, png, sheet

if TYPE_CHECKING:
    from PIL.Image import Image

STRENGTH = 0.32
"""The elasticity of every muscle in the figures, in eye separations."""
MUSCLES: dict[str, Colour] = {
    "zygomaticus_major_l": (28, 98, 196),
    "levator_anguli_oris_l": (20, 138, 84),
    "levator_labii_superioris_l": (138, 62, 176),
}
_PANEL, _FINER = 400, 3


@dataclass(frozen=True, slots=True)
class Combination:
    """One picture: these muscles at full contraction, combined this way."""

    letter: str
    title: str
    muscles: tuple[str, ...]
    method: Method = "parallel"
    shows_muscles: bool = False


def _three_ways(muscles: tuple[str, ...], letters: str) -> list[Combination]:
    ways: tuple[Method, ...] = ("parallel", "summed", "sequential")
    return [Combination(letter, way, muscles, way) for letter, way in zip(letters, ways, strict=True)]


_A, _B, _C = MUSCLES
FIGURES: dict[str, list[Combination]] = {
    "two-muscles": [
        Combination("", "at rest", (_A, _B), shows_muscles=True),
        Combination("a", "zygomaticus major", (_A,)),
        Combination("b", "levator anguli oris", (_B,)),
        *_three_ways((_A, _B), "cde"),
    ],
    "three-muscles": _three_ways((_A, _B, _C), "abc"),
}
"""The panels of each figure by the name of its file, three in a row."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a panel shows in numbers: the largest displacement, and how many triangles turned over."""

    largest_mm: float
    folded: int


def strong_muscles(face: str | Path) -> tuple[HeadModel, MuscleSet]:
    """A face, and the anatomist's muscles on it, all of the same strength."""
    model = load_model(face, muscles=read_muscles(anatomy_file()))
    elasticity = np.full(len(model.muscles), STRENGTH * model.landmarks.eye_separation)
    return model, replace(model.muscles, elasticity=elasticity)


def deformed(model: HeadModel, muscles: MuscleSet, panel: Combination) -> tuple[Doubles, Outcome]:
    """The vertices ``(V, 3)`` m of a panel, and its numbers."""
    rest = model.vertices.astype(np.float64)
    if panel.shows_muscles:
        return rest, Outcome(0.0, 0)
    contractions = np.isin(muscles.names, panel.muscles).astype(np.float64)
    moved = REFERENCE[panel.method](rest, muscles, contractions)
    largest = 1e3 * float(np.linalg.norm(moved - rest, axis=1).max())
    return moved, Outcome(largest, int(folded(rest, moved, model.triangles).sum()))


def figures(face: str | Path) -> dict[str, bytes]:
    """The figures as PNG files, by name; the same bytes for the same face."""
    model, muscles = strong_muscles(face)
    return {f"{name}.png": png(_sheet(model, muscles, panels), _palette()) for name, panels in FIGURES.items()}


def _sheet(model: HeadModel, muscles: MuscleSet, panels: Sequence[Combination]) -> Image:
    outcomes = [deformed(model, muscles, panel) for panel in panels]
    drawn = [_picture(model, muscles, panel, moved) for panel, (moved, _) in zip(panels, outcomes, strict=True)]
    titles = [f"({panel.letter}) {panel.title}" if panel.letter else panel.title for panel in panels]
    notes = [_note(panel, outcome) for panel, (_, outcome) in zip(panels, outcomes, strict=True)]
    return sheet(list(zip(drawn, titles, notes, strict=True)), columns=3)


def _note(panel: Combination, outcome: Outcome) -> str:
    if panel.shows_muscles:
        return "dots: where the muscles leave the bone"
    count = f"{outcome.folded} triangles folded over" if outcome.folded else "no triangle folded over"
    return f"moved up to {outcome.largest_mm:.1f} mm, {count}"


def _picture(model: HeadModel, muscles: MuscleSet, panel: Combination, moved: Doubles) -> Image:
    from PIL import Image, ImageDraw

    centre = 0.5 * (model.landmarks["mouth_corner_l"] + model.landmarks["infraorbital_l"])
    view = MeshView(centre, 1.5 * model.landmarks.eye_separation, 28.0, _PANEL * _FINER)
    image = Image.new("RGB", (view.size, view.size), (255, 255, 255))
    draw = ImageDraw.Draw(image)
    eye = model.parts["eye_l"]
    white = eye.attributes["POSITION"].astype(np.float64)
    draw_mesh(draw, view, white, white, eye.triangles)
    draw_mesh(draw, view, model.vertices.astype(np.float64), moved, model.triangles)
    for name in panel.muscles:
        muscle = muscles.index(name)
        draw_arrow(draw, view, [muscles.origin[muscle], muscles.insertion[muscle]], MUSCLES[name])
    return image.resize((_PANEL, _PANEL), Image.Resampling.BOX)


def _palette() -> Bytes:
    """``(N, 3)``: shades of skin, folded skin, the muscles' colours, greys; a picked palette loses the rare ones."""
    white, black = np.full(3, 255.0), np.zeros(3)
    ramps = [(black, SKIN, 80), (0.3 * FOLDED, FOLDED, 16), (FOLDED, SKIN, 16), (np.array(INK), white, 32)]
    ramps += [(np.array(colour), end, 16) for colour in MUSCLES.values() for end in (white, 0.8 * SKIN)]
    return np.concatenate([np.linspace(*ramp) for ramp in ramps]).astype(np.uint8)
