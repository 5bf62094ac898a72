"""The face in a scene of somebody's own, with their three.js."""

from __future__ import annotations

import base64
import io

import numpy as np
import pytest
from PIL import Image

from tests.io.web.page.files import exact_frame, settled
from tests.tools import PAGE

pytestmark = [pytest.mark.slow, pytest.mark.untraced]

SCENE = """<!doctype html><title>scene</title>
<script type="importmap">{ "imports": { "three": "./three.module.js" } }</script>
<script type="module">
  import * as THREE from 'three';
  import { Face3D } from './face3d.js';
  window.draw = async (url, frame) => {
    const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    renderer.setPixelRatio(1);
    renderer.setSize(200, 200);
    renderer.setClearColor(0x00ff00);
    const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(30, 1, 0.1, 50);
    camera.position.set(0, 0, 8);
    scene.add(new THREE.HemisphereLight());
    const cube = (x, z) => {
      const red = new THREE.MeshBasicMaterial({ color: 0xff0000 });
      const box = new THREE.Mesh(new THREE.BoxGeometry(0.6, 0.6, 0.6), red);
      box.position.set(x, 0, z);
      scene.add(box);
    };
    cube(-1.2, -2);   // partly behind the face
    cube(0.5, 2);     // before it
    const face = await Face3D.load(url);
    face.show(frame);
    face.scale.setScalar(10);
    face.position.set(0, 0.3, 0);
    face.rotation.y = 0.4;
    scene.add(face);
    renderer.render(scene, camera);
    renderer.render(scene, camera);
    return renderer.domElement.toDataURL();
  };
</script>
"""


def test_it_stands_among_other_things(tab, files):
    modules = PAGE.parent / "node_modules" / "three" / "build"
    for name in ("three.module.js", "three.core.js"):
        files.add(name, (modules / name).read_bytes())
    model, geometry = settled("onyx")[0].model, settled("onyx", "happiness")[1]
    tab.goto(files.add("scene.html", SCENE))
    tab.wait_for_function("typeof window.draw === 'function'")
    made = tab.evaluate("([url, frame]) => draw(url, frame)", [files.head("onyx"), exact_frame(model, geometry)])
    picture = np.asarray(Image.open(io.BytesIO(base64.b64decode(made.partition(",")[2]))).convert("RGB")).astype(int)
    red, green = np.array([255, 0, 0]), np.array([0, 255, 0])
    assert (picture[0, 0] == green).all()
    assert (picture[100, 128] == red).all()  # the box before the face hides it
    hidden = (np.abs(picture - red).max(axis=2) < 3)[:, :100]
    assert 20 < hidden.sum() < 700  # the other is seen in part
    skin = picture[60:80, 90:110].reshape(-1, 3)
    assert (skin[:, 0] > skin[:, 2]).mean() > 0.9
