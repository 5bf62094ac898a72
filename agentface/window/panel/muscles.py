"""The muscles: a slider each, both sides together or one by one."""

from __future__ import annotations

from functools import partial

from imgui_bundle import imgui

from agentface.parameters import parameter
from agentface.window.controls import Controls
from agentface.window.menu import GROUPS, sides
from agentface.window.panel.widgets import ACCENT, DIM, HELD, coloured, named, slider, words

_WHICH = {"_l": "left %.2f", "_r": "right %.2f"}


def muscles(controls: Controls) -> None:
    """The muscles by group; how many of a group are set by hand."""
    held = controls.face.held
    for group, members in GROUPS.items():
        count = sum(name in held for muscle in members for name in sides(muscle))
        if imgui.tree_node_ex(f"{group}{f'   {count} by hand' if count else ''}###{group}"):
            for muscle in members:
                with named(muscle):
                    _muscle(controls, muscle)
            imgui.tree_pop()


def muscle_slider(controls: Controls, muscle: str, label: str = "") -> None:
    """The slider of a muscle, or one a side, as the emotion moves it; amber, and where to, when set by hand."""
    names, held, pose = sides(muscle), controls.face.held, controls.face.pose
    # as seen from the front, the person's right is at the left
    parts = [(name,) for name in reversed(names)] if muscle in controls.apart else [names]
    gap = imgui.get_style().item_inner_spacing.x
    width = (imgui.calc_item_width() - (len(parts) - 1) * gap) / len(parts)
    for place, part in enumerate(parts):
        if place:
            imgui.same_line(0.0, gap)
        imgui.set_next_item_width(width)
        value = sum(held.get(name, pose[name]) for name in part) / len(part)
        by_hand = any(name in held for name in part)
        text = _WHICH[part[0][-2:]] if len(parts) > 1 else "%.2f"
        with coloured(imgui.Col_.slider_grab, imgui.Col_.slider_grab_active, colour=HELD if by_hand else None):
            slider(controls, part, label, value, text, rest=None)


def _muscle(controls: Controls, muscle: str) -> None:
    names = sides(muscle)
    by_hand = any(name in controls.face.held for name in names)
    right_edge = imgui.get_cursor_pos_x() + imgui.get_content_region_avail().x
    with coloured(imgui.Col_.text, colour=ACCENT if by_hand else DIM):
        imgui.text(words(muscle))
    imgui.set_item_tooltip(parameter(names[0]).description)
    actions = []
    if by_hand:
        actions.append(("auto", "give it back to the emotion", partial(controls.change, dict.fromkeys(names))))
    if len(names) > 1:
        apart = muscle in controls.apart
        hint = "set both sides together" if apart else "set right and left one by one"
        actions.append(("L=R" if apart else "L R", hint, partial(controls.part, muscle)))
    style = imgui.get_style()
    widths = [imgui.calc_text_size(label).x + 2.0 * style.frame_padding.x for label, _, _ in actions]
    left = right_edge - sum(widths) - style.item_spacing.x * (len(actions) - 1)
    for (label, hint, action), width in zip(actions, widths, strict=True):
        imgui.same_line(left)
        if imgui.small_button(label):
            action()
        imgui.set_item_tooltip(hint)
        left += width + style.item_spacing.x
    imgui.push_item_width(imgui.get_content_region_avail().x)
    muscle_slider(controls, muscle)
    imgui.pop_item_width()
