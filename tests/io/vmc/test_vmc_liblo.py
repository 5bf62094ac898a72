"""Another implementation of OSC, liblo, reads what leaves for an avatar, and drives a face."""

from __future__ import annotations

import re
import socket
import time

import pytest
from liblo import oscdump, oscsend

from agentface import Face
from agentface.io.vmc.names import NAMES, names_of
from agentface.io.vmc.receiver import VmcReceiver
from agentface.io.vmc.sender import VmcSender
from agentface.live.loop import Frame
from tests.heads import head_model
from tests.tools import require
from tests.waiting import until

pytestmark = [pytest.mark.slow, pytest.mark.untraced]


@pytest.mark.parametrize("names", NAMES)
def test_oscdump_reads_a_frame(tmp_path, names):
    require("oscdump")
    face = Face(head_model())
    face.set_emotion("happiness", 0.5, fade=0.0)
    face.set_head(20.0, 0.0, fade=0.0)
    face.step(0.1)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as avatar:
        avatar.bind(("127.0.0.1", 0))
        with VmcSender(face, *avatar.getsockname(), names=names) as sender:
            sender.show(Frame(1.25, 0.0, face.pose, face.geometry))
        packet = avatar.recv(65536)
    known = names_of(names)
    lines = oscdump(packet, tmp_path, 7 + len(known) + 1)
    assert lines[:2] == ["/VMC/Ext/OK i 1", "/VMC/Ext/T f 1.250000"]
    assert lines[2].startswith('/VMC/Ext/Root/Pos sfffffff "root" 0.000000')
    assert [re.match(r'/VMC/Ext/Bone/Pos sfffffff "(\w+)" ', line)[1] for line in lines[3:7]] == [
        "Neck", "Head", "LeftEye", "RightEye",
    ]  # fmt: skip
    values = [re.fullmatch(r'/VMC/Ext/Blend/Val sf "(\w+)" (\d\.\d+)', line) for line in lines[7:-1]]
    assert tuple(value[1] for value in values) == known
    if names == "vrm0":
        assert float(values[0][2]) == pytest.approx(0.5, abs=1e-3)
    assert lines[-1].rstrip() == "/VMC/Ext/Blend/Apply"


def test_what_oscsend_sends_drives_the_face():
    require("oscsend")
    face = Face(head_model())
    with VmcReceiver(face, "127.0.0.1", 0) as receiver:
        oscsend(receiver.port, "/VMC/Ext/OK", "i", 1)
        oscsend(receiver.port, "/VMC/Ext/Blend/Val", "sf", "Joy", 1.0)
        oscsend(receiver.port, "/VMC/Ext/Bone/Pos", "sfffffff", "Head", *[0.0] * 6, 1.0)
        oscsend(receiver.port, "/VMC/Ext/Blend/Apply")

        def take_in():
            time.sleep(0.01)
            receiver.take_in(0.0)

        until(lambda: receiver.status["used"] == 4, take_in)
        face.step(0.05)
        assert face.pose["zygomaticus_major_l"] > 0.7
        assert receiver.status["loaded"] is True
