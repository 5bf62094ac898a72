"""Dear ImGui in a glfw window: its context, font, sizes and drawing."""

from __future__ import annotations

import ctypes
from importlib.resources import as_file, files
from typing import Any

from imgui_bundle import imgui

from agentface.errors import GraphicsError
from agentface.window.panel.widgets import DIM

FONT_POINTS = 15.0
_COLOURS = {
    imgui.Col_.window_bg: (0.105, 0.11, 0.12, 1.0),
    imgui.Col_.popup_bg: (0.105, 0.11, 0.12, 0.97),
    imgui.Col_.border: (0.25, 0.26, 0.28, 1.0),
    imgui.Col_.text: (0.90, 0.90, 0.91, 1.0),
    imgui.Col_.text_disabled: DIM,
    imgui.Col_.frame_bg: (0.18, 0.19, 0.205, 1.0),
    imgui.Col_.frame_bg_hovered: (0.23, 0.24, 0.26, 1.0),
    imgui.Col_.frame_bg_active: (0.26, 0.27, 0.29, 1.0),
    imgui.Col_.slider_grab: (0.27, 0.45, 0.61, 1.0),
    imgui.Col_.slider_grab_active: (0.36, 0.57, 0.75, 1.0),
    imgui.Col_.button: (0.21, 0.225, 0.245, 1.0),
    imgui.Col_.button_hovered: (0.28, 0.31, 0.34, 1.0),
    imgui.Col_.button_active: (0.33, 0.40, 0.46, 1.0),
    imgui.Col_.header: (0.16, 0.17, 0.185, 1.0),
    imgui.Col_.header_hovered: (0.22, 0.235, 0.255, 1.0),
    imgui.Col_.header_active: (0.26, 0.28, 0.30, 1.0),
    imgui.Col_.plot_lines: (0.45, 0.62, 0.78, 1.0),
    imgui.Col_.plot_histogram: (0.27, 0.45, 0.61, 1.0),
}
_LENGTHS = {
    "frame_rounding": 4,
    "grab_rounding": 4,
    "popup_rounding": 6,
    "child_rounding": 4,
    "scrollbar_size": 11,
    "scrollbar_rounding": 6,
    "grab_min_size": 10,
    "indent_spacing": 10,
    "separator_text_border_size": 1,
}
_PADDINGS = {
    "window_padding": (12, 10),
    "frame_padding": (8, 3),
    "item_spacing": (6, 5),
    "item_inner_spacing": (6, 4),
    "cell_padding": (4, 2),
}


class Interface:
    """Takes the window's events after the callbacks that it has, and draws over what is in its framebuffer.

    Its context is the current one of ``glfw``; raises GraphicsError when imgui cannot use the window.
    """

    def __init__(self, glfw: Any, handle: Any) -> None:
        self._glfw, self._handle = glfw, handle
        self._context = imgui.create_context()
        self.io = imgui.get_io()
        self.io.set_ini_filename("")
        self.io.config_windows_move_from_title_bar_only = True
        self._scale = 0.0
        _load_font(self.io)
        address = ctypes.cast(handle, ctypes.c_void_p).value
        if not (
            address
            and imgui.backends.glfw_init_for_opengl(address, True)
            and imgui.backends.opengl3_init("#version 330")
        ):
            raise GraphicsError("the window's panel: expected a window with OpenGL 3.3, got one imgui cannot use")

    @property
    def wants_mouse(self) -> bool:
        """Whether the mouse is over something of the interface, or drags it."""
        return bool(self.io.want_capture_mouse)

    @property
    def typing(self) -> bool:
        """Whether keys go into a text."""
        return bool(self.io.want_text_input)

    def points(self, ems: float) -> float:
        """The length of so many heights of the font, in the window's points."""
        return ems * FONT_POINTS * self._wanted_scale()

    def begin(self) -> None:
        """Start a frame."""
        scale = self._wanted_scale()
        if scale != self._scale:
            self._scale = scale
            _set_style(scale)
        imgui.backends.opengl3_new_frame()
        imgui.backends.glfw_new_frame()
        imgui.new_frame()

    def end(self) -> None:
        """Draw the frame into the framebuffer that is bound."""
        imgui.render()
        imgui.backends.opengl3_render_draw_data(imgui.get_draw_data())

    def close(self) -> None:
        """Let go of the window, which is still open."""
        imgui.backends.opengl3_shutdown()
        imgui.backends.glfw_shutdown()
        imgui.destroy_context(self._context)

    def _wanted_scale(self) -> float:
        """Points that the user's settings take for one: where a point is several pixels already, no more than one."""
        content, _ = self._glfw.get_window_content_scale(self._handle)
        points, _ = self._glfw.get_window_size(self._handle)
        pixels, _ = self._glfw.get_framebuffer_size(self._handle)
        return float(min(max(content * max(points, 1) / max(pixels, 1), 0.5), 4.0))


def _load_font(io: Any) -> None:
    with as_file(files("imgui_bundle") / "assets" / "fonts" / "Roboto" / "Roboto-Regular.ttf") as path:
        if path.is_file():
            io.fonts.add_font_from_file_ttf(str(path), FONT_POINTS)
        else:
            io.fonts.add_font_default()


def _set_style(scale: float) -> None:
    style = imgui.get_style()
    for colour, value in _COLOURS.items():
        style.set_color_(colour, imgui.ImVec4(*value))
    style.font_size_base, style.font_scale_dpi = FONT_POINTS, scale
    style.window_border_size = style.window_rounding = 0.0
    for name, length in _LENGTHS.items():
        setattr(style, name, round(scale * length))
    for name, (across, down) in _PADDINGS.items():
        setattr(style, name, imgui.ImVec2(round(scale * across), round(scale * down)))
