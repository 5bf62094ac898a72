"""espeak-ng in a process of its own, which is run as a program: its licence and its faults stay in here.

Takes requests from its standard input until that ends, and answers on its standard output. Both are a JSON object with
its length before it (4 bytes, little-endian); the samples, 16 bits each, follow an answer that has ``samples``.

    {"text": ..., "voice": "gmw/de", "rate": 1.0}   ->  {"rate_hz": ..., "phones": [[ms, IPA], ...],
                                                     "words": [[ms, place from 1], ...], "samples": count}
    {}                                          ->  {"languages": {name or code in lower case: [code, voice]}}

An answer with ``error`` says why there is none.
"""

from __future__ import annotations

import ctypes
import json
import os
import select
import signal
import struct
import sys
from typing import Any

_LIBRARIES = ("libespeak-ng.so.1", "libespeak-ng.so", "libespeak-ng.1.dylib", "libespeak-ng.dll")
_SYNCHRONOUS, _PHONEME_EVENTS, _IPA, _DONT_EXIT = 2, 0x1, 0x2, 0x8000
_UTF8, _END_PAUSE, _RATE, _OK = 0x1, 0x1000, 1, 0
_WORD, _PHONEME = 1, 7
_USUAL_WORDS_A_MINUTE = 175
_MOST_SAMPLES = 180 * 22050
_MOST_VOICES, _MOST_CODES = 1000, 20


class _Id(ctypes.Union):
    _fields_ = [("number", ctypes.c_int), ("name", ctypes.c_char_p), ("string", ctypes.c_char * 8)]


class _Event(ctypes.Structure):
    _fields_ = [
        ("type", ctypes.c_int),
        ("unique_identifier", ctypes.c_uint),
        ("text_position", ctypes.c_int),
        ("length", ctypes.c_int),
        ("audio_position", ctypes.c_int),
        ("sample", ctypes.c_int),
        ("user_data", ctypes.c_void_p),
        ("id", _Id),
    ]


class _Voice(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char_p), ("languages", ctypes.c_void_p), ("identifier", ctypes.c_char_p)]


_Callback = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int, ctypes.POINTER(_Event))


class _Espeak:
    """The library, once it is loaded."""

    def __init__(self) -> None:
        self._library = _load()
        self.rate_hz = self._library.espeak_Initialize(_SYNCHRONOUS, 0, None, _PHONEME_EVENTS | _IPA | _DONT_EXIT)
        if self.rate_hz <= 0:
            raise OSError("espeak-ng finds no data")
        self._library.espeak_ListVoices.restype = ctypes.POINTER(ctypes.POINTER(_Voice))
        self._heard = _Callback(self._hear)
        self._library.espeak_SetSynthCallback(self._heard)
        self._samples = bytearray()
        self._phones: list[tuple[int, str]] = []
        self._words: list[tuple[int, int]] = []

    def languages(self) -> dict[str, tuple[str, str]]:
        """The code and the voice of each language, by its codes and by its name in lower case."""
        found: dict[str, tuple[int, str, str]] = {}
        voices = self._library.espeak_ListVoices(None)
        for number in range(_MOST_VOICES):
            if not voices[number]:
                break
            voice = voices[number].contents
            codes = _codes(voice.languages)
            if not codes:
                continue
            own, file = codes[0][1], (voice.identifier or b"").decode("utf-8", "replace")
            name = (voice.name or b"").decode("utf-8", "replace").lower()
            # the voice that is the first choice for a language, such as fr, is also meant by the plain name
            plain = [(rank, name.partition(" (")[0]) for rank, code in codes if "-" not in code]
            for rank, known in (*codes, (0, name), *plain):
                found[known.lower()] = min(found.get(known.lower(), (rank, own, file)), (rank, own, file))
        return {known: (own, file) for known, (_, own, file) in found.items()}

    def speak(self, text: str, voice: str, rate: float) -> tuple[dict[str, Any], bytes]:
        """What is heard of ``text``, and when."""
        if self._library.espeak_SetVoiceByName(voice.encode()) != _OK:
            return {"error": f"no voice {voice}"}, b""
        self._library.espeak_SetParameter(_RATE, round(_USUAL_WORDS_A_MINUTE * rate), 0)
        data = text.encode("utf-8", "replace")
        flags = _UTF8 | _END_PAUSE
        self._library.espeak_Synth(data, ctypes.c_size_t(len(data) + 1), 0, 1, 0, flags, None, None)
        self._library.espeak_Synchronize()
        answer = {"rate_hz": self.rate_hz, "phones": self._phones, "words": self._words}
        return answer | {"samples": len(self._samples) // 2}, bytes(self._samples)

    def _hear(self, wave: Any, count: int, events: Any) -> int:
        if wave and count > 0:
            self._samples += ctypes.string_at(wave, 2 * count)
        place = 0
        while events[place].type:
            event = events[place]
            if event.type == _PHONEME:
                self._phones.append((event.audio_position, event.id.string.decode("utf-8", "ignore")))
            elif event.type == _WORD:
                self._words.append((event.audio_position, event.text_position))
            place += 1
        return int(len(self._samples) > 2 * _MOST_SAMPLES)  # 1 stops it


def _codes(place: int | None) -> list[tuple[int, str]]:
    """The codes of languages at an address, each with the voice's rank for it, 1 the best."""
    codes: list[tuple[int, str]] = []
    while place and (rank := ctypes.string_at(place, 1)[0]) and len(codes) < _MOST_CODES:
        code = ctypes.string_at(place + 1)
        codes.append((rank, code.decode("utf-8", "replace")))
        place += len(code) + 2
    return codes


def _load() -> Any:
    for name in _LIBRARIES:
        try:
            return ctypes.CDLL(name)
        except OSError:
            continue
    raise OSError("missing")


def _answer(espeak: _Espeak, request: dict[str, Any]) -> tuple[dict[str, Any], bytes]:
    if not request:
        return {"languages": espeak.languages()}, b""
    return espeak.speak(request["text"], request["voice"], request["rate"])


def _tell(answer: dict[str, Any], samples: bytes = b"") -> None:
    content = json.dumps(answer).encode()
    sys.stdout.buffer.write(struct.pack("<I", len(content)) + content + samples)
    sys.stdout.buffer.flush()


def _in_a_copy(espeak: _Espeak, request: dict[str, Any]) -> bool:
    """Answer in a copy of this process: what espeak-ng spoke before would change how it speaks, and it may crash.

    Returns whether it was done before our standard input ended.
    """
    ended, end = os.pipe()
    copy = os.fork()
    if copy == 0:
        try:
            os.close(ended)
            _tell(*_answer(espeak, request))
        finally:
            os._exit(0)
    os.close(end)
    waiting = select.poll()
    waiting.register(ended, select.POLLIN)
    waiting.register(sys.stdin.fileno(), 0)  # tells nothing but its end
    done = ended in {pipe for pipe, _ in waiting.poll()}
    os.close(ended)
    if not done:
        os.kill(copy, signal.SIGKILL)
    os.waitpid(copy, 0)
    return done


def main() -> None:
    """Serve until the standard input ends."""
    espeak, failure = None, ""
    try:
        espeak = _Espeak()
    except OSError as error:
        failure = str(error)
    while len(head := sys.stdin.buffer.read(4)) == 4:
        request = json.loads(sys.stdin.buffer.read(struct.unpack("<I", head)[0]))
        if espeak is None:
            _tell({"error": failure})
        elif not _in_a_copy(espeak, request):
            return


if __name__ == "__main__":
    main()
