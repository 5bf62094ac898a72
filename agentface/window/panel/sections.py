"""Emotions, presets, view, gaze, head and times."""

from __future__ import annotations

from functools import partial

from imgui_bundle import imgui

from agentface.emotion.state import EMOTIONS
from agentface.window.controls import Controls, bounds
from agentface.window.menu import PRESETS
from agentface.window.panel.muscles import muscle_slider
from agentface.window.panel.widgets import DIM, RECORDING, button, coloured, columns, slider
from agentface.window.times import Times

_PAD_EMS = 5.0


def buttons(controls: Controls) -> None:
    """Reset, undo, redo; pictures and films, and where they were written."""
    across = columns(3)
    button("Reset", across, controls.reset)
    imgui.same_line()
    button("Undo", across, controls.undo, enabled=controls.history.can_undo)
    imgui.same_line()
    button("Redo", across, controls.redo, enabled=controls.history.can_redo)
    capture = controls.capture
    if capture is not None:
        across = columns(2)
        button("Screenshot", across, controls.picture)
        imgui.same_line()
        filmed = capture.filmed_s
        label = "Record" if filmed is None else f"Stop  {filmed:.1f} s"
        with coloured(imgui.Col_.button, imgui.Col_.button_hovered, colour=None if filmed is None else RECORDING):
            button(f"{label}###record", across, controls.film)
        if capture.message:
            with coloured(imgui.Col_.text, colour=DIM):
                imgui.text_wrapped(capture.message)
    imgui.spacing()


def emotions(controls: Controls) -> None:
    """Six sliders."""
    for emotion, value in controls.face.emotion.items():
        slider(controls, (emotion,), emotion.capitalize(), value)


def presets(controls: Controls) -> None:
    """The emotions three in a row, the blends two."""
    blends = [name for name in PRESETS if name not in EMOTIONS]
    for names, count in ((EMOTIONS, 3), (blends, 2)):
        across = columns(count)
        for place, name in enumerate(names):
            if place % count:
                imgui.same_line()
            button(name.capitalize(), across, partial(controls.preset, name))


def view(controls: Controls) -> None:
    """The standard views and the quality."""
    across = columns(4)
    for name, seen_from in (("Front", "front"), ("3/4", "three-quarter"), ("Profile", "profile")):
        button(name, across, partial(controls.look, seen_from))
        imgui.same_line()
    button(f"{controls.quality.capitalize()}###quality", across, partial(controls.key, "Q"))
    imgui.set_item_tooltip("quality: fast, portrait")


def turns(controls: Controls) -> None:
    """Where the eyes look, the jaw, the head."""
    gaze(controls)
    muscle_slider(controls, "jaw_open", "Jaw")
    turned = controls.face.turned_deg
    for name, label in (("head_yaw", "Head turn"), ("head_pitch", "Head nod"), ("head_roll", "Head tilt")):
        slider(controls, (name,), label, turned[name], "%.0f°")


def gaze(controls: Controls) -> None:
    """A field whose dot is where the eyes look, as seen from the front."""
    turned = controls.face.turned_deg
    em = imgui.get_font_size()
    width, height, edge = imgui.calc_item_width(), _PAD_EMS * em, 0.4 * em
    half = (0.5 * width - edge, 0.5 * height - edge)
    corner = imgui.get_cursor_screen_pos()
    middle = (corner.x + 0.5 * width, corner.y + 0.5 * height)
    widest, highest = bounds("gaze_yaw")[1], bounds("gaze_pitch")[1]
    imgui.invisible_button("gaze", (width, height))
    if imgui.is_item_active():
        mouse = imgui.get_mouse_pos()
        right, up = (mouse.x - middle[0]) / half[0], (middle[1] - mouse.y) / half[1]
        controls.change({"gaze_yaw": right * widest, "gaze_pitch": up * highest, "gaze_vergence": 0.0}, "gaze")
    if imgui.is_item_deactivated():
        controls.settle()
    if imgui.is_item_clicked(imgui.MouseButton_.right):
        controls.change({"gaze_yaw": 0.0, "gaze_pitch": 0.0, "gaze_vergence": 0.0})
    draw = imgui.get_window_draw_list()
    frame, line, dot = map(
        imgui.get_color_u32, (int(imgui.Col_.frame_bg), int(imgui.Col_.border), int(imgui.Col_.slider_grab_active))
    )
    draw.add_rect_filled(corner, (corner.x + width, corner.y + height), frame, 0.25 * em)
    draw.add_line((middle[0], corner.y), (middle[0], corner.y + height), line)
    draw.add_line((corner.x, middle[1]), (corner.x + width, middle[1]), line)
    right, up = turned["gaze_yaw"] / widest, turned["gaze_pitch"] / highest
    draw.add_circle_filled((middle[0] + right * half[0], middle[1] - up * half[1]), edge, dot)
    imgui.same_line(0.0, imgui.get_style().item_inner_spacing.x)
    imgui.begin_group()
    imgui.text("Gaze")
    imgui.text_disabled(f"{turned['gaze_yaw']:+.0f}° {turned['gaze_pitch']:+.0f}°")
    imgui.end_group()


def frame_time(times: Times) -> None:
    """Milliseconds by stage, and the last frames as a curve."""
    total = times.total_ms
    imgui.text(f"deform {times.deform_ms:.1f} ms   draw {times.draw_ms:.1f} ms")
    imgui.text(f"total {total:.1f} ms   {1000.0 / total if total else 0.0:.0f} frames a second")
    if times.dropped:
        imgui.text(f"{times.dropped} frames left out")
    totals = times.totals_ms
    top = max(40.0, float(totals.max()))
    size = (imgui.get_content_region_avail().x, 3.5 * imgui.get_font_size())
    imgui.plot_lines("##frames", totals, 0, f"0 .. {top:.0f} ms", 0.0, top, size)
