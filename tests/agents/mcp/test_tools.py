"""The tools, called by the SDK's own client in this process."""

from __future__ import annotations

import asyncio
import sys

import pytest

pytest.importorskip("mcp")

from mcp.client.client import Client

from agentface.agents.mcp.actor import Actor
from agentface.agents.mcp.report import FaceReport
from agentface.agents.mcp.server import face_server
from agentface.errors import MissingPackageError
from tests.agents.mcp.stepping import stepped
from tests.voices import FakeVoice, talking_face

NAMES = {
    *("set_emotion", "set_emotions", "set_mood", "neutral", "say", "hush", "gesture"),
    *("set_gaze", "look_at", "set_state", "status", "picture"),
}


@pytest.fixture(scope="module")
def voice():
    return FakeVoice()


@pytest.fixture(scope="module")
def actor(voice):
    with talking_face(voice) as face, stepped(face) as made:
        yield made


def called(actor, *calls):
    """What the client is answered to each (tool, arguments)."""

    async def run():
        async with Client(face_server(actor)) as client:
            return [await client.call_tool(name, arguments) for name, arguments in calls]

    return asyncio.run(run())


def refusal(actor, tool, arguments):
    (answer,) = called(actor, (tool, arguments))
    assert answer.is_error
    return answer.content[0].text


def report(answer):
    assert not answer.is_error, answer.content
    return FaceReport.model_validate(answer.structured_content)


def test_every_tool_says_what_it_takes_and_what_it_answers(actor):
    async def run():
        async with Client(face_server(actor)) as client:
            return (await client.list_tools()).tools

    tools = {tool.name: tool for tool in asyncio.run(run())}
    assert tools.keys() == NAMES
    for name, tool in tools.items():
        assert tool.description
        assert tool.input_schema["additionalProperties"] is False
        assert all("description" in taken for taken in tool.input_schema["properties"].values()), name
        assert name == "picture" or set(tool.output_schema["properties"]) == set(FaceReport.model_fields)
    assert tools["set_emotion"].input_schema["properties"]["intensity"]["maximum"] == 1
    assert "nod" in tools["gesture"].input_schema["properties"]["name"]["enum"]


def test_emotions_mood_and_neutral(actor):
    answers = called(
        actor,
        ("set_emotions", {"emotions": {}}),
        ("set_emotion", {"emotion": "joy", "intensity": 0.7}),
        ("set_emotion", {"emotion": "fear"}),
        ("set_emotions", {"emotions": {"anger": 0.5, "sad": 0.25}}),
        ("set_mood", {"emotions": {"happiness": 0.2}}),
        ("neutral", {}),
    )
    felt = [{name: level for name, level in report(answer).emotion.items() if level} for answer in answers]
    assert felt[1] == {"happiness": 0.7}
    assert felt[2] == {"happiness": 0.7, "fear": 0.8}
    assert felt[3] == {"anger": 0.5, "sadness": 0.25}
    assert report(answers[4]).mood["happiness"] == 0.2
    assert felt[5] == {"happiness": 0.2}


def test_gaze_state_and_gestures(actor):
    answers = called(
        actor,
        ("set_gaze", {"yaw_deg": 20, "pitch_deg": -5}),
        ("set_state", {"state": "thinking"}),
        ("gesture", {"name": "nod", "strength": 0.5}),
        ("look_at", {"x_m": 0.1, "y_m": 0.0, "z_m": 0.6}),
    )
    assert report(answers[1]).state == "thinking"
    assert not any(answer.is_error for answer in answers)
    assert actor.made.result().channels.gaze.point == (0.1, 0.0, 0.6)


def test_it_says_texts_and_tells_what_waits(actor, voice):
    called(actor, ("hush", {}))
    begun, waits, said = called(
        actor,
        ("say", {"text": "One. Two."}),
        ("say", {"text": "Three."}),
        ("say", {"text": "Four.", "wait": True}),
    )
    assert report(begun).texts[0] == "One. Two."
    assert report(waits).texts[-1] == "Three." or voice.said[-1] == "Three."
    assert report(said).texts == []
    assert voice.said[-4:] == ["One.", "Two.", "Three.", "Four."]


