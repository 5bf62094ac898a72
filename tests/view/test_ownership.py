"""What a renderer takes from the driver goes back with it, and programs with OpenGL of their own keep theirs."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
import textwrap
import threading

import moderngl
import numpy as np
import pytest

from agentface.deform.geometry import FaceGeometry
from agentface.errors import GraphicsError
from agentface.head.look import load_look
from agentface.view.gl.context import open_context
from agentface.view.gl.current import Current, current_context, make_current
from agentface.view.gl.ownership import TrackedContext
from agentface.view.renderer import Renderer
from agentface.view.skin.template import skin_template
from tests import tools
from tests.heads import head_model

pytestmark = pytest.mark.gl

SIZE = (64, 48)
FACES = [6, pytest.param(100, marks=pytest.mark.soak)]  # each took 41 MB before anything went back
SIZES = [30, pytest.param(200, marks=pytest.mark.soak)]
MOST_MB = 30


def program(text: str, *before: str, **environment: str) -> str:
    """What a program prints in an interpreter of its own, in which warnings are errors."""
    run = subprocess.run(
        [*before, sys.executable, "-W", "error", "-c", textwrap.dedent(text)],
        env=os.environ | environment, capture_output=True, text=True, timeout=280, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    return run.stdout


def at_rest(model):
    return FaceGeometry.at_rest(model)


@pytest.fixture
def nothing_current():
    before = current_context()
    make_current(None)
    yield
    make_current(before)


MEMORY = """
import gc
from agentface import Face
def mb(): return int(open("/proc/self/statm").read().split()[1]) * 4096 / 1e6
"""


@pytest.mark.slow
@pytest.mark.untraced
@pytest.mark.parametrize("faces", FACES)
@pytest.mark.parametrize("ending", ["del face", "face.close()"])
def test_faces_made_drawn_and_dropped_leave_no_memory_behind(ending, faces):
    grown = program(
        MEMORY
        + textwrap.dedent(f"""
        for number in range({faces}):
            face = Face(compiled=False)
            face.render((320, 240), quality="portrait" if number % 4 == 0 else "fast")
            {ending}
            gc.collect()
            if number == 1:
                began = mb()
        print(mb() - began)
        """)
    )
    assert float(grown) < MOST_MB


@pytest.mark.slow
@pytest.mark.untraced
@pytest.mark.parametrize("sizes", SIZES)
@pytest.mark.parametrize(("quality", "size"), [("fast", (1280, 720)), ("portrait", (400, 300))])
def test_pictures_of_many_sizes_leave_no_memory_behind(quality, size, sizes):
    grown = program(
        MEMORY
        + textwrap.dedent(f"""
        face = Face(compiled=False)
        for more in (100, 0):  # near and far, a portrait's skin is cut differently
            face.render(({size[0]} + more, {size[1]} + more), quality={quality!r})
        began = mb()
        for number in range({sizes}):
            face.render(({size[0]} + 2 * (number % 40), {size[1]} + number % 40), quality={quality!r})
        face.render({size}, quality={quality!r})
        print(mb() - began)
        """),
        # without it glibc keeps tens of megabytes of large blocks that were freed, for the next ones; the driver,
        # too, holds a picture or two of those before, which of large portraits are 40 MB each
        MALLOC_MMAP_THRESHOLD_="1000000",
    )
    assert float(grown) < MOST_MB


def test_a_closed_renderer_gives_its_context_back_and_draws_no_more():
    model = head_model("amber")
    with Renderer(model) as renderer:
        assert renderer.render(at_rest(model), SIZE).any()
    for _ in range(2):
        renderer.close()
    with pytest.raises(GraphicsError, match="one that was closed"):
        renderer.render(at_rest(model), SIZE)
    assert isinstance(renderer.context.mglo, moderngl.InvalidObject)


def test_a_dropped_renderer_gives_its_context_back():
    model = head_model("amber")
    renderer = Renderer(model)
    renderer.itself = renderer  # a circle, as programs have them
    context = renderer.context
    del renderer
    gc.collect()
    assert isinstance(context.mglo, moderngl.InvalidObject)


def test_a_renderer_that_cannot_be_made_keeps_nothing(monkeypatch):
    opened = []
    monkeypatch.setattr("agentface.view.gl.ownership.open_context", lambda: opened.append(open_context()) or opened[-1])
    monkeypatch.setattr("agentface.view.renderer.Mouth", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        Renderer(head_model("amber"))
    gc.collect()
    assert isinstance(opened[0].mglo, moderngl.InvalidObject)


@pytest.mark.parametrize("closed", [True, False])
def test_a_given_context_stays_and_what_was_made_in_it_goes(closed, monkeypatch):
    made = []
    monkeypatch.setattr(TrackedContext, "__init__", spy(TrackedContext.__init__, made))
    model, context = head_model("amber"), open_context()
    mine = context.buffer(b"mine")
    renderer = Renderer(model, context=context)
    picture = renderer.render(at_rest(model), SIZE, quality="portrait")
    taken = [item for item in made[0]._made if not isinstance(item.mglo, moderngl.InvalidObject)]
    assert len(taken) > 50
    if closed:
        renderer.close()
        assert all(isinstance(item.mglo, moderngl.InvalidObject) for item in taken)
    else:
        del renderer
        gc.collect()
        assert len(context.objects) == len(taken)
        context.__enter__()
        assert context.gc() == len(taken)
    assert mine.read() == b"mine"
    with Renderer(model, context=context) as again:
        np.testing.assert_array_equal(again.render(at_rest(model), SIZE, quality="portrait"), picture)
    assert context.error == "GL_NO_ERROR"
    context.release()


def spy(init, made):
    def noted(self, context):
        init(self, context)
        made.append(self)

    return noted


def test_a_recorder_forgets_what_was_given_back(monkeypatch):
    monkeypatch.setattr("agentface.view.gl.ownership._MANY", 8)
    context = open_context()
    recorder = TrackedContext(context)
    kept = recorder.buffer(reserve=4)
    for _ in range(100):
        recorder.buffer(reserve=4).release()
    made = recorder.made()
    assert kept in made
    assert len(made) <= 16
    recorder.point_size = 3.0
    assert context.point_size == 3.0
    context.release()


def test_another_context_stays_current_with_its_state(nothing_current):
    model = head_model("amber")
    renderer = Renderer(model)
    assert current_context() is None
    mine = moderngl.create_context(standalone=True, backend="egl", require=330)
    target = mine.framebuffer([mine.texture((4, 4), 4)])
    target.use()
    mine.viewport = (0, 0, 3, 2)
    mine.enable_only(moderngl.BLEND)
    before = current_context()
    assert before is not None
    renderer.render(at_rest(model), SIZE)
    Renderer(model).render(at_rest(model), SIZE)
    skin_template(model, load_look(model), 64)
    renderer.close()
    assert current_context() == before
    assert mine.fbo is target
    assert mine.viewport == (0, 0, 3, 2)
    mine.clear(1.0, 0.5, 0.0, 1.0)
    assert target.read(components=4, viewport=(1, 1, 1, 1)) == b"\xff\x80\x00\xff"
    assert mine.error == "GL_NO_ERROR"
    mine.release()


def test_no_context_is_left_current_where_there_was_none(nothing_current):
    model = head_model("amber")
    with Renderer(model) as renderer:
        assert current_context() is None
        renderer.render(at_rest(model), SIZE)
        assert current_context() is None
        with renderer.current():
            inside = current_context()
            assert inside is not None
            renderer.render(at_rest(model), SIZE)
            assert current_context() == inside
        assert current_context() is None
        with pytest.raises(Exception, match="size"):
            renderer.render(at_rest(model), (0, 0))
        assert current_context() is None
    assert current_context() is None


def test_the_program_s_default_context_and_api_stay(nothing_current):
    import ctypes

    egl, gles = ctypes.CDLL("libEGL.so.1"), 0x30A0
    before = egl.eglQueryAPI()
    assert egl.eglBindAPI(gles)
    mine = moderngl.create_context(standalone=True, backend="egl", require=330)
    assert egl.eglBindAPI(gles)
    assert moderngl.get_context() is mine
    with Renderer(head_model("amber")):
        assert moderngl.get_context() is mine
        assert egl.eglQueryAPI() == gles
    egl.eglBindAPI(before)
    mine.release()


GLX = """
import sys
sys.modules["imgui_bundle"] = None
import ctypes, glfw, moderngl
from agentface import Face
from agentface.view.gl.current import current_context

