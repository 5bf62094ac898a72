"""What keys, mouse, sliders and buttons of the window do, without a window."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.errors import UnknownNameError
from agentface.parameters import CONTRACTIONS, HELD, PARAMETERS, parameter
from agentface.requests import Blink, Request, SetEmotion, SetEmotions, SetMuscle, SetParameter
from agentface.view.camera import Camera, named_view
from agentface.view.gl.quality import QUALITIES
from agentface.window.capture import Capture
from agentface.window.history import History, Values
from agentface.window.menu import PRESETS
from agentface.window.skull import SkullControls

if TYPE_CHECKING:
    from agentface.face import Face

STEP = 0.25
FADE_S = 0.35
LIVE_FADE_S = 0.06
"""Of a slider: it smooths the hand, and does not lag behind it."""
_TURN_PER_POINT = 0.008
_ZOOM_PER_NOTCH = 1.1
_FARTHEST_PAN_M = 0.3
_VIEW_KEYS = {"F": "front", "T": "three-quarter", "P": "profile"}

ANGLES = tuple(known.name for known in PARAMETERS if known.unit == "rad")


class Controls:
    """The face's emotions, muscles and angles, with undo; its skull; the camera; what is shown.

    Values are named: an emotion or a muscle with its side in 0..1, an angle such as ``gaze_yaw`` in degrees. A
    muscle of value None is not held: it moves with the emotion.
    """

    def __init__(self, face: Face, capture: Capture | None = None) -> None:
        self.face, self.capture = face, capture
        self.history = History()
        self.skull = SkullControls.of(face)
        """None for a face that is not of tissue."""
        self.camera: Camera = named_view(face.model, "front")
        self.quality = "fast"
        self.apart: set[str] = set()
        """The muscles whose two sides are set one by one."""
        self.helping = False
        self.panelled = True
        self.closing = False

    def values(self) -> dict[str, float | None]:
        """What the face goes to, by name."""
        held, turned = self.face.held, self.face.turned_deg
        return {
            **dict(self.face.emotion),
            **{name: held.get(name) for name in HELD},
            **{name: turned[name] for name in ANGLES},
        }

    def change(self, wanted: Values, gesture: str | None = None) -> None:
        """Set some values, forced into their ranges; one step of undo, or a part of that of ``gesture``.

        What is no number changes nothing. Raises UnknownNameError.
        """
        numbers = {name: value for name, value in wanted.items() if value is None or not math.isnan(value)}
        after = {name: _within(name, value) for name, value in numbers.items()}
        now = self.values()
        before = {name: now[name] for name in after}
        if after == before:
            return
        self.history.note(before, after, gesture)
        self._apply(after, LIVE_FADE_S if gesture else FADE_S)

    def settle(self) -> None:
        """A slider is let go of."""
        self.history.settle()

    def undo(self) -> None:
        """Take the last change back."""
        self._apply(self.history.undo(), FADE_S)

    def redo(self) -> None:
        """Do again what was undone last."""
        self._apply(self.history.redo(), FADE_S)

    def reset(self) -> None:
        """Neutral, everything released, straight ahead."""
        self.change(dict.fromkeys(EMOTIONS, 0.0) | dict.fromkeys(HELD) | dict.fromkeys(ANGLES, 0.0))

    def preset(self, name: str) -> None:
        """Set the six emotions to those of ``PRESETS[name]``."""
        self.change(dict.fromkeys(EMOTIONS, 0.0) | PRESETS[name])

    def look(self, view: str) -> None:
        """Go to the view ``front``, ``three-quarter`` or ``profile``."""
        self.camera = named_view(self.face.model, view)

    def part(self, muscle: str) -> None:
        """Set the two sides of a muscle one by one from now on, or together again."""
        self.apart ^= {muscle}

    def picture(self) -> None:
        """Write the next frame to a file."""
        if self.capture is not None:
            self.capture.picture_wanted = True

    def film(self) -> None:
        """Start to film, or stop."""
        if self.capture is not None:
            self.capture.film_wanted = not self.capture.film_wanted

    def key(self, name: str, *, shift: bool = False, ctrl: bool = False) -> None:
        """Press the key ``name`` (``1``, ``F``, ``Space``, ...); others do nothing."""
        if ctrl:
            if name in ("Z", "Y"):
                (self.redo if shift or name == "Y" else self.undo)()
        elif name in _EMOTION_KEYS:
            emotion = _EMOTION_KEYS[name]
            self.change({emotion: float(self.face.emotion[emotion]) + (-STEP if shift else STEP)})
        elif name in _VIEW_KEYS:
            self.look(_VIEW_KEYS[name])
        elif name == "Escape":
            self.closing, self.helping = not self.helping, False
        elif name in _ACTIONS:
            _ACTIONS[name](self)

    def drag(self, right: float, down: float) -> None:
        """Move the mouse with its left button held, in points: look round the head."""
        self.camera = self.camera.orbited(-_TURN_PER_POINT * right, _TURN_PER_POINT * down)

    def pan(self, right: float, down: float, height: float) -> None:
        """Move the mouse with another button held, in points: the picture, ``height`` points high, goes with it."""
        a_point = 2.0 * self.camera.distance * math.tan(0.5 * self.camera.field_of_view) / max(height, 1.0)
        moved = self.camera.panned(-right * a_point, down * a_point)
        if math.dist(moved.target, named_view(self.face.model, "front").target) <= _FARTHEST_PAN_M:
            self.camera = moved

    def wheel(self, notches: float) -> None:
        """Turn the wheel; away from the user is positive."""
        self.camera = self.camera.zoomed(_ZOOM_PER_NOTCH ** max(-8.0, min(8.0, notches)))

    def title(self) -> str:
        """The window's title: the face, what it feels, whether it is filmed."""
        felt = [f"{name} {value:.2f}" for name, value in self.face.emotion.items() if value > 0.0]
        filmed = self.capture.filmed_s if self.capture is not None else None
        filming = "" if filmed is None else f" - filming {filmed:.0f} s"
        return f"{self.face.model.name} - {', '.join(felt) or 'neutral'}{filming} - H for help"

    def _apply(self, values: Mapping[str, float | None], fade: float) -> None:
        for request in requests_of(values, fade):
            self.face.apply(request)


