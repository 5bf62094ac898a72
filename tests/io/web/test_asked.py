"""What is asked in JSON, beside the same over OSC."""

from __future__ import annotations

import json
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.errors import AgentFaceError, InvalidValueError, UnknownNameError
from agentface.io.osc.addresses import _READERS
from agentface.io.web.asked import ASKED, request_of
from agentface.io.web.errors_json import error_json
from agentface.io.web.openapi import openapi
from agentface.requests import Request

SAME = {
    "emotion": (["joy", 0.5, 0.2], {"emotion": "joy", "intensity": 0.5, "fade": 0.2}),
    "emotions": (["joy", 0.5, "fear", 0.1], {"emotions": {"joy": 0.5, "fear": 0.1}}),
    "mood": (["joy", 0.5], {"emotions": {"joy": 0.5}}),
    "neutral": ([0.5], {"fade": 0.5}),
    "say": (["Hello"], {"text": "Hello"}),
    "hush": ([], {}),
    "state": (["thinking"], {"state": "thinking"}),
    "liveliness": ([0.4], {"liveliness": 0.4}),
    "gaze": ([10.0, -5.0], {"yaw_deg": 10.0, "pitch_deg": -5.0}),
    "look_at": ([0.1, 0.0, 0.6], {"x": 0.1, "y": 0.0, "z": 0.6}),
    "head": ([1.0, 2.0, 3.0], {"yaw_deg": 1.0, "pitch_deg": 2.0, "roll_deg": 3.0}),
    "blink": ([], {}),
    "gesture": (["nod", 0.5], {"name": "nod", "strength": 0.5}),
    "viseme": (["aa", 0.5, 0.2], {"name": "aa", "weight": 0.5, "duration": 0.2}),
    "visemes": (["aa", 0.0, 0.1, "PP", 0.1, 0.2], {"phones": [["aa", 0.0, 0.1], ["PP", 0.1, 0.2]], "live": True}),
    "muscle": (["zygomaticus_major", 0.5], {"name": "zygomaticus_major", "contraction": 0.5}),
    "parameter": (["head_yaw_deg", 10.0], {"name": "head_yaw_deg", "value": 10.0}),
    "au": ([12, 0.5, "left"], {"number": 12, "intensity": 0.5, "side": "left"}),
    "arkit": (["jawOpen", 0.5], {"weights": {"jawOpen": 0.5}}),
    "fap": ([3, 100], {"number": 3, "value": 100}),
    "faps": ([0, 0, 1, *[0] * 65, 7], {"faps": {"3": 7}}),
    "bml": (["<bml id='a'/>"], {"bml": "<bml id='a'/>"}),
}


def test_everything_of_osc_can_be_asked():
    assert set(ASKED) == set(_READERS) == set(SAME)


@pytest.mark.parametrize("name", ASKED)
def test_by_name_and_in_osc_s_order_it_is_the_same(name):
    listed, named = SAME[name]
    assert request_of(name, json.loads(json.dumps(listed))) == request_of(name, json.loads(json.dumps(named)))
    assert isinstance(request_of(name, named), Request)


def test_a_button_that_is_let_go_of_asks_nothing():
    assert request_of("blink", [0]) is None


@pytest.mark.parametrize(
    ("name", "told"),
    [("emotion", {"emotion": "joy"}), ("emotion", {"emotion": "joy", "intensity": 2}), ("emotion", "joy"), ("say", {}),
     ("emotion", {"emotion": "joy", "intensity": 0.5, "loud": 1}), ("emotion", []), ("nothing", {}), (7, {}),
     (None, []), ("emotions", {"emotions": [1]}), ("arkit", {"weights": 3}), ("faps", {"faps": {"x": 1}}),
     ("bml", {"bml": 3}),
     ("visemes", {"phones": "aa"}), ("say", {"text": ["a"]}), ("state", {"state": {}}), ("gesture", {"name": [1]}),
     ("bml", {"bml": "<bml"}), ("muscle", {"name": {}, "contraction": 0.1}), ("hush", {"now": True})],
)  # fmt: skip
def test_what_cannot_be_meant_is_told(name, told):
    with pytest.raises(AgentFaceError) as raised:
        request_of(name, told)
    error = error_json(raised.value)["error"]
    assert set(error) == {"where", "expected", "got", "hint"}
    assert all(isinstance(text, str) for text in error.values())
    assert error["expected"]


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=20),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=12,
)


@given(name=st.sampled_from(list(ASKED)), data=st.data())
@settings(max_examples=250)
def test_nothing_that_is_told_disturbs(name, data):
    fields = st.sampled_from([*ASKED[name].fields, "other"])
    told = data.draw(json_values | st.dictionaries(fields, json_values, max_size=4) | st.lists(json_values, max_size=5))
    with suppress(UnknownNameError, InvalidValueError, AgentFaceError):
        request_of(name, told)


def test_the_document_names_everything():
    document = json.loads(json.dumps(openapi()))
    assert document["openapi"].startswith("3.1")
    for name, asked in ASKED.items():
        for path in (f"/{name}", f"/faces/{{face}}/{name}"):
            post = document["paths"][path]["post"]
            schema = post["requestBody"]["content"]["application/json"]["schema"]["oneOf"][0]
            assert set(schema["properties"]) == set(asked.fields)
            assert set(schema["required"]) <= set(asked.fields)
    operations = [ways["operationId"] for path in document["paths"].values() for ways in path.values()]
    assert len(operations) == len(set(operations))
