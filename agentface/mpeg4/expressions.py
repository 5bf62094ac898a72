"""FAP 2: the six expressions of MPEG-4 (ISO/IEC 14496-2, Annex C), which are the face's own emotions."""

from __future__ import annotations

from agentface.conventions import Floats
from agentface.emotion.inference import Inference, default_inference
from agentface.emotion.state import EmotionState
from agentface.mpeg4.visemes import BLEND_STEPS, check_step

EXPRESSIONS: tuple[str | None, ...] = (None, "happiness", "sadness", "anger", "fear", "disgust", "surprise")
"""By the number that FAP 2 selects; 0 is none."""


def expression_pose(
    first: int, first_intensity: int, second: int, second_intensity: int, inference: Inference | None = None
) -> Floats:
    """``(COUNT,)`` float32, what the rules make of two expressions at intensities of 0..63.

    One that is selected twice counts by the sum of both.

    Raises InvalidValueError for numbers that are no expressions or no intensities.
    """
    for place, (number, intensity) in enumerate(((first, first_intensity), (second, second_intensity)), start=1):
        check_step(f"expression_select{place}", number, len(EXPRESSIONS) - 1)
        check_step(f"expression_intensity{place}", intensity, BLEND_STEPS)
    state: dict[str, float] = {}
    for number, intensity in ((first, first_intensity), (second, second_intensity)):
        name = EXPRESSIONS[int(number)]
        if name is not None:
            state[name] = min(1.0, state.get(name, 0.0) + intensity / BLEND_STEPS)
    return (inference or default_inference()).pose(EmotionState.of(state)).array