glfw.init()
for hint, value in ((glfw.CONTEXT_VERSION_MAJOR, 3), (glfw.CONTEXT_VERSION_MINOR, 3),
                    (glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE), (glfw.VISIBLE, False)):
    glfw.window_hint(hint, value)
window = glfw.create_window(64, 48, "mine", None, None)
face = Face(compiled=False)
alone = face.render((64, 48))
assert current_context() is None
glfw.make_context_current(window)
before = current_context()
assert before.api == "glx", before
mine = moderngl.create_context(require=330)
screen = mine.detect_framebuffer()
for drawn in (face, Face(compiled=False)):
    assert (drawn.render((64, 48)) == alone).all()
    assert current_context() == before
screen.clear(1.0, 0.0, 0.0, 1.0)
assert mine.error == "GL_NO_ERROR"
assert screen.read(components=3, viewport=(5, 5, 1, 1)) == bytes((255, 0, 0))
print("undisturbed")
"""


def test_a_window_of_another_library_stays_current():
    tools.require("xvfb-run", "xauth")
    assert "undisturbed" in program(GLX, "xvfb-run", "--auto-servernum", DISPLAY="")


def test_any_thread_draws_in_its_turn():
    model = head_model("amber")
    with Renderer(model) as renderer:
        first = renderer.render(at_rest(model), SIZE)
        seen = []
        thread = threading.Thread(target=lambda: seen.append(renderer.render(at_rest(model), SIZE)))
        thread.start()
        thread.join()
        np.testing.assert_array_equal(seen[0], first)
        np.testing.assert_array_equal(renderer.render(at_rest(model), SIZE), first)


def test_two_threads_at_once_are_an_error():
    model = head_model("amber")
    errors = []

    def draw(renderer):
        try:
            renderer.render(at_rest(model), SIZE)
        except GraphicsError as error:
            errors.append(str(error))
        errors.append(current_context())

    with Renderer(model) as renderer:
        first = renderer.render(at_rest(model), SIZE)
        with renderer.current():
            thread = threading.Thread(target=draw, args=(renderer,))
            thread.start()
            thread.join()
        assert "one thread" in errors[0]
        assert errors[1] is None
        np.testing.assert_array_equal(renderer.render(at_rest(model), SIZE), first)


FORK = """
import gc, multiprocessing, os, sys
from agentface import Face
from agentface.errors import GraphicsError

