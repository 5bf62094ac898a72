from __future__ import annotations

import os
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from agentface.errors import AgentFaceError, InvalidValueError, SpeechError, UnknownNameError
from agentface.speech.alphabets import phone_table
from agentface.speech.voices import espeak
from agentface.speech.voices.choose import open_voice
from agentface.speech.voices.espeak import Espeak
from agentface.speech.voices.flite import Flite
from agentface.speech.voices.voice import SILENCE, TOOL_S
from tests.tools import require, require_library
from tests.waiting import until


@pytest.fixture(scope="module")
def flite():
    require("flite")
    return Flite()


@pytest.fixture(scope="module")
def english():
    require_library("libespeak-ng.so.1")
    voice = Espeak("en-us")
    yield voice
    voice.close()


@pytest.fixture(params=["flite", "english"])
def voice(request):
    return request.getfixturevalue(request.param)


def symbols(utterance) -> list[str]:
    return [phone.symbol for phone in utterance.phones if phone.symbol != SILENCE]


def loudness(sound, start_s: float, end_s: float) -> float:
    part = sound.samples[round(start_s * sound.rate_hz) : round(end_s * sound.rate_hz)].astype(np.float64)
    return float(np.sqrt(np.mean(part**2)))


def test_phones_lie_where_they_are_heard(voice):
    found = voice.speak("Papa saw a big boat.")
    phones = found.phones
    assert phones[0].start_s == 0.0
    assert phones[-1].end_s <= found.sound.duration_s + 0.25
    assert all(a.end_s == pytest.approx(b.start_s, abs=1e-3) for a, b in pairwise(phones))
    assert symbols(found)[0] == "p"
    vowels = [
        p for p in phones if p.symbol in ("aa", "ao", "\u0251\u02d0", "\u0254\u02d0") and p.end_s - p.start_s > 0.05
    ]
    pauses = [p for p in phones if p.symbol == SILENCE and p.end_s - p.start_s > 0.1]
    for vowel in vowels:
        for pause in pauses:
            assert loudness(found.sound, vowel.start_s, vowel.end_s) > 5 * loudness(
                found.sound, pause.start_s + 0.05, pause.end_s
            )


def test_rate_and_repetition(voice):
    usual, slow, fast = (voice.speak("We were away a year ago.", rate) for rate in (1.0, 0.5, 2.0))
    assert slow.sound.duration_s > 1.3 * usual.sound.duration_s > 1.3**2 * fast.sound.duration_s
    again = voice.speak("We were away a year ago.")
    assert again.phones == usual.phones
    assert again.sound == usual.sound
    for wrong in (0.4, 2.1, float("nan"), "fast"):
        with pytest.raises(InvalidValueError, match="rate"):
            voice.speak("Yes.", wrong)


def test_marks_are_at_the_words(voice):
    text = "Yes, my tall friend"
    found = voice.speak(text, marks=[0, 5, 8, 10, 19])
    at = {phone.start_s: phone.symbol for phone in found.phones} | {
        next(phone.end_s for phone in reversed(found.phones) if phone.symbol != SILENCE): "end"
    }
    assert [at[min(at, key=lambda start: abs(start - mark))] for mark in found.marks_s] in (
        ["y", "m", "t", "t", "end"],
        ["j", "m", "t", "t", "end"],
        [SILENCE, "m", "t", "t", "end"],
    )
    assert list(found.marks_s) == sorted(found.marks_s)


@pytest.mark.parametrize(
    "text", ["-h", "--help", "-o x.wav", "/etc/passwd", "$(touch x)", "`id`", "a;b", "%s%n", "[[h@]]"]
)
def test_text_is_neither_an_option_nor_a_path(voice, text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert symbols(voice.speak(text))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("text", ["...", "", " "])
def test_what_cannot_be_pronounced_is_one_error(voice, text):
    with pytest.raises(InvalidValueError, match="can pronounce"):
        voice.speak(text)


def test_flite_reads_english_typography_and_no_other_script(flite):
    assert symbols(flite.speak("It’s naïve – “café”")) == symbols(flite.speak('It\'s naive - "cafe"'))  # noqa: RUF001
    with pytest.raises(InvalidValueError, match="--language"):
        flite.speak("привет")


def check_any_text(voice, text: str) -> None:
    try:
        found = voice.speak(text)
    except (InvalidValueError, SpeechError):
        return
    assert found.phones
    assert len(found.sound.samples)
    phone_table().looks([phone.symbol for phone in found.phones])


ANY_TEXT = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), min_size=1, max_size=60)


