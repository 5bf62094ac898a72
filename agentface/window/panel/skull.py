"""The skull under a face of tissue: nudged, looked at, saved."""

from __future__ import annotations

from imgui_bundle import imgui

from agentface.tissue.nudge import NUDGES
from agentface.tissue.tissue_file import TISSUE_FILE
from agentface.window.panel.widgets import ACCENT, DIM, button, coloured, columns
from agentface.window.skull import SkullControls

_AXES = "xyz"
_LABELS = {
    "rotate_deg": ("Rotate", "%.1f°", "degrees about x (nods), y (turns), z (tilts)"),
    "translate_mm": ("Move", "%.1f", "mm to the person's left, up, forward"),
    "scale": ("Scale", "%.2f", "wider, higher, deeper"),
}


def skull(controls: SkullControls) -> None:
    """Nine sliders, how near the bone comes, and what becomes of the numbers."""
    _, controls.shown = imgui.checkbox("Show the bone", controls.shown)
    imgui.set_item_tooltip("amber: tissue lies on it\nred: it stands out of the skin")
    for key in NUDGES:
        _sliders(controls, key)
    _nearness(controls)
    across = columns(2)
    button("Reset###reset skull", across, controls.reset, enabled=controls.nudged)
    imgui.same_line()
    button(f"Save to {TISSUE_FILE}###save skull", across, controls.save, enabled=controls.unsaved)
    message = "the face is made anew ..." if controls.preparing else controls.message
    if message:
        with coloured(imgui.Col_.text, colour=DIM):
            imgui.text_wrapped(message)


def _sliders(controls: SkullControls, key: str) -> None:
    low, high, rest = NUDGES[key]
    label, text, hint = _LABELS[key]
    gap = imgui.get_style().item_inner_spacing.x
    width = (imgui.calc_item_width() - 2.0 * gap) / len(_AXES)
    for axis, (name, value) in enumerate(zip(_AXES, getattr(controls.table, key), strict=True)):
        imgui.set_next_item_width(width)
        changed, wanted = imgui.slider_float(
            f"###{key}_{name}", value, low, high, f"{name} {text}", imgui.SliderFlags_.always_clamp
        )
        if changed:
            controls.nudge(key, axis, wanted)
        if imgui.is_item_deactivated():
            controls.settle()
        if imgui.is_item_clicked(imgui.MouseButton_.right):
            controls.nudge(key, axis, rest)
            controls.settle()
        imgui.same_line(0.0, gap)
    imgui.text(label)
    imgui.set_item_tooltip(hint)


def _nearness(controls: SkullControls) -> None:
    near = controls.nearness()
    if near.resting:
        imgui.text(f"{near.resting} nodes of the tissue rest on the bone")
    else:
        imgui.text(f"at the nearest, {near.least_mm:.1f} mm from tissue to bone")
    if near.outside_mm:
        with coloured(imgui.Col_.text, colour=ACCENT):
            imgui.text_wrapped(f"The skull stands out of the skin, by up to {near.outside_mm:.1f} mm.")
