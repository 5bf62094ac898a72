"""Debian's Chromium, driven by playwright: three.js and three-vrm show files that the project has written."""

from __future__ import annotations

from base64 import b64decode
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from agentface.conventions import Doubles
from tests import tools
from tests.npm import node_modules

THREE, THREE_VRM = "0.187.0", "3.5.5"
_FLAGS = [
    "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--no-first-run",
]  # fmt: skip
_ORIGIN = "http://files.test/"
_KINDS = {".js": "text/javascript", ".html": "text/html"}
_PAGE = """<!doctype html><body style="margin:0;background:#333">
<script type="importmap">{"imports": {"three": "/three/build/three.module.js", "three/addons/": "/three/examples/jsm/",
"@pixiv/three-vrm": "/@pixiv/three-vrm/lib/three-vrm.module.js"}}</script>
<script type="module" src="/viewer.js"></script>"""


@contextmanager
def viewer(size: tuple[int, int] = (480, 480)) -> Iterator[Any]:
    """A page whose functions are those of ``tests/viewer.js``; nothing of it comes from a network."""
    tools.require("chromium")
    api = pytest.importorskip("playwright.sync_api")
    modules = node_modules("@pixiv/three-vrm", THREE_VRM, f"three@{THREE}")
    said: list[str] = []
    with api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=_FLAGS)
        page = browser.new_page(viewport={"width": size[0], "height": size[1]})
        page.set_default_timeout(0)  # a busy machine takes its time
        page.on("pageerror", lambda error: said.append(str(error)))
        page.on("console", lambda line: said.append(line.text) if line.type in ("error", "warning") else None)

        def served(route: Any) -> None:
            path = route.request.url.removeprefix(_ORIGIN)
            if not path:
                route.fulfill(body=_PAGE, content_type="text/html")
            elif path == "favicon.ico":
                route.fulfill(status=204)
            elif path.startswith("file/"):
                route.fulfill(path="/" + path.removeprefix("file/"))
            else:
                file = Path(__file__).with_name("viewer.js") if path == "viewer.js" else modules / path
                route.fulfill(path=file, content_type=_KINDS.get(file.suffix, "application/octet-stream"))

        page.route("**/*", served)
        page.goto(_ORIGIN, wait_until="commit")
        page.wait_for_function("window.ready === true")
        page.said = said
        try:
            yield page
        finally:
            browser.close()


def address(path: Path) -> str:
    """Where the page finds a file."""
    return f"{_ORIGIN}file{path}"


def places(page: Any, name: str) -> Doubles:
    """``(N, 3)``: where the page shows the vertices of a mesh."""
    return np.frombuffer(b64decode(page.evaluate("name => places(name)", name))).reshape(-1, 3)
