from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from playwright.sync_api import Browser, ConsoleMessage, Page, sync_playwright

from tests.io.web.page.files import Files, serve_files
from tests.io.web.page.served import Served, serving
from tests.tools import require, require_page

_FLAGS = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--no-first-run",
    "--autoplay-policy=no-user-gesture-required",
)
SIZE = 240, 300
"""Of pictures that are compared."""
_SMALL = 120, 150


@pytest.fixture(scope="session")
def chromium() -> Iterator[Browser]:
    """Debian's Chromium, without a window and without a graphics card."""
    require("chromium")
    require_page()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=list(_FLAGS))
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def served() -> Iterator[Served]:
    """A live face for pages."""
    with serving() as there:
        yield there


@pytest.fixture(scope="session")
def files(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Files]:
    """A web server of files: the built page, and what tests add."""
    require_page()
    with serve_files(tmp_path_factory.mktemp("site")) as there:
        yield there


@contextmanager
def opened(chromium: Browser) -> Iterator[Page]:
    """A page of its own; what it throws, or WebGL says against it, fails the test."""
    context = chromium.new_context(viewport={"width": _SMALL[0], "height": _SMALL[1]})
    page = context.new_page()
    page.set_default_timeout(0)  # a busy machine takes its time
    thrown: list[str] = []

    def hear(message: ConsoleMessage) -> None:
        if "GL_INVALID" in message.text or "Shader Error" in message.text:
            thrown.append(message.text)

    page.on("pageerror", lambda error: thrown.append(str(error)))
    page.on("console", hear)
    yield page
    context.close()
    assert thrown == []


@pytest.fixture
def tab(chromium: Browser) -> Iterator[Page]:
    with opened(chromium) as page:
        yield page