def requests_of(values: Mapping[str, float | None], fade: float) -> list[Request]:
    """What to ask of a face for it to show values named as those of :class:`Controls`."""
    emotions = {name: value for name, value in values.items() if name in EMOTIONS and value is not None}
    whole = len(emotions) == len(EMOTIONS)
    requests: list[Request] = [SetEmotions(EmotionState.of(emotions), fade)] if whole else []
    for name, value in values.items():
        if name in CONTRACTIONS:
            requests.append(SetMuscle(name, value, fade))
        elif name in HELD:
            requests.append(SetParameter(name, value, fade))
        elif name in ANGLES:
            requests.append(SetParameter(f"{name}_deg", value, fade))
        elif value is not None and not whole:
            requests.append(SetEmotion(name, value, fade))
    return requests


def bounds(name: str) -> tuple[float, float]:
    """The lowest and the highest value of an emotion, a muscle or an angle; raises UnknownNameError."""
    if name in EMOTIONS:
        return 0.0, 1.0
    if name not in HELD and name not in ANGLES:
        raise UnknownNameError("value", name, (*EMOTIONS, *HELD, *ANGLES))
    return parameter(name).bounds


def _within(name: str, value: float | None) -> float | None:
    low, high = bounds(name)
    if value is None:
        return None if name in HELD else 0.0
    return round(max(low, min(high, float(value))), 6)


def _toggle_quality(controls: Controls) -> None:
    names = tuple(QUALITIES)
    controls.quality = names[(names.index(controls.quality) + 1) % len(names)]


def _toggle_help(controls: Controls) -> None:
    controls.helping = not controls.helping


def _toggle_panel(controls: Controls) -> None:
    controls.panelled = not controls.panelled


_EMOTION_KEYS = {str(number): emotion for number, emotion in enumerate(EMOTIONS, start=1)}
_ACTIONS: dict[str, Callable[[Controls], object]] = {
    "0": Controls.reset,
    "Backspace": Controls.reset,
    "Space": lambda controls: controls.face.apply(Blink()),
    "Q": _toggle_quality,
    "S": Controls.picture,
    "R": Controls.film,
    "H": _toggle_help,
    "F1": _toggle_help,
    "F2": _toggle_panel,
}
