"""The tongue: out of the mouth and in it."""

from __future__ import annotations

import math
from pathlib import Path

from agentface.deform.protocol import DEFAULT_DEFORMER, make_deformer
from agentface.head.model import load_model
from agentface.parameters import FacePose
from agentface.studies.figures.jaw import close_to_the_mouth
from agentface.view.contact_sheet import png, sheet
from agentface.view.renderer import Renderer

POSES: dict[str, dict[str, float]] = {
    "out": {"tongue_out": 1.0, "jaw_open": 0.5},
    "out, jaw open 0.2": {"tongue_out": 1.0, "jaw_open": 0.2},
    "tip up": {"tongue_out": 1.0, "jaw_open": 0.6, "tongue_tip_raise": 1.0},
    "tip to the left": {"tongue_out": 1.0, "jaw_open": 0.5, "tongue_tip_shift": 1.0},
    "rolled": {"tongue_out": 1.0, "jaw_open": 0.6, "tongue_roll": 1.0},
    "inside, tip up": {"jaw_open": 0.8, "tongue_tip_raise": 1.0},
}
_TURNS_DEG = {"front": 0.0, "three-quarter": 36.0, "profile": 85.0}
_SIZE = (300, 300)


def figures(face: str | Path, deformer_name: str = DEFAULT_DEFORMER) -> dict[str, bytes]:
    """``tongue.png``: the mouth in each of :data:`POSES`, from three sides."""
    model = load_model(face)
    deformer, renderer = make_deformer(deformer_name, model), Renderer(model)
    panels = []
    for name, turn in _TURNS_DEG.items():
        camera = close_to_the_mouth(model, math.radians(turn))
        for title, pose in POSES.items():
            picture = renderer.render(deformer.at(FacePose.of(**pose)), _SIZE, camera, "portrait")
            panels.append((picture, title if name == "front" else "", ""))
    return {"tongue.png": png(sheet(panels, columns=len(POSES)))}
