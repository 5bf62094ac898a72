"""The files of a face's folder that its recipe decides, as bytes: ``head.glb``, the tables, PROVENANCE.md."""

from __future__ import annotations

from typing import Any

import numpy as np
import yaml

from agentface.config import load
from agentface.head.build.feature_points import feature_points
from agentface.head.build.head import METRES, Head, build_head, hinge
from agentface.head.build.head_topology import HeadTopology
from agentface.head.build.identity import Recipe, person
from agentface.head.build.occlusion import ambient_light
from agentface.head.build.parts import PartsFile
from agentface.head.build.source import WHEEL
from agentface.mesh.glb import encode_glb
from agentface.resources import data_folder

_CREDIT = "CC0 1.0: MakeHuman base mesh hm08 and targets, Face Units by Mika Suominen; changed for agentface"
_TITLES = {
    "regions.yaml": "First and last vertex of each region (Bui et al., section 2.1) and sub-region; limits in eye "
    "separations.",
    "feature_points.yaml": "Named points of the face, each the mean of vertices, and the 84 feature points of MPEG-4.",
    "lips.yaml": "Rings of vertices round the mouth, from the seam outward; each half from the left corner to the "
    "right one; its muscle.",
    "eyelids.yaml": "Rings of vertices round each eye, from the lid's inner margin outward; each half from +x to -x; "
    "how the lids move.",
    "wrinkles.yaml": "The trains of wrinkles, relative to the landmarks; lengths in eye separations, one entry a pair.",
    "volumes.yaml": "Skin and flesh that muscles gather or hollow, relative to the landmarks; lengths in eye "
    "separations, one entry a pair.",
    "morphs.yaml": "What moves the skin by a shape: the artists', ellipsoids, the ear's way; lengths in eye "
    "separations, the left side of a pair.",
    "eyes.yaml": "The left eyeball in metres (the right one is its mirror image) and how far the eyes turn.",
    "jaw.yaml": "The jaw's hinge in metres (its axis is parallel to X) and its widest opening.",
}


def face_files(name: str, recipe: Recipe, recipe_text: str, topology: HeadTopology) -> dict[str, bytes]:
    """What the face ``name`` is made of, by file name; the same recipe gives the same bytes.

    ``recipe_text`` is the recipe as it was written, for PROVENANCE.md. Muscles, asymmetry and look are not decided by
    the recipe and are not among the files.
    """
    parts = load(data_folder("regions") / "anatomy.yaml", PartsFile)
    head = build_head(topology, recipe, parts.jaw)
    _bake_light(head, topology)
    tables = _tables(topology, head, recipe, parts)
    return {
        "head.glb": encode_glb(head.meshes, _CREDIT),
        **{file: _yaml(_TITLES[file], content) for file, content in tables.items()},
        "PROVENANCE.md": _provenance(name, recipe, recipe_text, topology).encode(),
    }


def _bake_light(head: Head, topology: HeadTopology) -> None:
    """The light that reaches each vertex of the skin, into the first channel of ``_SHADE``."""
    at = {name: mesh.attributes["POSITION"].astype(np.float64) for name, mesh in head.meshes.items()}
    blockers = [(at[name], head.meshes[name].triangles) for name in ("eye_l", "eye_r")]
    skin = head.meshes["skin"]
    light = ambient_light(at["skin"], skin.triangles, topology.skin.mirror, blockers)
    shade = skin.attributes["_SHADE"].copy()
    shade[:, 0] = np.round(255 * np.clip(light, 0, 1))
    skin.attributes["_SHADE"] = shade


def _tables(topology: HeadTopology, head: Head, recipe: Recipe, parts: PartsFile) -> dict[str, dict[str, Any]]:
    lip_rings = [topology.halves(ring) for ring in topology.loops.lips]
    lids = {
        side: [{"upper": upper, "lower": lower} for upper, lower in topology.lid_rings(side)]
        for side in topology.loops.lids
    }
    centre = [round(float(value), 6) for value in head.eye_centre]
    pivot, angle = hinge(person(topology.mesh, recipe), topology.mesh, head.origin)
    return {
        "regions.yaml": {
            "vertices": len(topology.skin.kept),
            "regions": topology.regions,
            "sub_regions": topology.sub_regions,
            "limits": parts.limits,
        },
        "feature_points.yaml": {"landmarks": topology.landmarks, "feature_points": feature_points(topology)},
        "lips.yaml": {
            "rings": [{"upper": upper, "lower": lower} for upper, lower in lip_rings],
            **parts.lips.model_dump(),
        },
        "eyelids.yaml": {"rings": lids, **parts.eyelids.model_dump()},
        "wrinkles.yaml": {"trains": {name: row.model_dump() for name, row in parts.wrinkles.items()}},
        "volumes.yaml": {"volumes": {name: row.model_dump() for name, row in parts.volumes.items()}},
        "morphs.yaml": {"morphs": {name: row.model_dump(exclude_defaults=True) for name, row in parts.morphs.items()}},
        "eyes.yaml": {"centre": centre, "radius": round(head.eye_radius, 6), **parts.eyes.model_dump()},
        "jaw.yaml": {
            "pivot": [round(float(METRES * value), 6) for value in pivot],
            "widest_deg": round(float(np.degrees(angle)), 2),
        },
    }


def _yaml(title: str, content: dict[str, Any]) -> bytes:
    text = yaml.dump(content, Dumper=_Dumper, sort_keys=False, width=118, default_flow_style=None)
    return f"# {title}\n# Written by `agentface build`.\n{text}".encode()


class _Dumper(yaml.SafeDumper):
    def ignore_aliases(self, data: object) -> bool:
        return True


def _provenance(name: str, recipe: Recipe, recipe_text: str, topology: HeadTopology) -> str:
    return f"""# Where the face {name} comes from

{recipe.description}

| what | source | licence |
|---|---|---|
| base mesh hm08, targets, symmetry | MakeHuman community, in the Python wheel `{WHEEL}`, folder `mpfb2` | CC0 1.0 |
| the 52 ARKit-named shapes | Face Units by Mika Suominen, same wheel, folder `faceunits01` | CC0 1.0 |
| single teeth, gums, eyeballs | made by `agentface build` | MIT |

Nothing else of the wheel is read. Made again, byte for byte, in this folder by

    agentface build recipe.yaml -o .

from the recipe in `recipe.yaml` beside this file:

```yaml
{recipe_text.strip()}
```

Steps: mix the targets of the recipe; make the head symmetric; move the lips together until they touch; subdivide
forehead, glabella, crow's feet and cheeks (Catmull-Clark, up to twice); thin out ears, mouth bag, skull and neck; order
the vertices by region. The skin has {len(topology.skin.kept)} vertices and {len(topology.skin.triangles)} triangles.
The 52 shapes are made symmetric and kept as sparse morph targets.
"""
