"""``agentface show``: a face in a window, with a panel beside it where imgui-bundle is installed."""

from __future__ import annotations

import math
import sys
import threading
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from agentface.clock import Clock, SystemClock
from agentface.conventions import Bytes
from agentface.errors import GraphicsError
from agentface.head.look import Look
from agentface.live.background import Background
from agentface.live.loop import Frame, Sink, Source
from agentface.view.gl.context import finish
from agentface.view.gl.quality import QUALITIES, suited_quality
from agentface.view.gl.targets import Targets
from agentface.view.parts.bone import Bone
from agentface.view.renderer import Renderer
from agentface.window.capture import Capture
from agentface.window.controls import Controls
from agentface.window.display import display_watched
from agentface.window.menu import help_text
from agentface.window.times import Times

if TYPE_CHECKING:
    from agentface.face import Face
    from agentface.window.panel.interface import Interface
    from agentface.window.panel.panel import Panel

_LONGEST_STEP_S = 0.1
_SHORTEST_FRAME_S = 1.0 / 90.0
"""Where the screen does not set the pace."""
_IDLE_FRAME_S = 1.0 / 60.0
_AWAKE_S = 1.0
"""After an event the panel is drawn for so long: a hint may appear."""

_NO_GLFW = """expected the Python package glfw, got none.
Install the window's extra:  pip install "agentface[window]"
Pictures and films need no window: see `agentface render --help`."""
_GLFW_DOES_NOT_LOAD = """expected the Python package glfw to load, got: {reason}.
It is installed, but lacks a part of itself or a library of the system; on Debian and Ubuntu libglfw3 brings those.
Pictures and films need no window: see `agentface render --help`."""
_REINSTALL = 'pip install --force-reinstall "agentface[window]"'
_NO_DISPLAY = """expected a display for the window, got: {reason}.
Start it inside a desktop session, set DISPLAY, or use a virtual one:  xvfb-run agentface show
Pictures and films need no display: see `agentface render --help`."""
_NO_PANEL = """The window comes without its panel, as {reason}; the keys do the same, H lists them.
To get the panel:  {advice}"""


