"""The processor in Pipecat's own test harness: make frameworks."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

pytest.importorskip("pipecat")

from pipecat.clocks.system_clock import SystemClock
from pipecat.frames.frames import (
    EndFrame,
    InterruptionFrame,
    LLMFullResponseStartFrame,
    OutputImageRawFrame,
    TTSAudioRawFrame,
    TTSStartedFrame,
    TTSStoppedFrame,
    TTSTextFrame,
    UserStartedSpeakingFrame,
)
from pipecat.tests.utils import SleepFrame, run_test

from agentface.agents import Drawing, Speaker
from agentface.agents.pipecat import FaceProcessor, FaceRequestFrame
from agentface.requests import SetEmotion
from tests.agents.speaking import noise
from tests.voices import talking_face

pytestmark = pytest.mark.frameworks

SIZE = 64, 48


@pytest.fixture(scope="module")
def face():
    with talking_face() as made:
        yield made


def sounds(sound, rate=16_000):
    """What a service says of a sound, 20 ms a frame."""
    step = rate // 50
    frames = [
        TTSAudioRawFrame(audio=sound[first : first + step].tobytes(), sample_rate=rate, num_channels=1)
        for first in range(0, len(sound), step)
    ]
    return [TTSStartedFrame(context_id="one"), *frames, TTSStoppedFrame(context_id="one")]


def passed(face, *frames, background="look", **options):
    """What comes out of the processor."""

    async def run():
        speaker = Speaker(face, Drawing(SIZE, background=background), rate_hz=16_000)
        processor = FaceProcessor(speaker, **options)
        down, up = await run_test(processor, frames_to_send=frames, start_timeout=60.0)
        return list(down), list(up)

    return asyncio.run(run())


def kinds(frames, *wanted):
    return [frame for frame in frames if isinstance(frame, wanted)]


def heard(frames):
    return np.frombuffer(b"".join(frame.audio for frame in kinds(frames, TTSAudioRawFrame)), np.int16)


def test_pictures_and_the_same_sound_come_between_its_start_and_its_stop(face):
    sound = noise(1.0)
    down, up = passed(face, *sounds(sound))
    assert up == []
    assert np.array_equal(heard(down), sound)
    ends = kinds(down, TTSStartedFrame, TTSStoppedFrame)
    assert [type(frame) for frame in ends] == [TTSStartedFrame, TTSStoppedFrame]
    places = [down.index(frame) for frame in kinds(down, TTSAudioRawFrame)]
    assert down.index(ends[0]) < min(places) <= max(places) < down.index(ends[1])
    assert {frame.context_id for frame in kinds(down, TTSAudioRawFrame)} == {"one"}
    images = kinds(down, OutputImageRawFrame)
    assert len(images) > 3
    assert all(image.sync_with_audio and image.format == "RGB" and image.size == SIZE for image in images)
    assert {len(image.image) for image in images} == {SIZE[0] * SIZE[1] * 3}


def test_a_transparent_background_goes_as_rgba(face):
    down, _ = passed(face, *sounds(noise(0.2)), background="transparent")
    image = kinds(down, OutputImageRawFrame)[0]
    assert image.format == "RGBA"
    assert np.frombuffer(image.image, np.uint8).reshape(SIZE[1], SIZE[0], 4)[0, 0, 3] == 0


def test_two_replies_keep_their_order(face):
    first, second = noise(0.5), noise(0.4, seed=1)
    down, _ = passed(face, *sounds(first), *sounds(second))
    order = [type(frame) for frame in kinds(down, TTSStartedFrame, TTSStoppedFrame)]
    assert order == [TTSStartedFrame, TTSStoppedFrame] * 2
    starts = [place for place, frame in enumerate(down) if isinstance(frame, TTSStartedFrame)]
    assert np.array_equal(heard(down[: starts[1]]), first)
    assert np.array_equal(heard(down[starts[1] :]), second)


def test_a_sound_without_an_end_is_heard_before_the_pipeline_ends(face):
    sound = noise(0.5)
    down, _ = passed(face, *sounds(sound)[:-1])
    assert np.array_equal(heard(down), sound)
    assert not kinds(down, EndFrame)  # the harness takes it out: it was the last


def test_an_interruption_silences_the_face(face):
    down, _ = passed(face, *sounds(noise(20.0)), SleepFrame(0.6), InterruptionFrame(), *sounds(noise(0.2, seed=1)))
    cut = down.index(kinds(down, InterruptionFrame)[0])
    assert len(heard(down[:cut])) < 20.0 * 16_000
    assert np.array_equal(heard(down[cut:])[-3200:], noise(0.2, seed=1))
    assert len(heard(down[cut:])) <= 3200 + 2 * 16_000  # at most what was on its way
    assert len(kinds(down, TTSStoppedFrame)) == 1


def test_it_listens_thinks_and_feels_as_frames_say(face):
    seen = []
    request = SetEmotion("happiness", 0.6, 0.0)
    face.noted.append(seen.append)
    down, _ = passed(
        face, UserStartedSpeakingFrame(), SleepFrame(0.2), LLMFullResponseStartFrame(), FaceRequestFrame(request),
        *sounds(noise(0.2)),
    )  # fmt: skip
    face.noted.remove(seen.append)
    states = [told.state for told in seen if type(told).__name__ == "SetState"]
    assert states == ["listening", "thinking", None]
    assert request in seen
    assert kinds(down, FaceRequestFrame)


def test_states_can_be_left_alone(face):
    seen = []
    face.noted.append(seen.append)
    passed(face, UserStartedSpeakingFrame(), *sounds(noise(0.2)), states=False)
    face.noted.remove(seen.append)
    assert not [told for told in seen if type(told).__name__ == "SetState"]


def test_words_with_times_move_the_mouth(face):
    """A hum that the words call mama: their times are on the pipeline's clock, which begins with the first sound."""
    hum = (1000 * np.sin(np.arange(24_000) / 20)).astype(np.int16)
    word = TTSTextFrame("mama", "word")
    seen, clock = [], SystemClock()

    async def run():
        speaker = Speaker(face, Drawing(SIZE), rate_hz=16_000)
        processor = FaceProcessor(speaker)
        tell = speaker.push_words
        speaker.push_words = lambda words: (seen.extend(words), tell(words))
        processor.get_clock = lambda: clock
        clock.start()
        word.pts = clock.get_time() + 300_000_000
        started, *rest = sounds(hum)
        frames = [started, rest[0], word, *rest[1:]]
        return await run_test(processor, frames_to_send=frames, start_timeout=60.0)

    down, _ = asyncio.run(run())
    assert [text for text, _ in seen] == ["mama"]
    assert 0.0 <= seen[0][1] <= 0.3
    assert word in down


def test_wrong_sound_is_an_error_frame_and_ends_nothing(face):
    from pipecat.frames.frames import ErrorFrame

    wrong = TTSAudioRawFrame(audio=b"abcd", sample_rate=10, num_channels=1)
    sound = noise(0.2)
    down, up = passed(face, wrong, *sounds(sound))
    assert "rate" in kinds(up, ErrorFrame)[0].error
    assert np.array_equal(heard(down), sound)
