"""The generator as LiveKit's runner asks it, without a room: make frameworks."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest

pytest.importorskip("livekit.agents")

from livekit import rtc
from livekit.agents.types import USERDATA_TIMED_TRANSCRIPT, TimedString
from livekit.agents.voice.avatar import AudioSegmentEnd, AvatarRunner, QueueAudioOutput

from agentface.agents import Drawing, Speaker
from agentface.agents.livekit import FaceVideoGenerator
from agentface.errors import InvalidValueError
from tests.agents.speaking import noise
from tests.voices import talking_face

pytestmark = pytest.mark.frameworks

SIZE = 64, 48


@pytest.fixture(scope="module")
def face():
    with talking_face() as made:
        yield made


def frames_of_sound(sound, rate=16_000):
    step = rate // 50
    return [
        rtc.AudioFrame(sound[first : first + step].tobytes(), rate, 1, len(sound[first : first + step]))
        for first in range(0, len(sound), step)
    ]


def run_with(face, use, **drawing):
    async def run():
        generator = FaceVideoGenerator(Speaker(face, Drawing(SIZE, **drawing), rate_hz=16_000))
        try:
            return await use(generator)
        finally:
            await generator.aclose()

    return asyncio.run(run())


async def until_end(generator):
    got = []
    async for frame in generator:
        got.append(frame)
        if isinstance(frame, AudioSegmentEnd):
            return got
    raise AssertionError("it ended without a mark")


def heard(frames):
    sounds = [np.frombuffer(bytes(f.data.cast("B")), np.int16) for f in frames if isinstance(f, rtc.AudioFrame)]
    return np.concatenate([np.zeros(0, np.int16), *sounds])


def test_sound_goes_in_pictures_and_the_same_sound_come_out(face):
    sound = noise(1.0)

    async def use(generator):
        for frame in frames_of_sound(sound):
            await generator.push_audio(frame)
        await generator.push_audio(AudioSegmentEnd())
        return await until_end(generator)

    got = run_with(face, use)
    assert np.array_equal(heard(got), sound)
    pictures = [frame for frame in got if isinstance(frame, rtc.VideoFrame)]
    assert {(frame.width, frame.height, frame.type) for frame in pictures} == {(*SIZE, rtc.VideoBufferType.RGB24)}
    assert pictures[0].convert(rtc.VideoBufferType.I420).width == SIZE[0]


def test_pictures_come_while_nobody_speaks(face):
    async def use(generator):
        got = []
        async for frame in generator:
            got.append(frame)
            if len(got) == 3:
                return got
        return got

    got = run_with(face, use, background="transparent")
    assert [frame.type for frame in got] == [rtc.VideoBufferType.RGBA] * 3


def test_a_cleared_buffer_is_silent(face):
    async def use(generator):
        for frame in frames_of_sound(noise(10.0)):
            await generator.push_audio(frame)
        generator.clear_buffer()
        sound = noise(0.2, seed=1)
        for frame in frames_of_sound(sound):
            await generator.push_audio(frame)
        await generator.push_audio(AudioSegmentEnd())
        return sound, await until_end(generator)

    sound, got = run_with(face, use)
    assert np.array_equal(heard(got), sound)


def test_words_with_times_are_told(face):
    async def use(generator):
        words = []
        generator.speaker.push_words = words.extend
        frame = frames_of_sound(noise(0.1))[0]
        frame.userdata[USERDATA_TIMED_TRANSCRIPT] = [
            TimedString("Hello ", start_time=0.1, end_time=0.4), TimedString("you", start_time=0.4), "untimed",
        ]  # fmt: skip
        await generator.push_audio(frame)
        return words

    words = run_with(face, use)
    assert [(word.text, word.start_s, word.end_s) for word in words] == [("Hello", 0.1, 0.4), ("you", 0.4, None)]


class Room(rtc.EventEmitter):
    """A room that never is connected."""

    def isconnected(self):
        return False


def test_livekit_s_runner_takes_it_with_its_options(face):
    async def use(generator):
        runner = AvatarRunner(
            Room(), audio_recv=QueueAudioOutput(sample_rate=16_000), video_gen=generator, options=generator.options
        )
        await runner.start()
        await asyncio.sleep(0)
        await runner.aclose()
        return generator.options

    options = run_with(face, use)
    assert (options.video_width, options.video_height, options.audio_channels) == (*SIZE, 1)
    assert (options.video_fps, options.audio_sample_rate) == (25.0, 16_000)


def test_a_speaker_that_does_not_draw_is_refused(face):
    with Speaker(face, None) as speaker, pytest.raises(InvalidValueError, match="drawing"):
        FaceVideoGenerator(speaker)
