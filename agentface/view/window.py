"""``agentface show``: a face in a window; keys raise emotions, the mouse looks round the head."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any, Protocol

from agentface.anatomy.model import HeadModel
from agentface.deform.geometry import FaceGeometry
from agentface.errors import GraphicsError
from agentface.view.camera import Camera, named_view
from agentface.view.renderer import QUALITIES, Renderer
from agentface.view.targets import Targets

STEP = 0.25
FADE_S = 0.35
_LONGEST_STEP_S = 0.1
_TURN_PER_POINT = 0.008
_ZOOM_PER_NOTCH = 1.1
_VIEWS = {"F": "front", "T": "three-quarter", "P": "profile"}

HELP = """keys
  1..6         more happiness, sadness, anger, fear, disgust, surprise (a quarter a press)
  Shift 1..6   less of it
  0 Backspace  neutral
  Space        blink
  F T P        front, three-quarter, profile
  Q            quality: fast, portrait
  H            this help          Esc  quit
mouse
  drag         look round the head          wheel  nearer, farther"""

_NO_GLFW = """expected the Python package glfw, got none.
Install the window's extra:  pip install "agentface[window]"
Pictures and films need no window: see `agentface render --help`."""
_NO_DISPLAY = """expected a display for the window, got: {reason}.
Start it inside a desktop session, set DISPLAY, or use a virtual one:  xvfb-run agentface show
Pictures and films need no display: see `agentface render --help`."""


class ShownFace(Protocol):
    """What the window needs of a face."""

    @property
    def model(self) -> HeadModel:
        """The head."""

    @property
    def emotion(self) -> Mapping[str, float]:
        """The target intensities by name."""

    def set_emotion(self, emotion: Any, intensity: Any = None, *, fade: float = FADE_S) -> None:
        """Change the target state."""

    def step(self, dt: float) -> FaceGeometry:
        """Go on by ``dt`` seconds."""


class Controls:
    """What keys and mouse do, without a window: the face's emotions and the camera."""

    def __init__(self, face: ShownFace) -> None:
        from agentface.emotion.state import EMOTIONS

        self.face = face
        self.emotions = tuple(EMOTIONS)
        self.camera: Camera = named_view(face.model, "front")
        self.quality = "fast"
        self.closing = False

    def key(self, name: str, *, shift: bool = False) -> None:
        """Press the key ``name`` (``1``, ``F``, ``Space``, ...); others do nothing."""
        if name.isdigit() and 1 <= int(name) <= len(self.emotions):
            self._raise(self.emotions[int(name) - 1], -STEP if shift else STEP)
        elif name in ("0", "Backspace"):
            self.face.set_emotion(dict.fromkeys(self.emotions, 0.0), fade=FADE_S)
        elif name == "Space":
            blink = getattr(self.face, "blink", None)
            if blink is not None:
                blink()
        elif name in _VIEWS:
            self.camera = named_view(self.face.model, _VIEWS[name])
        elif name == "Q":
            names = tuple(QUALITIES)
            self.quality = names[(names.index(self.quality) + 1) % len(names)]
        elif name == "Escape":
            self.closing = True

    def drag(self, right: float, down: float) -> None:
        """Move the mouse with a button held, in points."""
        self.camera = self.camera.orbited(-_TURN_PER_POINT * right, _TURN_PER_POINT * down)

    def wheel(self, notches: float) -> None:
        """Turn the wheel; away from the user is positive."""
        self.camera = self.camera.zoomed(_ZOOM_PER_NOTCH ** max(-8.0, min(8.0, notches)))

    def title(self) -> str:
        """The window's title: the face and what it feels."""
        felt = [f"{name} {value:.2f}" for name, value in self.face.emotion.items() if value > 0.0]
        return f"{self.face.model.name} - {', '.join(felt) or 'neutral'} - H for help"

    def _raise(self, emotion: str, by: float) -> None:
        value = float(self.face.emotion[emotion]) + by
        self.face.set_emotion({**dict(self.face.emotion), emotion: max(0.0, min(1.0, value))}, fade=FADE_S)


