"""Every FAP at both ends of what a face shows of it, on each face that comes with agentface: a sheet a group."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from agentface.conventions import Bytes
from agentface.deform.pipeline import GeometricDeformer
from agentface.head.model import HeadModel, load_model
from agentface.mpeg4.fap_readings import EYES, HEAD
from agentface.mpeg4.fap_solver import FapSolver
from agentface.mpeg4.faps import FAP_COUNT, LOW_LEVEL, Fap
from agentface.parameters import FacePose
from agentface.resources import face_names
from agentface.view.camera import Camera
from agentface.view.contact_sheet import png, sheet
from agentface.view.renderer import Renderer

GROUPS = {
    2: "jaw-and-inner-lips", 3: "eyes", 4: "eyebrows", 5: "cheeks", 6: "tongue", 7: "head", 8: "outer-lips", 9: "nose",
    10: "ears",
}  # fmt: skip
_SIZE = 150, 135
_AWAY = 0.6  # m, of the camera
_ANGLES = {**dict.fromkeys(EYES, 30_000.0), **dict.fromkeys(HEAD, 40_000.0)}
"""AU, to which eyes and head turn."""
_VIEWS = {
    2: ("2.3", 0.0, 1.5), 3: ("9.7", 0.0, 1.9), 4: ("9.7", 0.0, 2.0), 5: ("9.15", 20.0, 2.6), 6: ("2.3", 0.0, 1.5),
    7: ("9.3", 0.0, 5.4), 8: ("2.3", 0.0, 1.5), 9: ("9.3", 15.0, 1.6), 10: ("9.3", 0.0, 4.0),
}  # fmt: skip
"""By group: the feature point in the middle, degrees from the person's left, height in eye separations."""
_ASIDE_DEG = 60.0
"""From where depth is seen."""
_JAW = 0.6
"""The jaw's opening for the tongue."""


def figures(face: str | Path) -> dict[str, bytes]:
    """``faps-N-NAME.png`` for each group, of ``face`` and the faces that come with agentface."""
    first = load_model(face)
    models = [first, *(load_model(name) for name in face_names() if name != first.name)]
    stages = [_Stage(model) for model in models]
    drawn: dict[str, bytes] = {}
    for group, name in GROUPS.items():
        known = [each for each in LOW_LEVEL if each.group == group]
        panels = [panel for each in known for stage in stages for panel in stage.ends(each)]
        drawn[f"faps-{group}-{name}.png"] = png(sheet(panels, columns=4 * len(models) if len(known) > 5 else 4))
    return drawn


class _Stage:
    """Takes pictures of one face."""

    def __init__(self, model: HeadModel) -> None:
        self._model, self._solver = model, FapSolver(model)
        self._deformer, self._renderer = GeometricDeformer(model), Renderer(model)

    def ends(self, fap: Fap) -> list[tuple[Bytes, str, str]]:
        """The face at the least and at the largest value that it shows, all other FAPs free."""
        return [self._picture(fap, value) for value in self._reach(fap)]

    def _reach(self, fap: Fap) -> tuple[float, float]:
        if fap.number in _ANGLES:
            return -_ANGLES[fap.number], _ANGLES[fap.number]
        low, high = self._solver.reach(fap.number)
        return max(low, float(fap.low)), min(high, float(fap.high))

    def _picture(self, fap: Fap, value: float) -> tuple[Bytes, str, str]:
        faps, named = np.zeros(FAP_COUNT), np.zeros(FAP_COUNT, np.bool_)
        faps[fap.number - 1], named[fap.number - 1] = value, True
        before = FacePose.of(jaw_open=_JAW) if fap.group == 6 else FacePose()
        geometry = self._deformer.at(self._solver.solve(faps, named, before).pose)
        shown = self._solver.meter.measure(geometry)[fap.number - 1]
        picture = self._renderer.render(geometry, _SIZE, self._camera(fap), "portrait")
        return picture, f"{fap.number} at {shown:.0f}", f"{fap.name}"

    def _camera(self, fap: Fap) -> Camera:
        point, yaw_deg, height = _VIEWS[fap.group]
        if fap.positive == "forward":
            yaw_deg = _ASIDE_DEG
        place = self._solver.meter.points[point].position
        target = 0.0, float(place[1]), float(place[2])
        yaw = float(np.radians(yaw_deg if "_r_" not in f"_{fap.name}_" else -yaw_deg))
        eye = _AWAY * np.sin(yaw), target[1] + 0.02, target[2] + _AWAY * np.cos(yaw)
        opening = 2 * float(np.arctan(0.5 * height * self._model.landmarks.eye_separation / _AWAY))
        return Camera((float(eye[0]), float(eye[1]), float(eye[2])), target, opening)