class Window:
    """A window that shows ``face`` until it is closed.

    Args:
        face: the face.
        size: width and height in points.
        capture: writes pictures and films; none are written when None.
        look: colours and lights; the face's own when None.
        clock: the time; the machine's when None.
        say: prints the help, and what is amiss.
        quality: ``portrait`` where the driver has a GPU and else ``fast`` when None.

    Raises GraphicsError when glfw is not installed or there is no display.
    """

    def __init__(
        self,
        face: Face,
        size: tuple[int, int] = (1200, 720),
        capture: Capture | None = None,
        look: Look | None = None,
        clock: Clock | None = None,
        say: Callable[[str], object] = print,
        quality: str | None = None,
    ) -> None:
        self._quality = quality
        self.controls, self.clock, self.say = Controls(face, capture), clock or SystemClock(), say
        self.look, self.times = look, Times()
        self._no_panel = _missing_panel()
        self.glfw = _glfw()
        self.handle = self._open(size)
        self._interface: Interface | None = None
        self._panel: Panel | None = None
        self._dragging: int | None = None
        self._last_place = (0.0, 0.0)
        self._targets: Targets | None = None
        self._shown: tuple[Any, ...] = ()
        self._awake_until = 0.0
        self._held = threading.RLock()
        """Kept by whoever uses the face: the loop steps it in another thread."""

    def run(
        self,
        sources: Sequence[Source] = (),
        sinks: Sequence[Sink] = (),
        *,
        duration: float = math.inf,
        stopped: Callable[[], bool] = lambda: False,
        each_frame: Callable[[], object] | None = None,
    ) -> None:
        """Show the face, which ``sources`` tell what to do, until the window is closed; ``sinks`` get each frame.

        It also ends after ``duration`` seconds, and when ``stopped``; ``each_frame`` is called before each frame.
        """
        glfw = self.glfw
        import moderngl

        try:
            glfw.make_context_current(self.handle)
            glfw.swap_interval(1)
            context = moderngl.create_context(require=330)
            screen = context.detect_framebuffer()  # before the renderer binds framebuffers of its own
            self.controls.quality = self._quality or suited_quality(context.info["GL_RENDERER"])
            self._open_panel()
            renderer = Renderer(self.controls.face.model, self.look, context)
            with (
                display_watched(self._display_lost),
                Background(
                    *(self.controls.face, self.clock, sources, self._held),
                    sinks=sinks,
                    duration=duration,
                    longest_step_s=_LONGEST_STEP_S,
                ) as loop,
            ):
                before = self.clock.now()
                while loop.running and not (self._closing() or stopped()):
                    if each_frame is not None:
                        with self._held:
                            each_frame()
                    start = self.clock.now()
                    self._frame(renderer, screen, loop, start, start - before)
                    before = start
        finally:
            if self.controls.capture is not None:
                self.controls.capture.close()
            if self._interface is not None:
                self._interface.close()
            glfw.destroy_window(self.handle)
            glfw.terminate()

    def _display_lost(self) -> None:
        if self.controls.capture is not None:
            self.controls.capture.close()
        self.say("the window's display is gone")

    def _closing(self) -> bool:
        return self.controls.closing or bool(self.glfw.window_should_close(self.handle))

    def _frame(self, renderer: Renderer, screen: Any, loop: Background, start: float, since: float) -> None:
        glfw = self.glfw
        self._exchange_face()
        frame = loop.frame(_IDLE_FRAME_S)
        stepped, pace = self.clock.now(), _IDLE_FRAME_S
        if frame is not None and self._changes(frame, start):
            pace = _SHORTEST_FRAME_S
            self._draw(renderer, screen, frame, start)
            finish(renderer.context)  # what is drawn now counts as this frame's, not as the next one's
            self.times.note(frame.step_s, self.clock.now() - stepped, since)
            self.times.dropped = loop.dropped
            with self._held:
                title = self.controls.title()
            glfw.set_window_title(self.handle, title)
            glfw.swap_buffers(self.handle)
        left = pace - (self.clock.now() - start)
        if left > 0.0:
            glfw.wait_events_timeout(left)
        else:
            glfw.poll_events()

    def _exchange_face(self) -> None:
        skull = self.controls.skull
        if skull is not None and skull.preparing:
            with self._held:
                if skull.update():
                    self._awake_until = self.clock.now() + _AWAKE_S

    def _bone(self) -> Bone | None:
        skull = self.controls.skull
        if skull is None or not skull.shown:
            return None
        with self._held:
            return skull.bone()

    def _changes(self, frame: Frame, now: float) -> bool:
        """Whether this frame looks unlike the one that is shown: a still face costs no drawing."""
        controls, pixels = self.controls, self.glfw.get_framebuffer_size(self.handle)
        if min(pixels) < 1:  # minimised
            return False
        bone = controls.skull and (controls.skull.shown, controls.skull.table)
        shown = (pixels, controls.camera, controls.quality, controls.panelled, controls.helping, bone, frame.pose)
        capture = controls.capture
        busy = capture is not None and (capture.picture_wanted or capture.film_wanted or capture.filmed_s is not None)
        typing = self._interface is not None and self._interface.typing
        if self._shown[:-1] == shown and np.array_equal(self._shown[-1], frame.geometry.vertices):
            return busy or typing or now < self._awake_until
        self._shown = (*shown, frame.geometry.vertices)
        return True

    def _draw(self, renderer: Renderer, screen: Any, frame: Frame, now: float) -> None:
        points = self.glfw.get_window_size(self.handle)
        pixels = self.glfw.get_framebuffer_size(self.handle)
        # the framebuffer counts pixels, which high-density displays have more of than points
        beside = round(self._panel_width() * pixels[0] / max(points[0], 1))
        size = max(pixels[0] - beside, 1), pixels[1]
        quality, bone = self.controls.quality, self._bone()
        samples = QUALITIES[quality].samples
        if self._targets is None or (self._targets.size, self._targets.wanted) != (size, samples):
            if self._targets is not None:
                self._targets.release()
            self._targets = Targets.make(renderer.context, size, samples)
        screen.viewport = (0, 0, *size)
        renderer.draw(frame.geometry, self._targets, self.controls.camera, quality, onto=screen, bone=bone)
        if self.controls.capture is not None:

            def picture(wanted: tuple[int, int]) -> Bytes:
                if wanted[0] <= size[0] < wanted[0] + 2 and wanted[1] <= size[1] < wanted[1] + 2:
                    return _read(screen, wanted)
                return renderer.render(frame.geometry, wanted, self.controls.camera, quality, bone=bone)

            self.controls.capture.frame(now, size, picture)
        if self._panel is not None:
            screen.viewport = (0, 0, *pixels)
            screen.use()
            with self._held:
                self._panel.draw(points)

    def _panel_width(self) -> float:
        return 0.0 if self._panel is None else self._panel.width(self.glfw.get_window_size(self.handle)[0])

    def _open_panel(self) -> None:
        if self._no_panel:
            self.say(self._no_panel)
            return
        from agentface.window.panel.interface import Interface
        from agentface.window.panel.panel import Panel

        self._interface = Interface(self.glfw, self.handle)
        self._panel = Panel(self.controls, self._interface, self.times)

    def _open(self, size: tuple[int, int]) -> Any:
        glfw = self.glfw
        reasons: list[str] = []
        glfw.set_error_callback(
            lambda _code, text: reasons.append(text.decode() if isinstance(text, bytes) else str(text))
        )
        handle = None
        if glfw.init():
            for hint, value in (
                (glfw.CONTEXT_VERSION_MAJOR, 3),
                (glfw.CONTEXT_VERSION_MINOR, 3),
                (glfw.SAMPLES, 0),
                (glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE),
                (glfw.OPENGL_FORWARD_COMPAT, True),
                (glfw.SCALE_TO_MONITOR, True),
            ):
                glfw.window_hint(hint, value)
            handle = glfw.create_window(*size, "agentface", None, None)
        if not handle:
            glfw.terminate()
            raise GraphicsError(_NO_DISPLAY.format(reason="; ".join(reasons) or "none"))
        glfw.set_window_size_limits(handle, 160, 120, glfw.DONT_CARE, glfw.DONT_CARE)
        # imgui calls these before it takes an event itself
        for listen, told in (
            (glfw.set_key_callback, self._on_key),
            (glfw.set_mouse_button_callback, self._on_button),
            (glfw.set_cursor_pos_callback, self._on_move),
            (glfw.set_scroll_callback, self._on_scroll),
            (glfw.set_window_refresh_callback, None),
            (glfw.set_window_focus_callback, None),
            (glfw.set_cursor_enter_callback, None),
        ):
            listen(handle, self._woken(told))
        return handle

    def _woken(self, told: Callable[..., object] | None) -> Callable[..., None]:
        def call(*event: Any) -> None:
            self._awake_until = self.clock.now() + _AWAKE_S
            if told is not None:
                with self._held:
                    told(*event)

        return call

    def _on_key(self, _window: Any, key: int, scancode: int, action: int, mods: int) -> None:
        glfw = self.glfw
        if action not in (glfw.PRESS, glfw.REPEAT) or (self._interface is not None and self._interface.typing):
            return
        name = self._key_name(key, scancode)
        if name in ("H", "F1") and self._panel is None:
            self.say(help_text())
        elif name:
            self.controls.key(name, shift=bool(mods & glfw.MOD_SHIFT), ctrl=bool(mods & glfw.MOD_CONTROL))

    def _key_name(self, key: int, scancode: int) -> str:
        glfw = self.glfw
        named = {glfw.KEY_SPACE: "Space", glfw.KEY_BACKSPACE: "Backspace", glfw.KEY_ESCAPE: "Escape"}
        named |= {glfw.KEY_F1: "F1", glfw.KEY_F2: "F2"}
        if key in named:
            return named[key]
        if glfw.KEY_KP_0 <= key <= glfw.KEY_KP_9:
            return str(key - glfw.KEY_KP_0)
        if glfw.KEY_0 <= key <= glfw.KEY_9:  # by place: some keyboards have signs there
            return chr(key)
        # by what is printed on it: Z is elsewhere on a German keyboard
        printed = glfw.get_key_name(key, scancode) or ""
        return printed.upper() if printed.isascii() and printed.isalpha() else chr(key) if 64 < key < 91 else ""

    def _on_button(self, window: Any, button: int, action: int, _mods: int) -> None:
        if action == self.glfw.PRESS and self._dragging is None:
            self._last_place = self.glfw.get_cursor_pos(window)
            self._dragging = button if self._on_the_face(self._last_place[0]) else None
        elif action == self.glfw.RELEASE and button == self._dragging:
            self._dragging = None

    def _on_move(self, window: Any, x: float, y: float) -> None:
        right, down = x - self._last_place[0], y - self._last_place[1]
        if self._dragging == self.glfw.MOUSE_BUTTON_LEFT:
            self.controls.drag(right, down)
        elif self._dragging is not None:
            self.controls.pan(right, down, self.glfw.get_window_size(window)[1])
        self._last_place = (x, y)

    def _on_scroll(self, window: Any, _right: float, up: float) -> None:
        if self._on_the_face(self.glfw.get_cursor_pos(window)[0]):
            self.controls.wheel(up)

    def _on_the_face(self, x: float) -> bool:
        over_help = self._interface is not None and self.controls.helping and self._interface.wants_mouse
        return not over_help and x < self.glfw.get_window_size(self.handle)[0] - self._panel_width()


