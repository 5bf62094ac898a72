"""Khronos' glTF validator, from npm."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

from tests import tools
from tests.npm import node_modules

VALIDATOR = "2.0.0-dev.3.10"


def issues(*files: Path) -> dict[str, list[str]]:
    """What Khronos' validator finds in each file, down to its hints."""
    tools.require("node")
    environment = os.environ | {"NODE_PATH": str(node_modules("gltf-validator", VALIDATOR))}
    command = ["node", Path(__file__).with_name("validate_glb.js"), *files]
    run = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120, check=False)
    assert run.returncode == 0, run.stderr
    found: dict[str, list[str]] = json.loads(run.stdout)
    assert list(found) == [str(file) for file in files]
    return found
