"""The meshes of a face as other programs get them, and where each of them is in a geometry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np

from agentface.conventions import SIDES, Doubles, Floats, Indices
from agentface.deform.finish import neck
from agentface.deform.geometry import FaceGeometry
from agentface.head.look import Look
from agentface.head.model import HeadModel
from agentface.mesh.normals import vertex_normals
from agentface.mesh.smoothstep import smoothstep
from agentface.view.bake.flat import EYE_INSET
from agentface.view.dressing import dressed_skin, grown_hair, irregularities
from agentface.view.hair.grown import GrownHair
from agentface.view.hair.hair_mesh import hair_colours, hair_strips, hair_triangles, strand_mesh
from agentface.view.hair.ribbons import Hairs
from agentface.view.hair.sheets import sheet_places, sheets_mesh
from agentface.view.parts.anchored import Anchored, eye_linings
from agentface.view.parts.shirt import shirt
from agentface.view.parts.teeth import crown_places
from agentface.view.skin.uncovered import uncovered

Rides: TypeAlias = Literal["skin", "head", "body", "eye_l", "eye_r"]
"""What turns a part: the head and, where it holds on to the neck, the body, as the skin; one of them; an eye."""
PlacesAndNormals: TypeAlias = tuple[Floats, Floats]
_STRANDS = "fast"
_CAP_AXIS = np.array([0.0, 0.75, -0.66])
_CAP_REACH = np.radians(165.0)
_SHADED = 0.75
"""How much darker the skin's deepest folds are than what no fold keeps light from."""
_IN_MOUTH = (0.40, 0.16, 0.15)
"""What of the skin's colour is left on the inside of the mouth."""
_ASIDE_SHADE, _LID_SHADE = 0.6, 0.5
_SHADED_EYE = (0.0, 0.0, 0.0)
GUM, TONGUE = (0.46, 0.20, 0.185), (0.40, 0.15, 0.145)
"""As in ``shaders/part.frag.glsl``."""
_BEHIND_LIPS = 0.85
_BETWEEN_TEETH, _AT_GUM = (0.74, 0.64, 0.56), (0.96, 0.90, 0.83)


@dataclass(frozen=True)
class FacePart:
    """One mesh of N vertices.

    Attributes:
        name: of its own.
        material: the name of what it is made of.
        rides: what turns it.
        triangles: ``(T, 3)``.
        at: its places ``(N, 3)`` m and unit normals in a geometry whose neck is released (:func:`released`), in the
            axes of what it rides on: an eye's about its centre.
        uv: ``(N, 2)`` texture coordinates as in glTF, or None.
        colours: ``(N, 3)`` linear 0..1, or None.
        stays: ``(N,)`` 0..1, for one that rides as the skin: how much of it does not turn with the head.
        turning: whether its normals change enough to be seen.
    """

    name: str
    material: str
    rides: Rides
    triangles: Indices
    at: Callable[[FaceGeometry], PlacesAndNormals]
    uv: Floats | None = None
    colours: Floats | None = None
    stays: Floats | None = None
    turning: bool = True


def released(model: HeadModel, geometry: FaceGeometry) -> FaceGeometry:
    """A geometry of its own arrays whose neck is not held back in place, and whose head is not turned."""
    free = geometry.copy()
    tables = model.derived("gltf.neck", neck.prepare)
    free.vertices, free.normals = neck.released(tables, geometry.head, geometry.vertices, geometry.normals)
    free.head = np.eye(4, dtype=np.float32)
    return free


def face_parts(model: HeadModel, look: Look) -> list[FacePart]:
    """All meshes of a face: skin, teeth, tongue, eyes and their linings, brows, lashes, hair, shirt."""
    grown = grown_hair(model, look)
    return [
        _skin(model, look, grown),
        *_mouth(model, look),
        *_eyes(model),
        *_linings(model),
        *_small_hairs(model, look),
        *(() if grown is None else _head_hair(model, grown)),
        _shirt(model),
    ]


def _skin(model: HeadModel, look: Look, grown: GrownHair | None) -> FacePart:
    mouth = np.clip((model.material[:, 1] - 0.35) / 0.55, 0.0, 1.0)
    light = dressed_skin(model, look, grown)["ambient"][:, 0]
    light = 1.0 - _SHADED * (1.0 - light)
    colours = light[:, None] * (1.0 + mouth[:, None] * (np.array(_IN_MOUTH) - 1.0))
    return FacePart(
        "skin",
        "skin",
        "skin",
        uncovered(model),
        lambda geometry: (geometry.vertices, geometry.normals),
        uv=model.uv,
        colours=colours.astype(np.float32),
        stays=np.float32(1.0) - neck.shares(model),
    )


