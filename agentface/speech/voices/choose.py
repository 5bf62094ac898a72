"""Which voice speaks: by its name, or by the language and what the machine has."""

from __future__ import annotations

from agentface.errors import InvalidValueError, SpeechError, UnknownNameError
from agentface.speech.voices.espeak import ESPEAK, Espeak
from agentface.speech.voices.flite import FLITE_VOICES, Flite
from agentface.speech.voices.voice import Voice

ENGLISH = "en"
VOICES = (*FLITE_VOICES, ESPEAK)
_NONE = (
    "expected a voice on this machine, got neither the program flite nor the library libespeak-ng.so.1; "
    "install one, on Debian:  apt-get install flite  (or libespeak-ng1, which has more languages)"
)


def check_voice(voice: str | None, language: str) -> None:
    """Raise UnknownNameError or InvalidValueError for a voice that nobody knows, or that lacks the language."""
    if voice is not None and voice not in VOICES:
        raise UnknownNameError("voice", voice, VOICES)
    if not isinstance(language, str):
        raise InvalidValueError("language", "its name or its code, like german or de", language)
    if voice in FLITE_VOICES and not _english(language):
        raise InvalidValueError("language", f"English for the voice {voice}", language, f"or choose the voice {ESPEAK}")


def open_voice(voice: str | None = None, language: str = ENGLISH) -> Voice:
    """The voice of this name, or, for None, the best there is for the language: flite for English, else espeak-ng.

    Raises UnknownNameError, InvalidValueError for a voice that does not speak the language, SpeechError for one that
    the machine does not have.
    """
    check_voice(voice, language)
    if voice in FLITE_VOICES:
        return Flite(voice)
    if voice == ESPEAK or not _english(language):
        return Espeak(language)
    try:
        return Flite()
    except SpeechError:
        try:
            return Espeak(language)
        except SpeechError as error:
            raise SpeechError(_NONE) from error


def _english(language: str) -> bool:
    return language.strip().lower().partition("-")[0] in (ENGLISH, "english")
