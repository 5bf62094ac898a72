"""The figures of the documents: each module draws some, side by side with the papers' where they have the same."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import import_module
from inspect import signature
from pathlib import Path

from agentface.deform.protocol import DEFAULT_DEFORMER

FIGURES: dict[str, str] = {
    "lips": "Figures 2 and 6: the lips' surface and its control points, and orbicularis oris",
    "combination": "Figures 4 and 5: one, two and three muscles, combined in three ways",
    "parallel_steps": "orbicularis oris and oculi after the vector muscles' steps and in them, and the artists' shapes",
    "eyes": "Figures 7 and 8: closing one eye, closing both; and the squeeze that closes",
    "jaw": "the jaw's opening, from closed to wide",
    "tongue": "the tongue, out of the mouth and in it",
    "wrinkles": "Figures 11 and 12: shading normals at the wrinkles' feet, and wrinkles on mesh and forehead",
    "texture": "a picture worn as skin",
    "muscles": "the muscles on the face, by name and action unit",
    "regions": "the regions and sub-regions of the face",
    "rings": "the rings of vertices round mouth and eyes",
    "feature_points": "the feature points of MPEG-4 with their numbers",
    "faps": "each FAP at both ends of what the faces show of it, a sheet a group",
    "visemes": "the mouth in each viseme, from two sides",
    "looks": "the faces in their looks, and the styles of hair",
    "talking": "faces that speak and feel, frame by frame",
    "life": "five seconds of a face that listens, every tenth frame",
    "envelopes": "how emotions come and go, and what the muscles make of a change",
    "expressions": "Figures 13 to 16: neutral, surprise, happiness, sadness",
    "springs": "the second paper's Figure 2: the three layers, and the springs in and between them",
    "integrated_face": "its Figure 4: the skull, the 23 muscles, the hypodermis",
    "cheek_cut": "a cut through the cheek, at rest and in happiness",
    "breadth_first": "its Figure 5: the order of the adaptive scheme on the mesh",
    "tissue_expressions": "its Figure 6: the neutral face and five expressions of the layered tissue",
    "tissue_charts": "its Figures 7 and 8: errors and times of its schemes and ours, of a report that is kept",
    "window": "the window, on a virtual display",
}
"""The figures and what they show; each is a module of this package with ``figures(face) -> {file name: PNG}``,
and with a ``deformer_name`` where any deformer will do."""


def draw(
    face: str | Path, names: tuple[str, ...] = tuple(FIGURES), deformer: str = DEFAULT_DEFORMER
) -> Iterator[tuple[str, bytes]]:
    """File name and content of every picture of the figures ``names``, one after the other as they are drawn."""
    for name in names:
        figures = import_module(f"agentface.studies.figures.{name}").figures
        options = {"deformer_name": deformer} if "deformer_name" in signature(figures).parameters else {}
        yield from figures(face, **options).items()