class Window:
    """A window that shows ``face`` until it is closed.

    Args:
        face: the face.
        size: width and height in points.
        clock: seconds, for the steps between frames.
        say: prints the help.

    Raises GraphicsError when glfw is not installed or there is no display.
    """

    def __init__(
        self,
        face: ShownFace,
        size: tuple[int, int] = (960, 720),
        clock: Callable[[], float] = time.perf_counter,
        say: Callable[[str], object] = print,
    ) -> None:
        self.controls, self.clock, self.say = Controls(face), clock, say
        self.glfw = _glfw()
        self.handle = self._open(size)
        self._last_place: tuple[float, float] | None = None
        self._targets: Targets | None = None

    def run(self, each_frame: Callable[[], object] | None = None) -> None:
        """Show the face until the window is closed; ``each_frame`` is called before each frame."""
        glfw = self.glfw
        import moderngl

        try:
            glfw.make_context_current(self.handle)
            glfw.swap_interval(1)
            context = moderngl.create_context(require=330)
            screen = context.detect_framebuffer()  # before the renderer binds framebuffers of its own
            renderer = Renderer(self.controls.face.model, context=context)
            before = self.clock()
            while not (self.controls.closing or glfw.window_should_close(self.handle)):
                if each_frame is not None:
                    each_frame()
                now = self.clock()
                geometry = self.controls.face.step(min(max(now - before, 0.0), _LONGEST_STEP_S))
                before = now
                self._draw(renderer, screen, geometry)
                glfw.set_window_title(self.handle, self.controls.title())
                glfw.swap_buffers(self.handle)
                glfw.poll_events()
        finally:
            glfw.destroy_window(self.handle)
            glfw.terminate()

    def _draw(self, renderer: Renderer, screen: Any, geometry: FaceGeometry) -> None:
        # the framebuffer counts pixels, which high-density displays have more of than points
        width, height = self.glfw.get_framebuffer_size(self.handle)
        if width < 1 or height < 1:  # minimised
            return
        samples = QUALITIES[self.controls.quality]
        if self._targets is None or (self._targets.size, self._targets.wanted) != ((width, height), samples):
            if self._targets is not None:
                self._targets.release()
            self._targets = Targets.make(renderer.context, (width, height), samples)
        screen.viewport = (0, 0, width, height)
        renderer.draw(geometry, self._targets, self.controls.camera, self.controls.quality, onto=screen)

    def _open(self, size: tuple[int, int]) -> Any:
        glfw = self.glfw
        reasons: list[str] = []
        glfw.set_error_callback(
            lambda _code, text: reasons.append(text.decode() if isinstance(text, bytes) else str(text))
        )
        handle = None
        if glfw.init():
            hints = ((glfw.CONTEXT_VERSION_MAJOR, 3), (glfw.CONTEXT_VERSION_MINOR, 3), (glfw.SAMPLES, 0))
            for hint, value in (
                *hints,
                (glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE),
                (glfw.OPENGL_FORWARD_COMPAT, True),
            ):
                glfw.window_hint(hint, value)
            handle = glfw.create_window(*size, "agentface", None, None)
        if not handle:
            glfw.terminate()
            raise GraphicsError(_NO_DISPLAY.format(reason="; ".join(reasons) or "none"))
        glfw.set_key_callback(handle, self._on_key)
        glfw.set_cursor_pos_callback(handle, self._on_move)
        glfw.set_scroll_callback(handle, lambda _window, _right, up: self.controls.wheel(up))
        return handle

    def _on_key(self, _window: Any, key: int, _scancode: int, action: int, mods: int) -> None:
        glfw = self.glfw
        if action not in (glfw.PRESS, glfw.REPEAT):
            return
        named = {glfw.KEY_SPACE: "Space", glfw.KEY_BACKSPACE: "Backspace", glfw.KEY_ESCAPE: "Escape"}
        pad = glfw.KEY_KP_0 <= key <= glfw.KEY_KP_9
        name = named.get(key) or (str(key - glfw.KEY_KP_0) if pad else chr(key) if 32 < key < 127 else "")
        if name == "H":
            self.say(HELP)
        elif name:
            self.controls.key(name, shift=bool(mods & glfw.MOD_SHIFT))

    def _on_move(self, window: Any, x: float, y: float) -> None:
        held = self.glfw.get_mouse_button(window, self.glfw.MOUSE_BUTTON_LEFT) == self.glfw.PRESS
        if held and self._last_place is not None:
            self.controls.drag(x - self._last_place[0], y - self._last_place[1])
        self._last_place = (x, y) if held else None


def _glfw() -> Any:
    try:
        import glfw
    except ImportError as error:
        raise GraphicsError(_NO_GLFW) from error
    glfw.ERROR_REPORTING = "ignore"
    return glfw