@settings(deadline=None, max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=ANY_TEXT)
def test_any_text_gives_an_utterance_or_one_error(voice, text):
    check_any_text(voice, text)


@pytest.mark.soak
@settings(deadline=None, max_examples=2000, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=ANY_TEXT)
def test_two_thousand_texts_do(voice, text):
    check_any_text(voice, text)


def test_languages_by_name(english):
    for language, code, sound in (
        ("de", "de", "ʃ"),
        ("German", "de", "ʃ"),
        ("french", "fr-fr", "ʃ"),
        ("pt-BR", "pt-br", "ʃ"),
    ):
        other = open_voice(language=language)
        assert isinstance(other, Espeak)
        assert other.language == code
        text = {"de": "Schön", "fr-fr": "Chat", "pt-br": "Chuva"}[code]
        assert symbols(other.speak(text))[0] == sound
        other.close()
    with pytest.raises(UnknownNameError, match="german"):
        Espeak("germann")
    assert "(" not in "".join(symbols(english.speak("Hello 你好")))


def test_voices_by_name(flite):
    assert open_voice().name == "slt"
    assert open_voice("rms", "en-gb").name == "rms"
    with pytest.raises(UnknownNameError, match="slt"):
        open_voice("slz")
    with pytest.raises(UnknownNameError, match="voice"):
        Flite("./voice.flitevox")
    with pytest.raises(InvalidValueError, match="English"):
        open_voice("slt", "de")
    assert open_voice("rms").speak("Yes.").sound != flite.speak("Yes.").sound


def fake(folder: Path, name: str, script: str) -> None:
    path = folder / name
    path.write_text("#!/bin/sh\n" + script)
    path.chmod(0o755)


