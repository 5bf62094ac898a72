"""All that a portrait of a face is drawn from, without OpenGL: for whoever draws it with the shaders elsewhere."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import SIDES
from agentface.deform.finish import chest
from agentface.head.look import Look
from agentface.head.model import HeadModel
from agentface.head.skin_image import skin_image
from agentface.view.camera import VIEWS, named_view
from agentface.view.dressing import (
    SOFTNESSES,
    dressed_skin,
    fine_lips,
    grown_hair,
    irregularities,
    pores,
)
from agentface.view.gl.drawn_mesh import DrawnMesh
from agentface.view.gl.programs import SHADERS, colours
from agentface.view.gl.quality import QUALITIES
from agentface.view.gl.source import embedded, read_source
from agentface.view.gl.uniforms import light_rows, shadow_projection, unit
from agentface.view.hair.cap import solid_first
from agentface.view.hair.grown import GrownHair
from agentface.view.hair.head_hair import NARROWEST, STREAKS
from agentface.view.hair.sheet_array import hanging_first
from agentface.view.hair.sheets import sheets_mesh
from agentface.view.hair.strands import LIFT
from agentface.view.parts.anchored import eye_linings
from agentface.view.parts.mouth import PARTS, SHADED, MouthOpening, mouth_mesh
from agentface.view.parts.rigid import IRIS_RADIUS, eyeball_mesh, lid_margins
from agentface.view.parts.shirt import shirt_mesh
from agentface.view.skin.meshes import SkinMeshes
from agentface.view.skin.wrinkle_atlas import atlas_height, atlas_patches
from agentface.view.skin.wrinkle_patches import SIDE

_QUALITY = "portrait"
_LONGEST = 2.0**-8
"""Metres of the edges that are cut and curved: what a portrait of some 1400 pixels of height takes."""
_WHITE = "#version 300 es\nprecision highp float;\nout vec4 colour;\nvoid main() { colour = vec4(1.0); }\n"
"""WebGL refuses a shader that leaves a framebuffer's colour alone."""
_UNSEEN = "copy"
"""What of the programs only this package's own framebuffers need."""


def portrait(model: HeadModel, look: Look) -> dict[str, Any]:
    """A portrait as plain values, arrays, and records of these; a mesh is its ``fields`` and ``triangles``.

    ``programs`` has the shaders in GLSL ES 3.00, ``uniforms`` what is set in all of them, ``skin`` its fields by the
    vertices that ``ends`` lie between, those of the fine lips behind the others, ``atlas`` the patches of wrinkles.
    """
    chance, grown = irregularities(model, look), grown_hair(model, look)
    picture = skin_image(look)
    towards, lit = light_rows(look.lights)
    return {
        "views": {name: _view(model, name) for name in VIEWS},
        "programs": programs(textured=picture is not None),
        "uniforms": {
            **colours(look),
            "atlas_height": atlas_height(model),
            "iris_radius": IRIS_RADIUS,
            "gloss": grown.gloss if grown is not None else 0.0,
        },
        "lights": {
            "direction": towards,
            "colour": lit,
            "sky": look.lights.sky,
            "ground": look.lights.ground,
            "shadow": shadow_projection(look.lights).astype(np.float32),
        },
        "noise": chance.noise,
        "pores": pores(),
        "picture": picture,
        "skin": _skin(model, look, grown),
        "lips": fine_lips(model).record(),
        "atlas": _atlas(model, look, chance.grain),
        "mouth": MouthOpening(model).record() | {"shaded": SHADED},
        "eyes": [_eye(model, side) for side in SIDES],
        "parts": {name: _mesh(mouth_mesh(model, name)) for name in PARTS},
        "linings": [_mesh(lining.drawn(model.vertices)) for lining in eye_linings(model)],
        "shirt": _mesh(shirt_mesh(model)) | {"breathing": chest.prepare(model).filled},
        "brows": _mesh(chance.brows.drawn()) | {"gloss": SOFTNESSES[0]},
        "lashes": _mesh(chance.lashes.drawn()) | {"gloss": SOFTNESSES[1]},
        "hair": None if grown is None else _hair(model, grown),
    }


def programs(*, textured: bool) -> dict[str, dict[str, str]]:
    """The ``vertex`` and ``fragment`` shaders of each program in GLSL ES 3.00; ``textured``: skin wears a picture."""
    worn: tuple[str, ...] = ("TEXTURED",) if textured else ()
    skin = QUALITIES[_QUALITY].skin
    plain: tuple[str, ...] = ()
    shaders = {name: (*files, plain) for name, files in SHADERS.items() if name != _UNSEEN}
    shaders |= {"skin": (skin, skin, worn), "skin-wrinkled": (skin, skin, (*worn, "WRINKLED"))}
    made = {
        name: {
            "vertex": embedded(read_source(f"{vertex}.vert.glsl", defines=defines)),
            "fragment": embedded(read_source(f"{fragment}.frag.glsl", defines=defines)),
        }
        for name, (vertex, fragment, defines) in shaders.items()
    }
    return made | {"depth": {"vertex": embedded(read_source("depth.vert.glsl")), "fragment": _WHITE}}


def _mesh(mesh: DrawnMesh) -> dict[str, Any]:
    return {"fields": mesh.fields, "triangles": mesh.triangles}


def _view(model: HeadModel, name: str) -> dict[str, Any]:
    camera = named_view(model, name)
    return {"eye": camera.eye, "target": camera.target, "field_of_view": camera.field_of_view}


def _skin(model: HeadModel, look: Look, grown: GrownHair | None) -> dict[str, Any]:
    meshes = SkinMeshes(model, fine_lips(model), dressed_skin(model, look, grown))
    refined = meshes.refined(_LONGEST)
    return {"fields": meshes.extended, "ends": refined.ends, "triangles": refined.triangles}


def _atlas(model: HeadModel, look: Look, grain: Any) -> dict[str, Any]:
    towards = unit(look.lights.key.towards)
    patches = [
        {
            "row": patch.rows.start,
            "column": patch.columns.start,
            "heights": patch.heights,
            "relief": patch.texels(towards).astype(np.int8),
        }
        for patch in atlas_patches(model)
    ]
    return {"side": SIDE, "grain": grain.astype(np.int8), "patches": patches}


def _eye(model: HeadModel, side: str) -> dict[str, Any]:
    upper, lower = lid_margins(model, side)
    return _mesh(eyeball_mesh(model, side)) | {
        "centre": model.eye_centre(side),
        "radius": float(model.eyes.radius),
        "upper": upper,
        "lower": lower,
    }


def _hair(model: HeadModel, grown: GrownHair) -> dict[str, Any]:
    cap, solid = solid_first(grown.cap())
    strands = grown.strands(_QUALITY)
    made = {
        "centre": grown.centre,
        "cap": _mesh(cap.drawn(model.vertices)) | {"solid": solid, "coils": grown.coils, "parting": grown.parting},
        "strands": _mesh(strands.drawn(model.vertices))
        | {"solid": strands.solid, "lift": LIFT, "narrowest": NARROWEST[_QUALITY], "streaks": STREAKS[_QUALITY]},
        "sheets": None,
    }
    if grown.sheets:
        mesh = sheets_mesh(grown.sheets)
        ordered, hanging = hanging_first(mesh, mesh.triangles, grown.centre)
        made["sheets"] = {"fields": mesh.fields, "triangles": ordered, "hanging": hanging, "least_cover": 0.02}
    return made
