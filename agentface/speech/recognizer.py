"""pocketsphinx' decoder, as this project sets it up; English."""

from __future__ import annotations

from typing import Any

from agentface.errors import SpeechError

HEARD_HZ = 16_000
"""Samples a second of what it hears."""
FRAME_S = 0.01
"""What it tells is in frames of so many seconds."""
QUIET = 30.0
"""Root mean square of 16 bits: what is not louder is no speech, whatever the recogniser makes of it."""
_LOOP = {"lw": 1.0, "beam": 1e-30, "pbeam": 1e-30}
"""What it expects of the order of phones counts little beside what it hears, and it drops no path early: with its own
values, which are for words, it hears half as many lips that close."""
_MEAN = "51.5,3.65,12.4,18.3,7.15,3.70,7.98,-13.3,-10.2,-10.6,12.2,1.59,4.10"
"""The mean cepstrum that it begins with where sound is heard while it comes, until it has heard enough of its own: that
of flite's voices kal, slt and rms. Without it, it hears a tenth less of the lips that close in a first sentence."""
_NO_POCKETSPHINX = """expected the Python package pocketsphinx, got none; it hears what is said in a recording.
Install the extra that has it:  pip install "agentface[speech]\""""


def open_recognizer(*, phone_loop: bool) -> Any:
    """A ``pocketsphinx.Decoder``: a loop of all phones, or one with a dictionary that aligns texts.

    Raises SpeechError where there is no pocketsphinx, or where it does not load its model.
    """
    check_recognizer()
    from pocketsphinx import Decoder, get_model_path

    try:
        if phone_loop:
            model = get_model_path("en-us/en-us-phone.lm.bin")
            return Decoder(allphone=model, lm=None, cmninit=_MEAN, loglevel="FATAL", **_LOOP)
        return Decoder(lm=None, loglevel="FATAL")
    except (RuntimeError, ValueError) as error:
        raise SpeechError(f"expected pocketsphinx to load its model, got: {error}") from error


def check_recognizer() -> None:
    """Raise SpeechError where there is no pocketsphinx."""
    try:
        import pocketsphinx  # noqa: F401
    except ImportError as error:
        raise SpeechError(_NO_POCKETSPHINX) from error


def heard_parts(decoder: Any) -> list[tuple[str, int, int]]:
    """What it makes of what it has heard so far: names, first frames and the frames after the last."""
    return [(part.word, part.start_frame, part.end_frame + 1) for part in decoder.seg() or ()]


def is_filler(name: str) -> bool:
    """Whether a name of the recogniser's stands for no speech."""
    return name == "SIL" or name[:1] in ("<", "[", "+")
