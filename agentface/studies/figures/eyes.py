"""The closing of one eye, of both eyes, and the squeeze: Figures 7 and 8 of Bui, Heylen and Nijholt."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from agentface.conventions import Bytes
from agentface.deform.eyes.eyelids import coupled
from agentface.deform.protocol import DEFAULT_DEFORMER, make_deformer
from agentface.head.model import HeadModel, load_model
from agentface.parameters import FacePose
from agentface.view.camera import Camera
from agentface.view.contact_sheet import png, sheet
from agentface.view.renderer import Renderer

CLOSINGS = (0.0, 0.5, 1.0)
SQUEEZES = (0.0, 0.25, 0.5, 0.75, 1.0)
_CLOSER, _SQUEEZER = "orbicularis_oculi_palpebralis", "orbicularis_oculi_orbitalis"
_PAIR, _SINGLE = (560, 250), (330, 290)
_AWAY, _ABOVE = 0.5, 0.03  # m, of the camera


def figures(face: str | Path, deformer_name: str = DEFAULT_DEFORMER) -> dict[str, bytes]:
    """``eyelids.png``, one eye and both eyes closing, and ``squeeze.png``, one eye squeezed."""
    model = load_model(face)
    deformer, renderer = make_deformer(deformer_name, model), Renderer(model)

    def picture(pose: FacePose, camera: Camera, size: tuple[int, int]) -> Bytes:
        return renderer.render(deformer.at(pose), size, camera, "portrait")

    both = _camera(model, 0.0, 11.0)
    closing = [
        (picture(FacePose.of(**{f"{_CLOSER}{end}": level}), both, _PAIR), f"{what} {level:.1f}", _note(level, alone))
        for end, what, alone in (("_l", "Figure 7: one eye", True), ("", "Figure 8: both eyes", False))
        for level in CLOSINGS
    ]
    one = _camera(model, float(model.eye_centre("l")[0]), 8.0)
    squeezing = [
        (
            picture(FacePose.of(**{_SQUEEZER: level}), one, _SINGLE),
            f"squeeze {level:.2f}",
            f"closing {_closing(level):.1f}",
        )
        for level in SQUEEZES
    ]
    return {
        "eyelids.png": png(sheet(closing, columns=len(CLOSINGS))),
        "squeeze.png": png(sheet(squeezing, columns=len(SQUEEZES))),
    }


def _camera(model: HeadModel, x: float, opening_deg: float) -> Camera:
    """Looks at the eyes' height from the front, at ``x`` metres to the person's left."""
    _, y, z = (float(value) for value in model.eye_centre("l"))
    return Camera((x, y + _ABOVE, z + _AWAY), (x, y, z), float(np.radians(opening_deg)))


def _note(level: float, alone: bool) -> str:
    other = 0.0 if alone else level
    return f"squeezed {coupled(level, 0.0, other, 0.0)[1]:.2f}"


def _closing(squeeze: float) -> float:
    return coupled(0.0, squeeze, 0.0, squeeze)[0]
