"""Which rules fired, and how strongly."""

from __future__ import annotations

from collections import defaultdict
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from agentface.window.controls import Controls
from agentface.window.panel.widgets import named, words

if TYPE_CHECKING:
    from agentface.emotion.explanation import Explanation, ModeOutcome
    from agentface.emotion.state import EmotionState

_BAR_EMS = 2.6


class Rules:
    """The rules by mode and premise, the strongest first; a premise opens to what it asks of the muscles."""

    def __init__(self) -> None:
        self._known: tuple[EmotionState, Explanation] | None = None

    def draw(self, controls: Controls) -> None:
        """Explain the emotions that the face goes to."""
        emotion = controls.face.emotion
        if self._known is None or self._known[0] != emotion:
            self._known = (emotion, controls.face.explain())
        modes = self._known[1].modes
        if not modes:
            imgui.text_disabled("none: the face is neutral")
        for mode in modes:
            with named(mode.name):
                _mode(mode)


def _mode(mode: ModeOutcome) -> None:
    imgui.text(f"{mode.name.replace('+', ' + ')}: weight {mode.weight:.2f}")
    imgui.set_item_tooltip(mode.description)
    strengths: dict[str, float] = {}
    asked: dict[str, list[str]] = defaultdict(list)
    for rule in mode.rules:
        premise = _short(rule.text)
        strengths[premise] = rule.strength
        asked[premise].append(f"{words(rule.muscle)}: {rule.consequent}")
    for premise, strength in sorted(strengths.items(), key=lambda row: -row[1]):
        imgui.progress_bar(strength, (_BAR_EMS * imgui.get_font_size(), 0.0), f"{strength:.2f}")
        imgui.same_line()
        if imgui.tree_node(premise):
            for line in asked[premise]:
                imgui.text_disabled(line)
            imgui.tree_pop()


def _short(rule: str) -> str:
    """The premise of a rule as it fits into the panel: ``Fear High, Anger Low``."""
    premise = rule.partition(" then ")[0].removeprefix("if ")
    return premise.replace(" is ", " ").replace(" and ", ", ")