FAULTS = {
    "says nothing": ("true", "nothing"),
    "is garbage": ("echo 'hello world'", "hello"),
    "is endless": ("exec yes pau:0.100", "no end"),
    "runs backward": ("echo hh:0.300 ax:0.200", "ax:0.200"),
    "is too long": ("echo hh:9999.0", "9999"),
    "writes no sound": ("echo pau:0.1 hh:0.3", "no sound"),
    "writes garbage": ("echo pau:0.1 hh:0.3; head -c 999 /dev/urandom > speech.wav", "no sound"),
    "fails": ("exit 3", "exit code 3"),
    "is killed": ("kill -SEGV $$", "exit code"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_program_that_fails_is_one_error(fault, tmp_path, monkeypatch):
    script, said = FAULTS[fault]
    fake(tmp_path, "flite", script)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    with pytest.raises(SpeechError, match=said):
        Flite().speak("Hello.")


@pytest.mark.slow
@pytest.mark.parametrize("script", ["sleep 1000", "sleep 1000 & echo $! > $PIDS; sleep 1000", "exec >&-; sleep 1000"])
def test_a_program_that_hangs_is_one_error_and_ends(script, tmp_path, monkeypatch):
    pids = tmp_path / "pids"
    fake(tmp_path, "flite", f"echo $$ > {pids}2\n" + script)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    monkeypatch.setenv("PIDS", str(pids))
    monkeypatch.setattr("agentface.speech.voices.flite.TOOL_S", 1.0)
    with pytest.raises(SpeechError, match="killed"):
        Flite().speak("Hello.", marks=[0, 1, 2])
    for pid in "".join(file.read_text() for file in tmp_path.glob("pids*")).split():
        until(lambda pid=pid: ended(int(pid)))


def ended(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


def test_a_missing_program_is_one_error_with_its_package(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(SpeechError, match="apt-get install flite"):
        Flite()


def test_without_flite_english_is_espeak_s(english, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    found = open_voice()
    assert isinstance(found, Espeak)
    found.close()
    with pytest.raises(SpeechError, match="flite"):
        open_voice("slt")


HEAD = "import sys, time, os, struct, json\ndef out(b): sys.stdout.buffer.write(b); sys.stdout.buffer.flush()\n"
LANGUAGES = (
    "n = struct.unpack('<I', sys.stdin.buffer.read(4))[0]; sys.stdin.buffer.read(n)\n"
    "b = json.dumps({'languages': {'en': ['en', 'gmw/en']}}).encode(); out(struct.pack('<I', len(b)) + b)\n"
)
ANSWER = "b = json.dumps({}).encode(); out(struct.pack('<I', len(b)) + b + b'x' * {})\n"
CHILD_FAULTS = {
    "dies": "sys.exit(3)",
    "prints garbage": "out(b'hello, here I am, what is it that you want?')",
    "tells a huge length": "out(b'\\xff' * 8)",
    "tells no object": ANSWER.format("[]", 0),
    "tells a huge sound": ANSWER.format("{'samples': 10**9}", 0),
    "tells a wrong sound": ANSWER.format("{'samples': 1, 'rate_hz': 0, 'phones': [], 'words': []}", 2),
    "tells wrong phones": ANSWER.format("{'samples': 1, 'rate_hz': 22050, 'phones': [['a']], 'words': []}", 2),
    "tells half": ANSWER.format("{'samples': 9}", 2) + "sys.exit(0)",
    "has no voice": ANSWER.format("{'error': 'no voice'}", 0),
}


@pytest.mark.parametrize("fault", CHILD_FAULTS)
def test_a_process_that_fails_is_one_error(fault, tmp_path, monkeypatch):
    script = tmp_path / "child.py"
    script.write_text(HEAD + LANGUAGES + CHILD_FAULTS[fault])
    monkeypatch.setattr(espeak, "_SCRIPT", script)
    voice = Espeak("en")
    with pytest.raises(SpeechError, match="espeak-ng"):
        voice.speak("Hello.")
    voice.close()


@pytest.mark.slow
def test_a_process_that_hangs_is_one_error_and_ends(tmp_path, monkeypatch):
    script = tmp_path / "child.py"
    script.write_text(HEAD + LANGUAGES + "out(b'\\x08')\ntime.sleep(1000)")
    monkeypatch.setattr(espeak, "_SCRIPT", script)
    voice = Espeak("en")
    pid = voice._child.pid
    monkeypatch.setattr(espeak, "TOOL_S", 1.0)
    with pytest.raises(SpeechError, match="espeak-ng"):
        voice.speak("Hello.")
    until(lambda: ended(pid))


def test_what_hangs_is_an_error_within_five_seconds():
    assert TOOL_S < 5.0


def test_a_missing_library_is_one_error_with_its_package(tmp_path, monkeypatch):
    script = tmp_path / "child.py"
    script.write_text(Path(espeak._SCRIPT).read_text().replace("libespeak-ng", "libnosuch"))
    monkeypatch.setattr(espeak, "_SCRIPT", script)
    with pytest.raises(SpeechError, match="apt-get install libespeak-ng1"):
        Espeak("en")


def test_a_process_that_died_is_started_anew(english):
    before = english.speak("Yes.")
    pid = english._child.pid
    os.kill(pid, 9)
    # the first of its threads may have ended before the others
    until(lambda: english._child._process.poll() is not None)
    assert english.speak("Yes.").sound == before.sound
    assert english._child.pid != pid


@pytest.mark.parametrize("ending", ["os.kill(os.getpid(), 9)", "os._exit(3)", "sys.exit(0)", "raise ValueError"])
def test_no_process_outlives_us(english, ending):
    program = (
        "import os, sys; from agentface.speech.voices.espeak import Espeak; voice = Espeak('en'); voice.speak('Yes.')\n"
        f"print(voice._child.pid, flush=True)\n{ending}"
    )
    done = subprocess.run([sys.executable, "-c", program], check=False, capture_output=True, text=True, timeout=240)
    until(lambda: ended(int(done.stdout)))


def test_a_program_ends_when_we_are_killed(tmp_path):
    require("setpriv")
    fake(tmp_path, "flite", f"echo $$ > {tmp_path}/pid; exec sleep 1000")
    program = "from agentface.speech.voices.flite import Flite; Flite().speak('Yes.')"
    path = f"{tmp_path}:{os.environ['PATH']}"
    with subprocess.Popen([sys.executable, "-c", program], env=os.environ | {"PATH": path}) as ours:
        until(lambda: (tmp_path / "pid").exists() and (tmp_path / "pid").read_text().strip())
        ours.kill()
    until(lambda: ended(int((tmp_path / "pid").read_text())))


def test_errors_are_of_the_tree():
    assert issubclass(SpeechError, AgentFaceError)
