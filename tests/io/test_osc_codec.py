from __future__ import annotations

import math
import struct
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st
from osc_bytes import EMOTION, bundle, message, text
from pythonosc.osc_message_builder import OscMessageBuilder

from agentface.io.osc.codec import LARGEST_DATAGRAM, MalformedError, Message, address_of, decode, encode

words = st.text(st.characters(exclude_characters="\0", exclude_categories=["Cs"]), max_size=20)
numbers = st.floats(width=32, allow_nan=False)


def test_wire_bytes():
    assert decode(EMOTION) == [Message("/agentface/emotion", ("joy", 0.5))]


@given(st.lists(st.one_of(words, numbers), max_size=12))
def test_encode_matches_python_osc_and_comes_back(arguments):
    builder = OscMessageBuilder("/agentface/x")
    for argument in arguments:
        builder.add_arg(argument, "s" if isinstance(argument, str) else "f")
    packet = builder.build().dgram
    assert encode("/agentface/x", *arguments) == packet
    assert decode(packet) == [Message("/agentface/x", tuple(arguments))]


def test_every_type():
    packet = message("/a", "ifhds", 3, 0.5, 1 << 40, 0.25, "ä")
    assert decode(packet) == [Message("/a", (3, 0.5, 1 << 40, 0.25, "ä"))]
    assert decode(text("/a") + text(",TFNb") + struct.pack(">I", 5) + b"abcde\0\0\0")[0].arguments == (
        True,
        False,
        None,
        b"abcde",
    )
    assert decode(text("/a")) == [Message("/a", ())]


def test_symbols_impulses_and_arrays():
    assert decode(message("/a", "SfI", "joy", 0.5)) == [Message("/a", ("joy", 0.5, True))]
    assert decode(message("/a", "[sf][sf]", "joy", 0.5, "fear", 0.25)) == [Message("/a", ("joy", 0.5, "fear", 0.25))]
    assert decode(message("/a", "i[s[ff]T[]]d", 1, "x", 0.5, 0.25, 2.0)) == [
        Message("/a", (1, "x", 0.5, 0.25, True, 2.0))
    ]
    assert decode(message("/a", "[]")) == [Message("/a", ())]


@given(st.lists(st.sampled_from("sSifTFNI[]"), max_size=24))
def test_arrays_and_tags_do_not_change_what_is_read(tags):
    values = {"s": "word", "S": "symbol", "i": 7, "f": 0.5, "T": True, "F": False, "N": None, "I": True}
    sent = [values[tag] for tag in tags if tag in "sSif"]
    packet = message("/a", "".join(tags), *sent)
    depth = balanced = 0
    for tag in tags:
        depth += (tag == "[") - (tag == "]")
        balanced = min(balanced, depth)
    if depth == balanced == 0:
        assert decode(packet) == [Message("/a", tuple(values[tag] for tag in tags if tag not in "[]"))]
    else:
        with pytest.raises(MalformedError):
            decode(packet)


@pytest.mark.parametrize("drop", range(1, len(EMOTION)))
def test_every_truncation_is_malformed(drop):
    # Cut behind the address it is a whole message without arguments, which the OSC specification asks us to take.
    short = EMOTION[:-drop]
    if short == text("/agentface/emotion"):
        assert decode(short) == [Message("/agentface/emotion", ())]
    else:
        with pytest.raises(MalformedError):
            decode(short)


def test_a_cut_number_is_not_read_as_zero():
    with pytest.raises(MalformedError):
        decode(message("/agentface/emotion", "sf", "joy", 0.5)[:-4])
    with pytest.raises(MalformedError):
        decode(message("/agentface/emotion", "sf", "joy", 0.5) + b"\0\0\0\0")


def test_bundles_nest_and_inner_times_are_not_earlier():
    inner = bundle(message("/b"), date=100.0)
    later = bundle(message("/c"), date=3000.0)
    packet = bundle(message("/a"), inner, later, bundle(message("/d")), date=2000.0)
    dates = {item.address: item.date for item in decode(packet)}
    assert dates == pytest.approx({"/a": 2000.0, "/b": 2000.0, "/c": 3000.0, "/d": 2000.0})
    assert decode(bundle(message("/a")))[0].date is None
    assert decode(bundle()) == []


@pytest.mark.parametrize(
    "packet",
    [
        b"",
        b"\0",
        b"#bundle\0",
        b"#bundle\0" + bytes(7),
        b"#bundle\0" + bytes(8) + b"\xff\xff\xff\xfc",  # an element of size -4
        b"#bundle\0" + bytes(8) + b"\xff\xff\xff\xfc" * 100,
        b"#bundle\0" + bytes(8) + b"\0\0\0\0" * 100,
        b"#bundle\0" + bytes(8) + b"\x7f\xff\xff\xff/a\0\0",
        b"#bundle\0" + bytes(8) + b"\0\0\0\x04abcd",
        b"#bundle\0" + bytes(8) + b"\0\0",
        bundle(message("/a"), message("/agentface/emotion", "sf", "joy", 0.5)[:-4]),
        b"agentface/emotion\0\0\0",
        text("/a") + text("sf") + bytes(8),
        text("/a") + text(",Q"),
        text("/a") + text(",[["),
        text("/a") + text(",]["),
        text("/a") + text(",[f]f]") + bytes(8),
        text("/a") + text(",[ff]") + bytes(4),
        text("/a") + text("[f]") + bytes(4),
        text("/a") + text("," + "f" * 300) + bytes(1200),
        text("/a") + text(",b") + b"\xff\xff\xff\xf0" + bytes(8),
        text("/a") + text(",b") + b"\0\0\xff\xff" + bytes(8),
        text(b"/agentface/\xff\xfe") + text(","),
        text("/a") + text(",s") + text(b"\xc3\x28"),
        text("/a") + text(",s") + b"aaaa",
        bytes(LARGEST_DATAGRAM + 4),
        message("/" + "a" * LARGEST_DATAGRAM),
    ],
)
def test_malformed(packet):
    with pytest.raises(MalformedError):
        decode(packet)


def test_deep_nesting_is_refused():
    packet = message("/a")
    while len(packet) < 8000:
        packet = bundle(packet)
    with pytest.raises(MalformedError, match="nested"):
        decode(packet)


@given(st.binary(max_size=200), st.sampled_from([b"", b"#bundle\0", b"/agentface/emotion\0\0", b"/a\0\0,"]))
def test_any_bytes_decode_or_are_malformed(tail, head):
    try:
        messages = decode(head + tail)
    except MalformedError:
        return
    assert all(item.address.startswith("/") for item in messages)


@given(st.integers(0, len(EMOTION) - 1), st.integers(0, 255))
def test_any_changed_byte_decodes_or_is_malformed(place, value):
    packet = bytearray(bundle(EMOTION, EMOTION))
    packet[place] = value
    with suppress(MalformedError):
        decode(bytes(packet))


def test_numbers_that_are_none_pass_the_codec_for_the_reader_to_refuse():
    first, second = decode(message("/a", "ff", math.nan, math.inf))[0].arguments
    assert math.isnan(first)
    assert second == math.inf


def test_the_address_of_garbage_can_be_printed():
    assert address_of(b"\x00") == ""
    assert address_of(b"/agentface/\xff\x07x\0\0") == "/agentface/x"
    assert len(address_of(b"a" * 9000)) <= 64
