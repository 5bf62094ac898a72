"""From a pose to a face: the deformers, one behind the other, and the protocol that every deformer keeps."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from importlib import import_module
from typing import Any, Protocol

from agentface.conventions import Floats
from agentface.deform import tables as frame
from agentface.deform.geometry import FaceGeometry
from agentface.deform.muscles.combine import Combiner, Method
from agentface.deform.ranges import check_pose
from agentface.head.model import HeadModel
from agentface.mesh.normal_field import NormalField
from agentface.parameters import VECTOR_MUSCLES, FacePose, indices_of

_PARTS = {
    "limits": "muscles.limits",
    "lips": "mouth.lips",
    "eyelids": "eyes.eyelids",
    "volumes": "muscles.volumes",
    "jaw": "mouth.jaw",
    "contact": "mouth.contact",
    "squash": "muscles.squash",
    "between": "midpoints",
    "wrinkles": "finish.wrinkles",
    "shading": "finish.wrinkle_normals",
    "eyes": "eyes.eyeballs",
    "head": "finish.head_turn",
}


class Deformer(Protocol):
    """Makes a face of a pose."""

    def deform(self, pose: FacePose) -> FaceGeometry:
        """The face in ``pose``; the result's arrays are overwritten by the next call."""


class GeometricDeformer:
    """The muscle-based face of Bui, Heylen and Nijholt.

    The vector muscles move the skin and the control points of the lips, combined as ``combine`` says, and gather
    volumes, as far as each region allows; then orbicularis oris, the lids, and the jaw, which carries all that along;
    then the lips' surface takes its vertices, lips and teeth are kept apart, no skin turns over, and the wrinkles
    rise. ``compiled=False`` takes the numpy forms, the same to 1e-6 m: ready at once, slow a frame.
    """

    def __init__(self, model: HeadModel, combine: Method = "parallel", *, compiled: bool = True) -> None:
        tables, muscles = frame.prepare(model)
        count = len(model.vertices)
        self._points = tables.rest.copy()
        self.geometry = FaceGeometry.at_rest(model.vertices, model.vertices, len(model.trains))
        self.geometry.vertices = self._points[:count]
        self._combiner = Combiner(tables.rest, muscles, combine, compiled=compiled)
        self._normals = NormalField(model.triangles, count, compiled=compiled)
        first = indices_of(VECTOR_MUSCLES[0])[0]
        self._muscles = slice(first, first + len(VECTOR_MUSCLES))
        self._stages = self._in_order(tables, "_compiled" if compiled else "")

    def deform(self, pose: FacePose) -> FaceGeometry:
        """The face in ``pose``; the result's arrays are overwritten by the next call.

        Raises InvalidValueError for a parameter outside its range.
        """
        values = pose.values
        check_pose(values)
        for stage in self._stages.values():
            stage(values)
        return self.geometry

    def stages(self) -> dict[str, Callable[[FacePose], None]]:
        """What a frame consists of, in its order, by name: each goes on from what the ones before it left."""
        return {name: partial(_act, stage) for name, stage in self._stages.items()}

    def _in_order(self, tables: frame.PartTables, ending: str) -> dict[str, Callable[[Floats], None]]:
        part: dict[str, Any] = {
            name: import_module(f"agentface.deform.{module}{ending}") for name, module in _PARTS.items()
        }
        shown, points = self.geometry, self._points
        raised = part["wrinkles"]

        def raise_wrinkles(values: Floats) -> None:
            raised.levels(tables.wrinkles, values, shown.wrinkle_levels)
            raised.heights(tables.wrinkles, values, shown.wrinkles)
            raised.raise_vertices(tables.wrinkles, shown.wrinkles, shown.smooth_normals, shown.vertices)

        return {
            "muscles": lambda values: self._combiner.apply(values[self._muscles], points),
            "volumes": lambda values: part["volumes"].apply(tables.volumes, values, points),
            "limits": lambda _: part["limits"].apply(tables.limits, points),
            "orbicularis_oris": lambda values: part["lips"].contract(tables.lips, values, points),
            "eyelids": lambda values: part["eyelids"].apply(tables.eyelids, values, points),
            "jaw": lambda values: part["jaw"].apply(tables.jaw, values, points),
            "lips": lambda _: part["lips"].surface(tables.lips, points),
            "contact": lambda values: part["contact"].apply(tables.contact, values, points),
            "creases": lambda _: part["squash"].apply(tables.creases, points),
            "between": lambda _: part["between"].apply(tables.between, points),
            "smooth_normals": lambda _: self._normals.compute(shown.vertices, shown.smooth_normals),
            "wrinkles": raise_wrinkles,
            "normals": lambda _: part["shading"].apply(
                tables.shading, shown.wrinkles, shown.vertices, shown.smooth_normals, shown.normals
            ),
            "eyes": lambda values: part["eyes"].apply(tables.eyes, values, shown.eye_rotations),
            "teeth": lambda values: part["jaw"].transform(tables.jaw, values, shown.jaw),
            "head": lambda values: part["head"].apply(tables.head, values, shown.head),
        }


def _act(stage: Callable[[Floats], None], pose: FacePose) -> None:
    stage(pose.values)
