"""How emotions come and go: their envelopes, and what the face makes of a change, with pairs of muscles and without."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Doubles
from agentface.emotion.envelopes import default_envelopes
from agentface.emotion.inference import default_inference
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.motion.course import LAG_S
from agentface.motion.emotion import EmotionChannel
from agentface.motion.pairs import Pairs
from agentface.parameters import MUSCLES, NAMES, indices_of
from agentface.studies.figures.line_chart import ChartLine, LineChart
from agentface.view.contact_sheet import png, sheet

if TYPE_CHECKING:
    from PIL.Image import Image

_STEP_S = 0.005
_SIZE = (620, 330)
_NONE = Pairs(np.zeros(0, np.int32), np.zeros(0, np.int32), np.zeros((0, 2)))
_CORNERS = ("zygomaticus_major", "risorius", "depressor_anguli_oris", "depressor_supercilii")

Script = Callable[[EmotionChannel], None]


def figures(face: str | Path) -> dict[str, bytes]:
    """``envelopes.png``: the same for every ``face``."""
    del face
    panels = [
        (_envelopes(), "each emotion in its own time", "thin: the pure ramps of happiness"),
        (_onset(), "happiness comes", "thin: its intensity"),
        (_change(), "happiness goes over into anger", "thin: if no muscle waited for another"),
        (_mood(), "disgust for a moment, over a happy mood", "thin: the intensities"),
    ]
    return {"envelopes.png": png(sheet(panels, columns=2))}


def course(scripts: dict[float, Script], seconds: float, pairs: Pairs | None = None) -> tuple[Doubles, Doubles]:
    """The intensities ``(T, 6)`` and contractions ``(T, len(MUSCLES))`` of a face that is told things at times."""
    channel = EmotionChannel(default_inference(), pairs=pairs)
    places = [channel.names.index(NAMES[indices_of(muscle)[0]]) for muscle in MUSCLES]
    left, levels, contractions = dict(scripts), [], []
    for time in _times(seconds).tolist():
        for due in [due for due in left if due <= time + 1e-9]:
            left.pop(due)(channel)
        values = np.zeros(len(channel.names))
        channel.write(values, np.ones_like(values))
        levels.append(channel.intensities)
        contractions.append(values[places])
        channel.advance(_STEP_S)
    return np.array(levels), np.array(contractions)


def _times(seconds: float) -> Doubles:
    return _STEP_S * np.arange(round(seconds / _STEP_S) + 1.0)


def _envelopes() -> Image:
    seconds, envelopes, place = 7.0, default_envelopes(), EMOTIONS.index("happiness")
    levels, _ = course(
        {0.0: lambda channel: channel.change(dict.fromkeys(EMOTIONS, 1.0), None, "own")},
        seconds,
    )
    times = _times(seconds)
    onset, offset = envelopes.onset_s[place], envelopes.offset_s[place]
    gone = times - onset - envelopes.apex_s[place]
    rises = np.exp2(np.clip(times / (onset - LAG_S), 0.0, 1.0)) - 1.0
    falls = np.exp2(1.0 - np.clip(gone / (offset - LAG_S), 0.0, 1.0)) - 1.0
    lines = [ChartLine(emotion, levels[:, number], number) for number, emotion in enumerate(EMOTIONS)]
    return LineChart(
        times, [*lines, ChartLine("", np.where(gone < 0.0, rises, falls), 7, thin=True)], size=_SIZE
    ).picture()


def _onset() -> Image:
    levels, contractions = course({0.0: lambda channel: channel.change({"happiness": 1.0}, None, None)}, 0.8)
    muscles = ("zygomaticus_major", "orbicularis_oculi_lateralis", "risorius", "jaw_open")
    return _chart(0.8, contractions, muscles, [ChartLine("", levels[:, 0], 7, thin=True)])


def _change() -> Image:
    scripts: dict[float, Script] = {
        0.0: lambda channel: channel.change({"happiness": 1.0}, 0.0, None),
        0.2: lambda channel: channel.change(EmotionState.of(anger=1.0), None, None),
    }
    _, contractions = course(scripts, 1.4)
    _, free = course(scripts, 1.4, _NONE)
    thin = [ChartLine("", free[:, MUSCLES.index(name)], number, thin=True) for number, name in enumerate(_CORNERS)]
    return _chart(1.4, contractions, _CORNERS, thin)


def _mood() -> Image:
    scripts: dict[float, Script] = {
        0.0: lambda channel: channel.change_mood(EmotionState.of(happiness=0.5), 0.0),
        0.3: lambda channel: channel.change({"disgust": 0.9}, None, 0.8),
    }
    levels, contractions = course(scripts, 3.2)
    muscles = ("zygomaticus_major", "depressor_anguli_oris", "nasalis", "levator_labii_superioris")
    shown = [ChartLine("", levels[:, EMOTIONS.index(name)], 7, thin=True) for name in ("happiness", "disgust")]
    return _chart(3.2, contractions, muscles, shown)


def _chart(seconds: float, contractions: Doubles, muscles: tuple[str, ...], thin: list[ChartLine]) -> Image:
    lines = [ChartLine(name, contractions[:, MUSCLES.index(name)], number) for number, name in enumerate(muscles)]
    return LineChart(_times(seconds), [*lines, *thin], size=_SIZE).picture()