def _read(screen: Any, size: tuple[int, int]) -> Bytes:
    pixels = np.frombuffer(screen.read(viewport=(0, 0, *size), components=3, alignment=1), np.uint8)
    return np.ascontiguousarray(pixels.reshape(size[1], size[0], 3)[::-1])


def _missing_panel() -> str:
    """Why there is no panel and how to get it; nothing where there is one."""
    early = "glfw" in sys.modules and "imgui_bundle" not in sys.modules
    try:
        import imgui_bundle  # noqa: F401  # before glfw, which then loads the library that it has, too
    except ModuleNotFoundError as error:
        if error.name != "imgui_bundle":
            return _NO_PANEL.format(reason=f"imgui-bundle lacks the Python package {error.name}", advice=_REINSTALL)
        return _NO_PANEL.format(reason="imgui-bundle is not installed", advice='pip install "agentface[window]"')
    except ImportError as error:
        return _NO_PANEL.format(reason=f"imgui-bundle does not load: {error}", advice="install what it lacks")
    if early:
        return _NO_PANEL.format(reason="glfw was imported before imgui_bundle", advice="import imgui_bundle first")
    return ""


def _glfw() -> Any:
    try:
        import glfw
    except ImportError as error:
        missing = isinstance(error, ModuleNotFoundError) and error.name == "glfw"
        raise GraphicsError(_NO_GLFW if missing else _GLFW_DOES_NOT_LOAD.format(reason=error)) from error
    glfw.ERROR_REPORTING = "ignore"
    return glfw
