"""The neutral face and five expressions of the layered tissue: Figure 6 of Zhang, Prakash and Sung."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from agentface.deform.protocol import make_deformer
from agentface.emotion.inference import default_inference
from agentface.emotion.state import EmotionState
from agentface.head.model import load_model
from agentface.studies.figures.overlay import in_colours
from agentface.view.camera import named_view
from agentface.view.contact_sheet import sheet
from agentface.view.renderer import Renderer

EXPRESSIONS: dict[str, tuple[float, float]] = {
    "neutral": (0.0, 0.0),
    "happiness": (32.0, 2.0),
    "anger": (-18.0, 0.0),
    "surprise": (26.0, -4.0),
    "sadness": (-32.0, 3.0),
    "disgust": (14.0, 0.0),
}
"""The paper's six, in its order, each seen from elsewhere as there: degrees to the person's left, and upwards."""
_SIZE = (400, 470)


def figures(face: str | Path) -> dict[str, bytes]:
    """``tissue-expressions.png``: each of :data:`EXPRESSIONS` at its height, in equilibrium."""
    model = load_model(face)
    deformer, inference, renderer = make_deformer("tissue", model), default_inference(), Renderer(model)
    front, panels = named_view(model, "front"), []
    for letter, (name, (yaw, pitch)) in zip("abcdef", EXPRESSIONS.items(), strict=True):
        state = EmotionState() if name == "neutral" else EmotionState.of({name: 1.0})
        camera = front.orbited(float(np.radians(yaw)), float(np.radians(pitch)))
        picture = renderer.render(deformer.at(inference.pose(state)), _SIZE, camera, "portrait")
        panels.append((picture, f"({letter}) {name}", _seen(yaw)))
    return {"tissue-expressions.png": in_colours(sheet(panels, columns=3))}


def _seen(yaw: float) -> str:
    return f"{abs(yaw):.0f} degrees to the {'left' if yaw > 0.0 else 'right'}" if yaw else "from the front"
