"""The neutral face, surprise, happiness and sadness: Figures 13 to 16 of Bui, Heylen and Nijholt."""

from __future__ import annotations

from pathlib import Path

from agentface.deform.protocol import DEFAULT_DEFORMER, make_deformer
from agentface.emotion.inference import default_inference
from agentface.emotion.state import EmotionState
from agentface.head.model import load_model
from agentface.view.contact_sheet import png, sheet
from agentface.view.renderer import Renderer

EMOTIONS = {"neutral": "Figure 13", "surprise": "Figure 14", "happiness": "Figure 15", "sadness": "Figure 16"}
_SIZE = (420, 500)


def figures(face: str | Path, deformer_name: str = DEFAULT_DEFORMER) -> dict[str, bytes]:
    """``emotional-faces.png``: each of :data:`EMOTIONS` at its height, from the front and from three quarters."""
    model = load_model(face)
    deformer, inference, renderer = make_deformer(deformer_name, model), default_inference(), Renderer(model)
    panels = []
    for camera in ("front", "three-quarter"):
        for name, number in EMOTIONS.items():
            state = EmotionState() if name == "neutral" else EmotionState.of({name: 1.0})
            geometry = deformer.at(inference.pose(state))
            picture = renderer.render(geometry, _SIZE, camera, "portrait")
            panels.append((picture, name, f"{number} of the paper" if camera == "front" else ""))
    return {"emotional-faces.png": png(sheet(panels, columns=len(EMOTIONS)))}
