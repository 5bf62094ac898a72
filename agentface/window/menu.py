"""What the window offers: keys, muscles by group, presets."""

from __future__ import annotations

from agentface.conventions import SIDES
from agentface.emotion.state import EMOTIONS, NEUTRAL
from agentface.parameters import GROUPS as GROUPS_OF_PARAMETERS
from agentface.parameters import HELD, NAMES, PARAMETERS, parameter

KEYS = (
    ("1 .. 6", "more happiness, sadness, anger, fear, disgust, surprise"),
    ("Shift 1 .. 6", "less of it"),
    ("0  Backspace", "reset: neutral, everything released"),
    ("Space", "blink"),
    ("Ctrl Z", "undo"),
    ("Ctrl Shift Z", "redo"),
    ("F  T  P", "view: front, three-quarter, profile"),
    ("Q", "quality: fast, portrait"),
    ("S", "write a picture into the current folder"),
    ("R", "film into the current folder: start, stop"),
    ("F2", "panel: show, hide"),
    ("H  F1", "this help"),
    ("Esc", "quit"),
)
MOUSE = (
    ("drag", "look round the head"),
    ("right drag", "move the picture"),
    ("wheel", "nearer, farther"),
)
SLIDERS = (
    ("right click", "a slider back to rest"),
    ("Ctrl click", "type a number"),
)


def sides(muscle: str) -> tuple[str, ...]:
    """The parameters of a muscle of ``GROUPS``: two for a paired one."""
    return (muscle,) if muscle in NAMES else tuple(f"{muscle}_{side}" for side in SIDES)


_HELD = tuple(dict.fromkeys(name.removesuffix("_l").removesuffix("_r") for name in HELD))
GROUPS: dict[str, tuple[str, ...]] = {
    group.capitalize(): tuple(name for name in _HELD if parameter(sides(name)[0]).group == group)
    for group in GROUPS_OF_PARAMETERS
    if any(known.group == group and known.held for known in PARAMETERS)
}
"""Everything that is set by hand, what has two sides without its side."""

PRESETS: dict[str, dict[str, float]] = {
    **{emotion: {emotion: 1.0} for emotion in EMOTIONS},
    "pleasant surprise": {"happiness": 0.8, "surprise": 0.8},
    "bittersweet": {"happiness": 0.7, "sadness": 0.7},
    "sulking": {"sadness": 0.7, "anger": 0.7},
    "anguish": {"sadness": 0.8, "fear": 0.8},
    "alarm": {"fear": 0.8, "surprise": 0.8},
    "amused contempt": {"happiness": 0.6, "disgust": 0.6},
    NEUTRAL: {},
}


def help_text() -> str:
    """Keys and mouse as lines of plain text."""
    tables = (("keys", KEYS), ("mouse", MOUSE))
    return "\n".join(line for title, rows in tables for line in (title, *(f"  {key:<14} {does}" for key, does in rows)))