def _mouth(model: HeadModel, look: Look) -> list[FacePart]:
    upper = model.parts["teeth_upper"]
    places, triangles = upper.attributes["POSITION"], upper.triangles
    still = places, vertex_normals(places, triangles).astype(np.float32)
    lower, tongue = model.parts["teeth_lower"].attributes["POSITION"], model.parts["tongue"].triangles
    below = model.parts["teeth_lower"].triangles
    colours = {name: _mouth_colours(model, look, name) for name in ("teeth_upper", "teeth_lower", "tongue")}
    return [
        FacePart("teeth_upper", "teeth", "head", triangles, lambda _: still, colours=colours["teeth_upper"]),
        FacePart(
            "teeth_lower", "teeth", "head", below, lambda g: _with_normals(_moved(g.jaw, lower), below),
            colours=colours["teeth_lower"],
        ),
        FacePart(
            "tongue", "tongue", "head", tongue, lambda g: _with_normals(_moved(g.jaw, g.tongue), tongue),
            colours=colours["tongue"],
        ),
    ]  # fmt: skip


def _mouth_colours(model: HeadModel, look: Look, name: str) -> Floats:
    """Teeth that are darker towards the gum and beside each other, gums, tongue; as shaders/part.frag.glsl has them."""
    mesh = model.parts[name]
    matter = mesh.attributes["_MATERIAL"].astype(np.float32) / np.float32(255)
    aside, up = crown_places(mesh.attributes["POSITION"], mesh.triangles, matter[:, 0]).T.astype(np.float64)
    tooth = np.array(look.teeth) * np.where(up[:, None] > 0.7, _AT_GUM, 1.0)
    tooth = tooth * np.where(np.abs(aside)[:, None] > 0.9, _BETWEEN_TEETH, 1.0)
    line = 0.93 - 0.13 * aside**2
    gum = np.clip((up - line) / 0.05, 0.0, 1.0)[:, None]
    mixed = matter[:, :1] * (tooth * (1.0 - gum) + gum * GUM) + matter[:, 1:2] * GUM + matter[:, 2:3] * TONGUE
    behind = np.clip((mesh.attributes["POSITION"][:, 2] - model.parts["teeth_upper"].attributes["POSITION"][:, 2].min())
                     / 0.045, 0.0, 1.0)  # fmt: skip
    return np.clip(_BEHIND_LIPS * mixed * (0.25 + 0.75 * behind[:, None]), 0.0, 1.0).astype(np.float32)


def _eyes(model: HeadModel) -> list[FacePart]:
    parts = []
    for side in SIDES:
        mesh = model.parts[f"eye_{side}"]
        places = (mesh.attributes["POSITION"] - model.eye_centre(side)).astype(np.float32)
        still = places, vertex_normals(places, mesh.triangles).astype(np.float32)
        flat = places / np.float32(model.eyes.radius)
        # what is behind the equator has the colour of the equator
        reach = np.linalg.norm(flat[:, :2], axis=1, keepdims=True)
        flat = np.where((flat[:, 2:] < 0.0) & (reach > 0.0), flat[:, :2] / np.maximum(reach, 1e-6), flat[:, :2])
        uv = (0.5 + 0.5 * EYE_INSET * flat).astype(np.float32)
        rides: Rides = "eye_l" if side == SIDES[0] else "eye_r"
        shade = _eye_light(places / np.float32(model.eyes.radius))
        parts.append(FacePart(rides, "eye", rides, mesh.triangles, _still(still), uv, shade))
    return parts


def _eye_light(places: Floats) -> Floats:
    """``(N, 3)``: how much light lids and lashes leave to an eye that looks ahead, ``places`` in its radii."""
    aside = smoothstep(0.35, 0.95, np.hypot(places[:, 0], 0.8 * places[:, 1]))
    above = smoothstep(0.05, 0.55, places[:, 1])
    light = (1.0 - _ASIDE_SHADE * aside) * (1.0 - _LID_SHADE * above)
    return np.repeat(light[:, None], 3, axis=1).astype(np.float32)


