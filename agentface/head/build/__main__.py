"""``python -m agentface.head.build [FACE]...``: write ``regions/<face>/`` from its ``recipe.yaml``."""

from __future__ import annotations

import tempfile
from pathlib import Path

import click
import numpy as np
import yaml

from agentface.cache import cache_folder
from agentface.config import load
from agentface.head.build.head import METRES, Head, build_head, hinge
from agentface.head.build.head_topology import HeadTopology
from agentface.head.build.identity import Recipe, person
from agentface.head.build.occlusion import ambient_light
from agentface.head.build.parts import PartsFile
from agentface.head.build.source import WHEEL, BaseMesh, fetch
from agentface.mesh.glb import write_glb
from agentface.resources import data_folder

_CREDIT = "CC0 1.0: MakeHuman base mesh hm08 and targets, Face Units by Mika Suominen; changed for agentface"


@click.command()
@click.argument("faces", nargs=-1)
@click.option("--source", type=click.Path(path_type=Path), help="Where the base mesh is, or goes.")
def main(faces: tuple[str, ...], source: Path | None) -> None:
    """Build FACES (all that have a recipe, if none is named) from the CC0 base mesh."""
    mesh = BaseMesh(fetch(source or (cache_folder() or Path(tempfile.gettempdir())) / "source"))
    topology = HeadTopology(mesh)
    parts = load(data_folder("regions") / "anatomy.yaml", PartsFile)
    folders = [data_folder("regions") / face for face in faces]
    for folder in folders or sorted(path.parent for path in data_folder("regions").glob("*/recipe.yaml")):
        recipe = load(folder / "recipe.yaml", Recipe)
        head = build_head(topology, recipe, parts.jaw)
        _bake_light(head, topology)
        write_glb(folder / "head.glb", head.meshes, _CREDIT)
        _write_tables(folder, topology, head, recipe, parts)
        (folder / "PROVENANCE.md").write_text(_provenance(folder, recipe, topology), encoding="utf-8")
        size = (folder / "head.glb").stat().st_size
        click.echo(
            f"{folder.name}: {len(topology.skin.kept)} skin vertices, "
            f"{len(topology.skin.triangles)} triangles, {size} bytes"
        )


def _bake_light(head: Head, topology: HeadTopology) -> None:
    """The light that reaches each vertex of the skin, into the first channel of ``_SHADE``."""
    at = {name: mesh.attributes["POSITION"].astype(np.float64) for name, mesh in head.meshes.items()}
    blockers = [(at[name], head.meshes[name].triangles) for name in ("eye_l", "eye_r")]
    skin = head.meshes["skin"]
    light = ambient_light(at["skin"], skin.triangles, topology.skin.mirror, blockers)
    shade = skin.attributes["_SHADE"].copy()
    shade[:, 0] = np.round(255 * np.clip(light, 0, 1))
    skin.attributes["_SHADE"] = shade


def _write_tables(folder: Path, topology: HeadTopology, head: Head, recipe: Recipe, parts: PartsFile) -> None:
    _dump(
        folder / "regions.yaml",
        "First and last vertex of each region (Bui et al., section 2.1) and sub-region; limits in eye separations.",
        {
            "vertices": len(topology.skin.kept),
            "regions": topology.regions,
            "sub_regions": topology.sub_regions,
            "limits": parts.limits,
        },
    )
    _dump(
        folder / "feature_points.yaml",
        "Named points of the face: the vertices whose mean each is, and its MPEG-4 feature point.",
        {"landmarks": topology.landmarks},
    )
    lip_rings = [topology.halves(ring) for ring in topology.loops.lips]
    _dump(
        folder / "lips.yaml",
        "Rings of vertices round the mouth, from the seam outward; each half from the left corner to the right one; "
        "its muscle.",
        {"rings": [{"upper": upper, "lower": lower} for upper, lower in lip_rings], **parts.lips.model_dump()},
    )
    lids = {
        side: [{"upper": upper, "lower": lower} for upper, lower in topology.lid_rings(side)]
        for side in topology.loops.lids
    }
    _dump(
        folder / "eyelids.yaml",
        "Rings of vertices round each eye, from the lid's inner margin outward; each half from +x to -x; how the lids "
        "move.",
        {"rings": lids, **parts.eyelids.model_dump()},
    )
    _dump(
        folder / "wrinkles.yaml",
        "The trains of wrinkles, relative to the landmarks; lengths in eye separations, one entry a pair.",
        {"trains": {name: row.model_dump() for name, row in parts.wrinkles.items()}},
    )
    _dump(
        folder / "volumes.yaml",
        "Skin and flesh that muscles gather or hollow, relative to the landmarks; lengths in eye separations, one "
        "entry a pair.",
        {"volumes": {name: row.model_dump() for name, row in parts.volumes.items()}},
    )
    centre = [round(float(value), 6) for value in head.eye_centre]
    _dump(
        folder / "eyes.yaml",
        "The left eyeball in metres (the right one is its mirror image) and how far the eyes turn.",
        {"centre": centre, "radius": round(head.eye_radius, 6), **parts.eyes.model_dump()},
    )
    pivot, angle = hinge(person(topology.mesh, recipe), topology.mesh, head.origin)
    _dump(
        folder / "jaw.yaml",
        "The jaw's hinge in metres (its axis is parallel to X) and its widest opening.",
        {
            "pivot": [round(float(METRES * value), 6) for value in pivot],
            "widest_deg": round(float(np.degrees(angle)), 2),
        },
    )


def _dump(path: Path, title: str, content: dict[str, object]) -> None:
    text = yaml.dump(content, Dumper=_Dumper, sort_keys=False, width=118, default_flow_style=None)
    path.write_text(f"# {title}\n# Written by `python -m agentface.head.build`.\n{text}", encoding="utf-8")


class _Dumper(yaml.SafeDumper):
    def ignore_aliases(self, data: object) -> bool:
        return True


def _provenance(folder: Path, recipe: Recipe, topology: HeadTopology) -> str:
    return f"""# Where the face {folder.name} comes from

{recipe.description}

| what | source | licence |
|---|---|---|
| base mesh hm08, targets, symmetry | MakeHuman community, in the Python wheel `{WHEEL}`, folder `mpfb2` | CC0 1.0 |
| the 52 ARKit-named shapes | Face Units by Mika Suominen, same wheel, folder `faceunits01` | CC0 1.0 |
| single teeth, gums, eyeballs | made by `agentface.head.build` | MIT |

Nothing else of the wheel is read. Made again, byte for byte, by

    python -m agentface.head.build {folder.name}

from the recipe in `recipe.yaml` beside this file:

```yaml
{(folder / "recipe.yaml").read_text(encoding="utf-8").strip()}
```

Steps: mix the targets of the recipe; make the head symmetric; move the lips together until they touch; subdivide
forehead, glabella, crow's feet and cheeks (Catmull-Clark, up to twice); thin out ears, mouth bag, skull and neck; order
the vertices by region. The skin has {len(topology.skin.kept)} vertices and {len(topology.skin.triangles)} triangles.
The 52 shapes are made symmetric and kept as sparse morph targets.
"""


if __name__ == "__main__":
    main()