def test_it_is_hushed_and_interrupted(actor):
    answers = called(
        actor, ("say", {"text": "One. Two. Three."}), ("say", {"text": "Stop.", "interrupt": True}), ("hush", {})
    )
    assert report(answers[1]).texts == ["Stop."]
    assert report(answers[2]).texts == []


def test_a_voice_that_fails_is_an_error_at_once(actor):
    assert "no" in refusal(actor, "say", {"text": "Bad."})
    (after,) = called(actor, ("status", {}))
    assert report(after).speech_error == "no"


@pytest.mark.parametrize(
    ("tool", "arguments", "told"),
    [
        ("set_emotion", {"emotion": "hapiness"}, ["'hapiness'", "did you mean happiness", "Known: happiness, sadness"]),
        ("set_emotion", {"emotion": "xyzzy"}, ["known: happiness, sadness, anger, fear, disgust, surprise"]),
        ("set_emotion", {"emotion": "joy", "intensity": 7}, ["intensity", "0..1", "7"]),
        ("set_emotion", {"emotion": "joy", "intensity": "much"}, ["intensity", "valid number"]),
        ("set_emotion", {"emotion": "joy", "strength": 1}, ["strength", "not permitted"]),
        ("set_emotion", {"emotion": "joy", "fade_s": -1}, ["fade", "zero or more"]),
        ("set_emotion", {}, ["emotion", "required"]),
        ("set_emotions", {"emotions": {"joy": 2}}, ["0..1"]),
        ("set_mood", {"emotions": {"gloom": 1}}, ["'gloom'", "sadness"]),
        ("set_gaze", {"yaw_deg": 90}, ["yaw", "-50..50", "90"]),
        ("look_at", {"x_m": 0, "y_m": 0, "z_m": -1}, ["front of the eyes"]),
        ("gesture", {"name": "wave"}, ["'wave'", "nod"]),
        ("gesture", {"name": "nod", "strength": 2}, ["strength", "0..1"]),
        ("set_state", {"state": "asleep"}, ["'asleep'", "idle, listening, thinking, speaking"]),
        ("say", {"text": ""}, ["text"]),
        ("say", {"text": "Hello", "language": 5}, ["language"]),
        ("picture", {"camera": "above"}, ["front", "three-quarter", "profile"]),
    ],
)
def test_what_is_wrong_is_told_so_that_a_model_can_act(actor, tool, arguments, told):
    before = actor.made.result().channels.emotion.target
    text = refusal(actor, tool, arguments)
    assert [part for part in told if part not in text] == [], text
    assert actor.made.result().channels.emotion.target == before


@pytest.mark.gl
def test_a_picture_shows_the_face(actor):
    import base64
    from io import BytesIO

    from PIL import Image

    (answer,) = called(actor, ("picture", {"camera": "profile"}))
    assert answer.content[0].mime_type == "image/png"
    with Image.open(BytesIO(base64.b64decode(answer.content[0].data))) as image:
        assert image.size == (512, 512)
        assert len(image.convert("L").getcolors()) > 50


def test_a_face_that_has_ended_is_an_error(voice):
    with talking_face(voice) as face:
        actor = Actor(face.model)
        actor.made.set_result(face)
        actor.close()
        assert "ended" in refusal(actor, "neutral", {})


def test_who_asks_before_the_face_is_made_waits_for_it(actor):
    early, face = Actor(actor.model), actor.made.result()

    async def run():
        async with Client(face_server(early)) as client:
            asked = asyncio.create_task(client.call_tool("status", {}))
            assert (await client.list_tools()).tools
            assert not asked.done()
            early.made.set_result(face)
            while not asked.done():
                early.take_in()
                await asyncio.sleep(0.01)
            return await asked

    assert report(asyncio.run(run())).face == face.model.name
    early.close()


def test_who_waits_for_a_face_that_never_is_made_is_told(actor):
    early = Actor(actor.model)
    early.close()
    assert "ended" in refusal(early, "status", {})


def test_without_the_package_one_error_names_the_extra(actor, monkeypatch):
    monkeypatch.setitem(sys.modules, "mcp.server.mcpserver", None)
    with pytest.raises(MissingPackageError, match=r'pip install "agentface\[mcp\]"') as caught:
        face_server(actor)
    assert isinstance(caught.value, ImportError)
