"""What the mouth does for each sound of speech."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from agentface.deform.protocol import DEFAULT_DEFORMER, make_deformer
from agentface.head.model import HeadModel, load_model
from agentface.parameters import FacePose
from agentface.resources import face_names
from agentface.speech.visemes import viseme_table
from agentface.view.camera import Camera
from agentface.view.contact_sheet import png, sheet
from agentface.view.renderer import Renderer

_TURNS_DEG = (0.0, 40.0)
_SIZE, _DISTANCE, _FIELD_OF_VIEW_DEG = (190, 160), 0.5, 9.0


def figures(face: str | Path, deformer_name: str = DEFAULT_DEFORMER) -> dict[str, bytes]:
    """``visemes-NAME.png`` of ``face``, and of the faces that come with agentface."""
    first = load_model(face)
    models = [first, *(load_model(name) for name in face_names() if name != first.name)]
    return {f"visemes-{model.name}.png": _sheet(model, deformer_name) for model in models}


def _sheet(model: HeadModel, deformer_name: str) -> bytes:
    """Every viseme, half of them in a row, from the front and below that from three quarters."""
    deformer, renderer, table = make_deformer(deformer_name, model), Renderer(model), viseme_table()
    names, columns = list(table), (len(table) + 1) // 2
    panels = []
    for row in (names[:columns], names[columns:]):
        for turn in _TURNS_DEG:
            camera = _at_the_lips(model, math.radians(turn))
            for name in row:
                picture = renderer.render(deformer.at(FacePose(table[name].values)), _SIZE, camera, "portrait")
                panels.append((picture, name if not turn else "", ""))
            panels += [(np.full_like(panels[-1][0], 255), "", "")] * (columns - len(row))
    return png(sheet(panels, columns=columns))


def _at_the_lips(model: HeadModel, turn: float) -> Camera:
    """A camera on the lips, ``turn`` radians to the person's left of the front."""
    x, y, z = model.landmarks["lower_lip_middle"].tolist()
    eye = (x + _DISTANCE * math.sin(turn), y, z + _DISTANCE * math.cos(turn))
    return Camera(eye=eye, target=(x, y, z - 0.01), field_of_view=math.radians(_FIELD_OF_VIEW_DEG))
