"""What the sections of the panel are made of."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from imgui_bundle import imgui

from agentface.window.controls import Controls, bounds

Colour = tuple[float, float, float, float]

ACCENT: Colour = (0.93, 0.66, 0.32, 1.0)
HELD: Colour = (0.70, 0.45, 0.16, 1.0)
RECORDING: Colour = (0.62, 0.17, 0.17, 1.0)
DIM: Colour = (0.60, 0.62, 0.66, 1.0)


def columns(count: int) -> float:
    """The width of each of so many things in a row."""
    return float((imgui.get_content_region_avail().x - (count - 1) * imgui.get_style().item_spacing.x) / count)


def button(label: str, width: float, action: Callable[[], object], *, enabled: bool = True) -> None:
    """A button so wide that does ``action``."""
    imgui.begin_disabled(not enabled)
    if imgui.button(label, (width, 0)):
        action()
    imgui.end_disabled()


def slider(
    controls: Controls,
    names: tuple[str, ...],
    label: str,
    value: float,
    text: str = "%.2f",
    rest: float | None = 0.0,
) -> None:
    """A slider that sets all of ``names``; a click with the right button sets them to ``rest``."""
    low, high = bounds(names[0])
    gesture = " ".join(names)
    changed, wanted = imgui.slider_float(
        f"{label}###{gesture}", value, low, high, text, imgui.SliderFlags_.always_clamp
    )
    if changed:
        controls.change(dict.fromkeys(names, wanted), gesture)
    if imgui.is_item_deactivated():
        controls.settle()
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        controls.change(dict.fromkeys(names, rest))


@contextmanager
def coloured(*parts: int, colour: Colour | None) -> Iterator[None]:
    """Draw these parts in another colour; in their own when None."""
    if colour is not None:
        for part in parts:
            imgui.push_style_color(part, colour)
    yield
    if colour is not None:
        imgui.pop_style_color(len(parts))


@contextmanager
def named(name: str) -> Iterator[None]:
    """Tell what is inside from the same elsewhere."""
    imgui.push_id(name)
    yield
    imgui.pop_id()


def words(muscle: str) -> str:
    """A muscle's name as it fits into the panel."""
    return muscle.replace("superioris_alaeque", "sup._alaeque").replace("_", " ")
