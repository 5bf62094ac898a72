"""An agent that feels and speaks, in another process than the face: it sends emotions and words over OSC.

Start ``agentface serve --view window`` first, then ``python examples/osc_agent.py``. The words need a voice where the
face runs, such as flite; with ``--phones examples/hello.json`` the mouth says a recording's instead.
"""

from __future__ import annotations

import argparse
import json
import select
import socket
import time
from contextlib import suppress
from pathlib import Path

from pythonosc.osc_message import OscMessage
from pythonosc.osc_message_builder import OscMessageBuilder

STORY = (
    # what happens to the agent, how long it takes at least, what it feels: (emotion, intensity, ...), and what it says
    ("a friend comes in", 1.5, ("surprise", 0.7, "happiness", 0.4), "Oh! It is you!"),
    ("they laugh together", 2.0, ("happiness", 1.0), "I can't stop smiling when I talk to you."),
    ("there is bad news", 1.5, ("fear", 0.7, "sadness", 0.3), "Wait. What has happened?"),
    ("it sinks in", 2.0, ("sadness", 0.9), "I am so sorry to hear that."),
    ("somebody is to blame", 1.5, ("anger", 1.0), "But who would do a thing like that?"),
    ("the coffee is off", 1.5, ("disgust", 0.9), "And this coffee is horrible."),
    ("all is well again", 1.5, ("happiness", 0.5), "Well. Tomorrow will be better."),
)
SPOKEN_S = 10.0
"""No sentence takes longer."""


class Agent:
    """Sends OSC messages to a face and reads its answers."""

    def __init__(self, host: str, port: int) -> None:
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect((host, port))
        self.socket.settimeout(0.5)

    def send(self, address: str, *arguments: str | float) -> None:
        """Send one message."""
        builder = OscMessageBuilder(address)
        for argument in arguments:
            builder.add_arg(argument)
        self.socket.send(builder.build().dgram)

    def ask(self, seconds: float) -> str | None:
        """The status of the face as JSON; None if it does not answer in time."""
        self.listen()
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            try:
                self.send("/agentface/status")
                message = OscMessage(self.socket.recv(65536))
            except (TimeoutError, ConnectionRefusedError):
                time.sleep(0.1)
                continue
            if message.address == "/agentface/status":
                return str(message.params[0])
            print(f"the face says: {' '.join(map(str, message.params))}")
        return None

    def wait_for_speech(self) -> None:
        """Until the face has begun to speak and has ended."""
        end, begun = time.monotonic() + SPOKEN_S, False
        while time.monotonic() < end:
            speaks = json.loads(self.ask(1.0) or "{}").get("speech") is not None
            if begun and not speaks:
                return
            begun |= speaks
            time.sleep(0.1)

    def listen(self) -> None:
        """Print what the face said in the meantime; a status that came late is out of date."""
        while select.select([self.socket], [], [], 0)[0]:
            with suppress(ConnectionRefusedError):
                message = OscMessage(self.socket.recv(65536))
                if message.address != "/agentface/status":
                    print(f"the face says: {' '.join(map(str, message.params))}")


def main() -> None:
    """Run the example."""
    parser = argparse.ArgumentParser(description="Live through a short story.")
    parser.add_argument("--osc", default="127.0.0.1:7400", metavar="HOST:PORT")
    parser.add_argument("--wait", type=float, default=5.0, help="seconds to wait for the face")
    parser.add_argument("--pace", type=float, default=1.0, help="2 lives twice as fast, but speaks no faster")
    spoken = parser.add_mutually_exclusive_group()
    spoken.add_argument("--mute", action="store_true", help="feel, and say nothing")
    spoken.add_argument("--phones", type=Path, metavar="FILE.json", help="say the phones of a recording, once")
    options = parser.parse_args()

    host, _, port = options.osc.rpartition(":")
    agent = Agent(host, int(port))
    if agent.ask(options.wait) is None:
        raise SystemExit(f"no face answers on {options.osc}; start one with: agentface serve --osc {options.osc}")
    if options.phones is not None:
        phones = json.loads(options.phones.read_text(encoding="utf-8"))["phones"]
        agent.send("/agentface/visemes", *(part for phone in phones for part in phone))
    for event, seconds, feelings, words in STORY:
        print(f"{event}: {feelings}")
        begun = time.monotonic()
        agent.send("/agentface/emotions", *feelings)
        if not options.mute and options.phones is None:
            agent.send("/agentface/say", words)
            agent.wait_for_speech()
        time.sleep(max(0.0, begun + seconds / options.pace - time.monotonic()))
    agent.send("/agentface/neutral", 0.5)
    time.sleep(1.0 / options.pace)
    status = json.loads(agent.ask(options.wait) or "{}")
    print(f"the face took {status.get('messages')} messages, errors: {status.get('errors')}")


if __name__ == "__main__":
    main()
