"""The awaitable twins, with the face stepped in the same loop and in another thread."""

from __future__ import annotations

import asyncio
import inspect
import threading
from dataclasses import replace

import numpy as np
import pytest

from agentface import Face
from agentface.bml.block import Behavior, Block
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.motion.performance import Performance
from agentface.parameters import COUNT
from tests.voices import talking_face

TWINS = ("say", "speak", "gesture", "play", "play_block")
WAITS = Behavior("w", "wait", 1, None, (0.6,))


@pytest.fixture(params=["same loop", "another thread"])
def awaited(request):
    """Runs a coroutine function of a face that is stepped meanwhile: faster than time passes."""

    def in_the_loop(face, calls):
        async def steps():
            while True:
                face.step(0.02)
                await asyncio.sleep(0)

        async def both():
            stepping = asyncio.create_task(steps())
            try:
                return await asyncio.wait_for(calls(face), 60)
            finally:
                stepping.cancel()

        return asyncio.run(both())

    def in_a_thread(face, calls):
        over = threading.Event()

        def steps():
            while not over.wait(0.001):
                face.step(0.02)

        thread = threading.Thread(target=steps)
        thread.start()
        try:
            return asyncio.run(asyncio.wait_for(calls(face), 60))
        finally:
            over.set()
            thread.join()

    run = in_the_loop if request.param == "same loop" else in_a_thread

    def run_with(calls):
        with talking_face() as face:
            return run(face, calls)

    return run_with


@pytest.mark.parametrize("name", TWINS)
def test_a_twin_takes_what_the_call_takes(name):
    call, twin = (inspect.signature(getattr(Face, each)) for each in (name, f"{name}_async"))
    expected = [parameter for each, parameter in call.parameters.items() if each != "wait"]
    got = list(twin.parameters.values())
    assert [(p.name, p.default, p.kind) for p in got] == [(p.name, p.default, p.kind) for p in expected]


def test_one_after_the_other(awaited):
    async def calls(face):
        times = [face.channels.gestures.now_s]
        outcomes = []
        for call in (
            face.gesture_async("nod"),
            face.speak_async([("aa", 0.0, 0.5)]),
            face.play_async(Performance(np.array([0.0, 0.4]), np.zeros((2, COUNT)), np.zeros((2, COUNT)))),
            face.play_block_async(Block("b", (WAITS,))),
            face.say_async("One."),
        ):
            outcomes.append(await call)
            times.append(face.channels.gestures.now_s)
        return outcomes, np.diff(times), face.channels.gestures.gestures["nod"].length_s

    outcomes, took, nod = awaited(calls)
    assert outcomes == [True] * 5
    assert (took >= np.array([nod, 0.5, 0.4, 0.6, 1.0]) - 0.021).all()


def test_a_barge_in_cancels_what_is_said(awaited):
    async def calls(face):
        talk = asyncio.create_task(face.say_async("One. Two. Three. Four."))
        waiting = asyncio.create_task(face.say_async("Five."))
        while face.channels.speech.status is None:
            await asyncio.sleep(0)
        talk.cancel()
        with pytest.raises(asyncio.CancelledError):
            await talk
        second = await waiting
        while face.channels.speech.status is not None:
            await asyncio.sleep(0)
        return second, face.talker.texts

    assert awaited(calls) == (False, ())


def test_a_block_that_is_cancelled_ends(awaited):
    async def calls(face):
        long = asyncio.create_task(face.play_block_async(Block("long", (replace(WAITS, usual_s=(1e6,)),))))
        after = asyncio.create_task(face.play_block_async(Block("after", (WAITS,), "APPEND")))
        while len(face.blocks.blocks) < 2:
            await asyncio.sleep(0)
        long.cancel()
        return await after

    assert awaited(calls) is True


def test_hush_ends_the_wait(awaited):
    async def calls(face):
        from agentface.requests import Hush

        talk = asyncio.create_task(face.say_async("One. Two. Three. Four."))
        while face.channels.speech.status is None:
            await asyncio.sleep(0)
        await asyncio.wrap_future(face.ask(Hush()))
        return await talk

    assert awaited(calls) is False


def test_errors_come_out_of_the_await(awaited):
    async def calls(face):
        with pytest.raises(InvalidValueError):
            await face.say_async("")
        with pytest.raises(UnknownNameError):
            await face.speak_async([("quack", 0.0, 1.0)])
        with pytest.raises(UnknownNameError, match="nod"):
            await face.gesture_async("moonwalk")
        return await face.gesture_async("nod")

    assert awaited(calls) is True