def _linings(model: HeadModel) -> list[FacePart]:
    parts = []
    for side, mesh in zip(SIDES, eye_linings(model), strict=True):
        colours = np.tile(np.float32(0.7) * np.array(GUM, np.float32), (len(mesh.vertices), 1))
        parts.append(
            FacePart(
                f"lining_{side}", "flesh", "head", mesh.triangles, _riding(model, mesh, turning=True), colours=colours
            )
        )
    return parts


def _small_hairs(model: HeadModel, look: Look) -> list[FacePart]:
    chance = irregularities(model, look)
    return [
        FacePart(
            name, "hair", "head", hair_triangles(hairs), _on_skin(hairs), colours=hair_colours(hairs, under),
            turning=False,
        )
        for name, hairs, under in (("brows", chance.brows, look.skin.tone), ("lashes", chance.lashes, _SHADED_EYE))
        if len(hairs)
    ]  # fmt: skip


def _on_skin(hairs: Hairs) -> Callable[[FaceGeometry], PlacesAndNormals]:
    return lambda geometry: hair_strips(hairs, geometry.vertices, geometry.normals)


def _head_hair(model: HeadModel, grown: GrownHair) -> list[FacePart]:
    cap, centre = grown.cap(), grown.centre
    stays = np.asarray(1.0 - neck.shares(model), np.float32)
    parts = [
        FacePart(
            "scalp", "scalp", "skin", cap.triangles, _riding(model, cap), uv=cap_places(cap.vertices, centre),
            stays=np.asarray(stays[cap.anchors].mean(axis=1), np.float32),
        )
    ]  # fmt: skip
    strands = strand_mesh(grown.strands(_STRANDS), model.vertices, centre)
    hold, facing = strands.anchors, strands.normals
    parts.append(
        FacePart(
            "hair", "hair", "skin", strands.triangles, lambda g: (g.vertices[hold] + strands.offsets, facing),
            colours=strands.colours, stays=np.asarray(stays[hold], np.float32),
        )
    )  # fmt: skip
    for number, layer in enumerate(grown.layers):
        mesh = sheets_mesh(layer)
        place, outward, sheet = (mesh.fields[name] for name in ("place", "facing", "sheet"))
        light = np.repeat(np.clip(sheet[:, 2:3], 0.0, 1.0), 3, axis=1)
        parts.append(
            FacePart(
                f"hair_sheet_{number}", "hair_sheet", "head", mesh.triangles, _still((place, outward)),
                sheet_places(sheet), light,
            )
        )  # fmt: skip
    return parts


def cap_places(vertices: Floats, centre: Doubles) -> Floats:
    """``(N, 2)`` texture coordinates of the scalp: the directions from the head's centre, about the crown."""
    away = vertices.astype(np.float64) - centre
    axis = _CAP_AXIS / np.linalg.norm(_CAP_AXIS)
    up = np.cross(axis, [1.0, 0.0, 0.0])
    flat = np.stack([away[:, 0], away @ up], axis=1)
    sideways = np.linalg.norm(flat, axis=1)
    angle = np.arctan2(sideways, away @ axis)
    radius = 0.5 * np.minimum(np.sin(0.5 * angle) / np.sin(0.5 * _CAP_REACH), 1.0)
    return (0.5 + (radius / np.maximum(sideways, 1e-9))[:, None] * flat).astype(np.float32)


def _shirt(model: HeadModel) -> FacePart:
    vertices, triangles, _ = shirt(model)
    still = vertices, vertex_normals(vertices, triangles).astype(np.float32)
    return FacePart("shirt", "cloth", "body", triangles, lambda _: still)


def _riding(model: HeadModel, mesh: Anchored, *, turning: bool = False) -> Callable[[FaceGeometry], PlacesAndNormals]:
    """``turning``: its normals follow its shape; else they stay."""
    offsets = (mesh.vertices - model.vertices[mesh.anchors].mean(1)).astype(np.float32)

    def at(geometry: FaceGeometry) -> PlacesAndNormals:
        places = geometry.vertices[mesh.anchors].mean(1) + offsets
        return _with_normals(places, mesh.triangles) if turning else (places, mesh.normals.astype(np.float32))

    return at


def _still(there: PlacesAndNormals) -> Callable[[FaceGeometry], PlacesAndNormals]:
    return lambda _: there


def _moved(turn: Floats, places: Floats) -> Floats:
    return np.asarray(places @ turn[:3, :3].T + turn[:3, 3], np.float32)


def _with_normals(places: Floats, triangles: Indices) -> PlacesAndNormals:
    return places, vertex_normals(places, triangles).astype(np.float32)
