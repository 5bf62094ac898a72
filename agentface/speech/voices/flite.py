"""flite: English, small and fast, under a permissive licence; a program that is run for each sentence."""

from __future__ import annotations

import re
import shutil
import tempfile
import time
import unicodedata
import wave
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from agentface.errors import SpeechError, UnknownNameError
from agentface.speech.phones import Phone
from agentface.speech.sound import Sound
from agentface.speech.voices.program import run_program
from agentface.speech.voices.voice import SILENCE, TOOL_S, Voiced, cannot_pronounce, check_speech_rate, word_start

FLITE_VOICES = ("slt", "rms", "awb", "kal16", "kal")
_PAUSES = ("pau", "ssil", "h#")
_PHONE = re.compile(r"([a-z]{1,4}):(\d{1,4}\.\d{1,6})")
_LONGEST_S = 180.0
_OFF_S = 0.25
"""So much may the last phone end after the sound."""
_ASCII = str.maketrans(
    {"‘": "'", "’": "'", "“": '"', "”": '"', "–": "-", "—": " - ", "…": "...", "ß": "ss", "æ": "ae", "ø": "o", "ł": "l"}  # noqa: RUF001
)


class Flite:
    """One of flite's voices.

    Args:
        name: one of ``FLITE_VOICES``.

    Raises UnknownNameError for another name, SpeechError where there is no flite.
    """

    def __init__(self, name: str = FLITE_VOICES[0]) -> None:
        if name not in FLITE_VOICES:
            raise UnknownNameError("voice", name, FLITE_VOICES)
        self.name = name
        self._program = _program()

    def speak(self, sentence: str, rate: float = 1.0, marks: Sequence[int] = ()) -> Voiced:
        """Speak a sentence; letters that English does not have lose their accents."""
        stretch, end = 1.0 / check_speech_rate(rate), time.monotonic() + TOOL_S
        with tempfile.TemporaryDirectory(prefix="agentface-") as folder:
            phones = self._said(sentence, stretch, Path(folder), "speech.wav", end)
            sound = _sound(Path(folder) / "speech.wav")
            if all(phone.symbol == SILENCE for phone in phones):
                raise cannot_pronounce(sentence, self.name)
            if phones[-1].end_s > sound.duration_s + _OFF_S:
                raise _garbage(f"phones until {phones[-1].end_s:g} s of {sound.duration_s:g} s of sound")
            befores = [sentence[: word_start(sentence, mark)] for mark in marks]
            times = tuple(self._mark(before, phones, Path(folder), end) for before in befores)
        return Voiced(sound, phones, times)

    def pronounce(self, word: str) -> tuple[str, ...]:
        """The phones of a word in ARPAbet; raises InvalidValueError for one that it cannot pronounce."""
        with tempfile.TemporaryDirectory(prefix="agentface-") as folder:
            said = self._said(word, 1.0, Path(folder), "none", time.monotonic() + TOOL_S)
        phones = tuple(phone.symbol for phone in said if phone.symbol != SILENCE)
        if not phones:
            raise cannot_pronounce(word, self.name)
        return phones

    def close(self) -> None:
        """Nothing runs on."""

    def _mark(self, before: str, phones: Sequence[Phone], folder: Path, end: float) -> float:
        """When the first phone is heard that does not belong to the text ``before``: flite counts that text's own."""
        heard = [phone for phone in phones if phone.symbol != SILENCE]
        count = 0
        if any(character.isalnum() for character in before):
            count = sum(phone.symbol != SILENCE for phone in self._said(before, 1.0, folder, "none", end))
        return heard[count].start_s if count < len(heard) else heard[-1].end_s

    def _said(self, text: str, stretch: float, folder: Path, output: str, end: float) -> tuple[Phone, ...]:
        # -t takes what follows as text, whatever it begins with
        command = [self._program, "-voice", self.name, "--setf", f"duration_stretch={stretch:.4f}", "-psdur"]
        said = run_program([*command, "-o", output, "-t", _ascii(text)], folder, max(0.0, end - time.monotonic()))
        phones, start = [], 0.0
        for word in said.split():
            found = _PHONE.fullmatch(word)
            until = float(found[2]) if found else 0.0
            if found is None or not start < until <= _LONGEST_S:
                raise _garbage(word)
            phones.append(Phone(SILENCE if found[1] in _PAUSES else found[1], start, until))
            start = until
        if not phones:
            raise _garbage("nothing")
        return tuple(phones)


def _program() -> str:
    found = shutil.which("flite")
    if found is None:
        raise SpeechError("expected the program flite, got none; install it, on Debian:  apt-get install flite")
    return found


def _ascii(text: str) -> str:
    """As English writes it: flite spells out what is not ASCII, or leaves it out."""
    plain = unicodedata.normalize("NFKD", text.translate(_ASCII))
    return "".join(character if character.isascii() else " " for character in plain if not _joins(character))


def _joins(character: str) -> bool:
    return unicodedata.combining(character) != 0


def _sound(path: Path) -> Sound:
    try:
        with wave.open(str(path)) as file:
            shape = file.getnchannels(), file.getsampwidth()
            if shape != (1, 2) or file.getnframes() > _LONGEST_S * file.getframerate():
                raise _garbage(f"{shape[0]} channels of {8 * shape[1]} bits, {file.getnframes()} samples")
            samples = np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(np.int16)
            return Sound(samples, file.getframerate())
    except (OSError, EOFError, wave.Error, ValueError) as error:
        raise _garbage(f"no sound: {error}") from error


def _garbage(got: str) -> SpeechError:
    return SpeechError(f"expected flite to tell phones and write a sound, got {got[:60]!r}")
