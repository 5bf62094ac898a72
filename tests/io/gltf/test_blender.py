"""Debian's Blender opens what is exported."""

from __future__ import annotations

import json
import subprocess

import pytest

from agentface.head.arkit import ARKIT_SHAPES
from tests import tools

# Debian's importer was written for a numpy that had these names
PROGRAM = """
import json, sys, numpy
for name, kind in (("bool", bool), ("float", float), ("int", int), ("object", object)):
    if name not in numpy.__dict__:
        setattr(numpy, name, kind)
import bpy
found = {}
for path in sys.argv[sys.argv.index("--") + 1:]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=path)
    # an animation's armature takes names, too
    (skin,) = [o for o in bpy.data.objects if o.type == "MESH" and o.data.name.partition(".")[0] == "skin"]
    keys = [key.name for key in skin.data.shape_keys.key_blocks] if skin.data.shape_keys else []
    curves = max((len(action.fcurves) for action in bpy.data.actions), default=0)
    found[path] = {"vertices": len(skin.data.vertices), "keys": keys, "actions": len(bpy.data.actions),
                   "curves": curves, "meshes": sorted(o.name for o in bpy.data.objects if o.type == "MESH")}
print("FOUND" + json.dumps(found))
"""


@pytest.mark.gl
@pytest.mark.soak
def test_blender_has_the_shapes_and_the_animation(arkit_file, played_file, model, tmp_path):
    tools.require("blender")
    program = tmp_path / "look.py"
    program.write_text(PROGRAM)
    command = ["blender", "-b", "--factory-startup", "--python", program, "--", arkit_file.path, played_file.path]
    run = subprocess.run(command, capture_output=True, text=True, timeout=1200, check=False)
    line = next((line for line in run.stdout.splitlines() if line.startswith("FOUND")), None)
    assert line is not None, run.stdout + run.stderr
    still, moving = json.loads(line.removeprefix("FOUND")).values()
    assert still["keys"] == ["Basis", *ARKIT_SHAPES]
    assert {"teeth_lower", "tongue", "eye_l", "eye_r", "hair_sheet_0"} <= set(still["meshes"])
    # vertices that no triangle has are left out
    assert 0.5 * len(model.vertices) < still["vertices"] <= len(model.vertices)
    assert moving["keys"] == ["Basis", *played_file.made.figures["shapes"]]
    assert moving["actions"] >= 1
    assert moving["curves"] >= len(played_file.made.figures["shapes"])