def draw(face):
    try:
        (face or Face(compiled=False)).render((64, 48))
    except GraphicsError as error:
        return str(error)

if __name__ == "__main__":
    face = Face(compiled=False)
    face.render((64, 48))
    with multiprocessing.get_context("fork").Pool(1) as pool:
        print(pool.map_async(draw, [None]).get(timeout=240)[0])
    child = os.fork()
    if child == 0:
        said = draw(face)
        del face
        gc.collect()
        sys.exit(0 if "forked" in said else 1)
    assert os.waitpid(child, 0)[1] == 0
    print("parent", face.render((64, 48)).shape)
"""


def test_a_forked_child_gets_an_error_and_its_parent_draws_on():
    environment = {"PYTHONWARNINGS": "ignore"}  # of forking with threads, which is what is tried
    run = subprocess.run(
        [sys.executable, "-c", FORK],
        env=os.environ | environment,
        capture_output=True,
        text=True,
        timeout=240,
        check=False,
    )
    assert run.returncode == 0, run.stderr
    said, parent = run.stdout.splitlines()
    assert "got a child forked from one that had drawn already" in said
    assert 'get_context("spawn")' in said
    assert parent == "parent (48, 64, 3)"


def test_children_of_a_parent_that_has_not_drawn_draw():
    drawn = program("""
        import multiprocessing, warnings
        warnings.simplefilter("ignore")
        from agentface import Face
        def draw(_): return Face(compiled=False).render((64, 48)).shape
        if __name__ == "__main__":
            Face(compiled=False)
            with multiprocessing.get_context("fork").Pool(2) as pool:
                print(pool.map_async(draw, [1, 2]).get(timeout=240))
    """)
    assert drawn.strip() == "[(48, 64, 3), (48, 64, 3)]"


def test_a_context_is_named_by_what_it_is():
    context = open_context()
    seen = current_context()
    assert isinstance(seen, Current)
    assert (seen.api, seen.draw, seen.read) == ("egl", None, None)
    make_current(None)
    assert current_context() is None
    make_current(seen)
    assert current_context() == seen
    make_current(None)
    context.release()
