"""A face as a VRM 1.0 avatar.

Source: VRM Consortium, VRMC_vrm-1.0 (https://github.com/vrm-c/vrm-specification).
"""

from __future__ import annotations

from collections.abc import Mapping
from importlib.metadata import version
from typing import Any

from agentface.deform.geometry import FaceGeometry
from agentface.deform.protocol import Deformer
from agentface.head.look import Look
from agentface.head.model import HeadModel
from agentface.head.provenance import read_provenance
from agentface.io.gltf.face_glb import GlbFace, part_figures
from agentface.io.gltf.face_parts import face_parts
from agentface.io.gltf.figure import Figure, Joints
from agentface.io.gltf.materials import add_materials
from agentface.io.gltf.writer import GltfWriter
from agentface.io.picture import encode
from agentface.io.vrm.expressions import BakedExpression, ExpressionBaker, Told
from agentface.io.vrm.licence import meta_of
from agentface.io.vrm.skeleton import EYE_BONES, add_bones
from agentface.view.renderer import Renderer

EXTENSION = "VRMC_vrm"
_THUMBNAIL = 512


def encode_avatar(model: HeadModel, look: Look, deformer: Deformer, told: Told = lambda _: None) -> GlbFace:
    """The avatar of a face; ``told`` gets how many expressions are done.

    Raises GraphicsError when there is no OpenGL, which paints its pictures.
    """
    parts = face_parts(model, look)
    expressions = ExpressionBaker(model, deformer, parts).baked(told)
    provenance = read_provenance(model.folder)
    writer = GltfWriter(provenance.copyright_line)
    joints, bones = add_bones(writer, model)
    figure = Figure(writer, model, joints)
    materials = add_materials(writer, model, look, parts)
    binds: dict[str, list[dict[str, Any]]] = {name: [] for name in expressions}
    for part in parts:
        own = [name for name, expression in expressions.items() if part.name in expression.targets]
        targets = {name: expressions[name].targets[part.name] for name in own}
        node = figure.add(part, materials[part.material], targets)
        for index, name in enumerate(own):
            binds[name].append({"node": node, "index": index, "weight": 1.0})
    thumbnail = writer.image("thumbnail", encode(_portrait(model, look), "x.jpg"), "image/jpeg")
    writer.use(EXTENSION)
    writer.document["extensions"] = {
        EXTENSION: {
            "specVersion": "1.0",
            "meta": meta_of(model.name, version("agentface"), provenance, thumbnail),
            "humanoid": {"humanBones": {name: {"node": node} for name, node in bones.items()}},
            "lookAt": _look_at(model, joints),
            "expressions": _expressions(expressions, binds),
        }
    }
    content = writer.content()
    figures = {
        "face": model.name,
        "bytes": len(content),
        "shapes": list(expressions),
        "overrides": {name: list(one.overrides) for name, one in expressions.items() if one.overrides},
        "bones": list(bones),
        "licences": list(provenance.licences),
        "meshes": part_figures(model, parts),
    }
    return GlbFace(content, figures)


def _expressions(
    expressions: Mapping[str, BakedExpression], binds: Mapping[str, list[dict[str, Any]]]
) -> dict[str, dict[str, Any]]:
    found: dict[str, dict[str, Any]] = {"preset": {}, "custom": {}}
    for name, expression in expressions.items():
        held = {f"override{what.capitalize()}": "blend" for what in expression.overrides}
        row = {"isBinary": False, **held, **({"morphTargetBinds": binds[name]} if binds[name] else {})}
        found["custom" if expression.custom else "preset"][name] = row
    return found


def _look_at(model: HeadModel, joints: Joints) -> dict[str, Any]:
    """Bones turn as far as the eyes look, and no farther than their holes let them."""
    middle = 0.5 * sum(joints.at[eye] for eye in EYE_BONES) - joints.at["head"]
    across, along = (
        {"inputMaxValue": limit, "outputScale": limit}
        for limit in (model.eyes.yaw_limit_deg, model.eyes.pitch_limit_deg)
    )
    return {
        "type": "bone",
        "offsetFromHeadBone": [round(float(value), 6) for value in middle],
        "rangeMapHorizontalInner": across,
        "rangeMapHorizontalOuter": across,
        "rangeMapVerticalDown": along,
        "rangeMapVerticalUp": along,
    }


def _portrait(model: HeadModel, look: Look) -> Any:
    with Renderer(model, look) as renderer:
        return renderer.render(FaceGeometry.at_rest(model), (_THUMBNAIL, _THUMBNAIL), "front", "portrait")
