"""The mouth as the jaw opens it: section 3.4 of Bui, Heylen and Nijholt."""

from __future__ import annotations

import math
from pathlib import Path

from agentface.deform.protocol import DEFAULT_DEFORMER, make_deformer
from agentface.head.model import HeadModel, load_model
from agentface.parameters import FacePose
from agentface.view.camera import Camera
from agentface.view.contact_sheet import png, sheet
from agentface.view.renderer import Renderer

OPENINGS = (0.0, 0.25, 0.5, 0.75, 1.0)
_TURNS_DEG = {"front": 0.0, "three-quarter": 36.0}
_SIZE, _DISTANCE, _FIELD_OF_VIEW_DEG = (340, 340), 0.5, 13.0


def figures(face: str | Path, deformer_name: str = DEFAULT_DEFORMER) -> dict[str, bytes]:
    """``jaw.png``: the mouth at each of :data:`OPENINGS`, from the front and from three quarters."""
    model = load_model(face)
    deformer, renderer = make_deformer(deformer_name, model), Renderer(model)
    panels = []
    for name, turn in _TURNS_DEG.items():
        camera = close_to_the_mouth(model, math.radians(turn))
        for opening in OPENINGS:
            picture = renderer.render(deformer.at(FacePose.of(jaw_open=opening)), _SIZE, camera, "portrait")
            degrees = f"the jaw turns by {opening * model.jaw.widest_deg:.0f} degrees"
            panels.append((picture, f"open {opening:g}", degrees if name == "front" else ""))
    return {"jaw.png": png(sheet(panels, columns=len(OPENINGS)))}


def close_to_the_mouth(model: HeadModel, turn: float) -> Camera:
    """A camera on the mouth and the chin, ``turn`` radians to the person's left of the front."""
    x, y, z = (0.5 * (model.landmarks["lower_lip_middle"] + model.landmarks["pogonion"])).tolist()
    eye = (x + _DISTANCE * math.sin(turn), y + 0.03 * _DISTANCE, z + _DISTANCE * math.cos(turn))
    return Camera(eye=eye, target=(x, y, z), field_of_view=math.radians(_FIELD_OF_VIEW_DEG))
