"""Orbicularis oris and oculi beside vector muscles: after the steps, in them, and the artists' shapes."""

from __future__ import annotations

import math
from pathlib import Path

from agentface.head.model import HeadModel, load_model
from agentface.parameters import FacePose
from agentface.studies.parallel_steps import CASES, WAYS, SteppedFace, compare
from agentface.view.camera import Camera
from agentface.view.contact_sheet import png, sheet
from agentface.view.renderer import Renderer

SHOWN = {case.name: case for case in CASES if case.name in ("smile, pucker", "smile, press", "smile, squeeze")}
_SIZE, _AWAY = (300, 260), 0.5
_MOUTH, _EYES = 1.45, 2.2  # eye separations that a picture covers


def figures(face: str | Path) -> dict[str, bytes]:
    """``parallel_steps.png``: a row a view, the three ways of each case and the sum of the artists' shapes."""
    model = load_model(face, asymmetry=0.0)
    faces, renderer = {way: SteppedFace(model, way) for way in WAYS}, Renderer(model)
    mouth, eyes = _camera(model, eyes=False, turn_deg=0.0), _camera(model, eyes=True, turn_deg=0.0)
    views = [(name, eyes if "squeeze" in name else mouth) for name in SHOWN]
    views.insert(1, (views[0][0], _camera(model, eyes=False, turn_deg=40.0)))
    panels = []
    for name, camera in views:
        case, outcomes = SHOWN[name], compare(model, SHOWN[name])
        for way, shown in faces.items():
            picture = renderer.render(shown.at(case.pose), _SIZE, camera, "portrait")
            panels.append((picture, f"{name}: {way}", f"{outcomes[way].error_mm:.2f} mm from the artists"))
        drawn = faces["once"].shown(FacePose().array, model.vertices + case.artists(model))
        panels.append((renderer.render(drawn, _SIZE, camera, "portrait"), "the artists' shapes", "summed"))
    return {"parallel_steps.png": png(sheet(panels, columns=len(WAYS) + 1))}


def _camera(model: HeadModel, *, eyes: bool, turn_deg: float) -> Camera:
    """Looks at the mouth or at the eyes, ``turn_deg`` from the front towards the person's left."""
    marks, turn = model.landmarks, math.radians(turn_deg)
    names = ("infraorbital_l", "infraorbital_r") if eyes else ("upper_lip_middle", "lower_lip_middle")
    x, y, z = (0.5 * (marks[names[0]] + marks[names[1]])).tolist()
    away = (x + _AWAY * math.sin(turn), y + 0.05 * _AWAY, z + _AWAY * math.cos(turn))
    width = (_EYES if eyes else _MOUTH) * marks.eye_separation
    return Camera(away, (x, y, z), 2.0 * math.atan(0.5 * width / _AWAY))
