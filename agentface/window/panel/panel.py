"""The panel at the right of the face; what it is told goes to :class:`Controls`."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from imgui_bundle import imgui

from agentface.window.controls import Controls
from agentface.window.menu import KEYS, MOUSE, SLIDERS
from agentface.window.panel import sections
from agentface.window.panel.interface import Interface
from agentface.window.panel.muscles import muscles
from agentface.window.panel.rules import Rules
from agentface.window.panel.skull import skull
from agentface.window.panel.widgets import ACCENT, named
from agentface.window.times import Times

WIDTH_EMS = 22.0
_LARGEST_SHARE = 0.6
_BEFORE_RULES = 5
_FIXED = (
    imgui.WindowFlags_.no_title_bar
    | imgui.WindowFlags_.no_resize
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_collapse
    | imgui.WindowFlags_.no_saved_settings
)


class Panel:
    """What is drawn beside the face, and the help over it."""

    def __init__(self, controls: Controls, interface: Interface, times: Times) -> None:
        self._controls, self._interface = controls, interface
        draw: list[tuple[str, Callable[[], None], bool]] = [
            ("Emotions", partial(sections.emotions, controls), True),
            ("Presets", partial(sections.presets, controls), True),
            ("View", partial(sections.view, controls), True),
            ("Gaze, jaw, head", partial(sections.turns, controls), True),
            ("Muscles", partial(muscles, controls), False),
            ("Rules that fired", partial(Rules().draw, controls), False),
            ("Frame time", partial(sections.frame_time, times), False),
        ]
        if controls.skull is not None:
            draw.insert(_BEFORE_RULES, ("Skull", partial(skull, controls.skull), False))
        self._sections = draw
        self._help_size = (0.0, 0.0)

    def width(self, window: float) -> float:
        """The points that it takes of a window so wide; none when it is hidden or would leave the face no room."""
        wide = self._interface.points(WIDTH_EMS)
        return wide if self._controls.panelled and wide <= _LARGEST_SHARE * window else 0.0

    def draw(self, size: tuple[int, int]) -> None:
        """Draw into a window of ``size`` points."""
        width = self.width(size[0])
        self._interface.begin()
        if width:
            imgui.set_next_window_pos((size[0] - width, 0))
            imgui.set_next_window_size((width, size[1]))
            imgui.begin("panel", None, _FIXED)
            self._contents()
            imgui.end()
        if self._controls.helping:
            self._help(size, 0.5 * (size[0] - width))
        self._interface.end()

    def _contents(self) -> None:
        sections.buttons(self._controls)
        for title, draw, opened in self._sections:
            flag = imgui.TreeNodeFlags_.default_open if opened else imgui.TreeNodeFlags_.none
            if imgui.collapsing_header(title, flag):
                with named(title):
                    draw()
                imgui.spacing()

    def _help(self, size: tuple[int, int], middle: float) -> None:
        margin = 0.5 * imgui.get_font_size()
        most = (size[0] - 2.0 * margin, size[1] - 2.0 * margin)
        wide, high = self._help_size
        place = (max(margin, middle - 0.5 * wide), max(margin, 0.5 * (size[1] - high)))
        imgui.set_next_window_pos(place)
        imgui.set_next_window_size_constraints((0.0, 0.0), most)
        imgui.set_next_window_bg_alpha(0.94)
        imgui.begin(
            "help", None, _FIXED | imgui.WindowFlags_.always_auto_resize | imgui.WindowFlags_.horizontal_scrollbar
        )
        for title, rows in (("Keys", KEYS), ("Mouse", MOUSE), ("Sliders", SLIDERS)):
            imgui.separator_text(title)
            _table(title, rows)
        self._help_size = imgui.get_window_size().x, imgui.get_window_size().y
        imgui.end()


def _table(title: str, rows: tuple[tuple[str, str], ...]) -> None:
    if imgui.begin_table(title, 2, imgui.TableFlags_.sizing_fixed_fit):
        imgui.table_setup_column("key", imgui.TableColumnFlags_.width_fixed, 7.0 * imgui.get_font_size())
        imgui.table_setup_column("what it does")
        for key, does in rows:
            imgui.table_next_column()
            imgui.text_colored(ACCENT, key)
            imgui.table_next_column()
            imgui.text(does)
        imgui.end_table()
