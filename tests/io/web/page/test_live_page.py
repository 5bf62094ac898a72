"""The page with a live face, in a browser."""

from __future__ import annotations

import pytest

SHOWN = """
() => {
  const element = document.querySelector('agent-face'), { face } = element;
  return face && element.drawn > 2 && { frame: face.shown.frame, vertices: Array.from(face.skin.vertices), normals: Array.from(face.skin.normals) };
}
"""


@pytest.mark.slow
def test_x(tab, served):
    import time
    t=time.time()
    tab.goto(served.server.url)
    tab.wait_for_function("document.querySelector('agent-face')?.drawn > 2")
    print("first", time.time()-t)
    print(tab.evaluate("document.querySelector('agent-face').hello.face"))
    print(tab.evaluate("document.querySelector('agent-face').status()"))
    tab.screenshot(path="/tmp/wp/live.png")
