"""An agent that feels, in another process than the face: it sends emotions over OSC.

Start ``agentface serve --view window`` first, then ``python examples/osc_agent.py``.
"""

from __future__ import annotations

import argparse
import json
import select
import socket
import time
from contextlib import suppress

from pythonosc.osc_message import OscMessage
from pythonosc.osc_message_builder import OscMessageBuilder

STORY = (
    # what happens to the agent, how long it takes, and what it feels: (emotion, intensity, ...)
    ("a friend comes in", 1.5, ("surprise", 0.7, "happiness", 0.4)),
    ("they laugh together", 2.0, ("happiness", 1.0)),
    ("there is bad news", 1.5, ("fear", 0.7, "sadness", 0.3)),
    ("it sinks in", 2.0, ("sadness", 0.9)),
    ("somebody is to blame", 1.5, ("anger", 1.0)),
    ("the coffee is off", 1.5, ("disgust", 0.9)),
    ("all is well again", 1.5, ("happiness", 0.5)),
)


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
    parser.add_argument("--pace", type=float, default=1.0, help="2 lives twice as fast")
    options = parser.parse_args()

    host, _, port = options.osc.rpartition(":")
    agent = Agent(host, int(port))
    if agent.ask(options.wait) is None:
        raise SystemExit(f"no face answers on {options.osc}; start one with: agentface serve --osc {options.osc}")
    for event, seconds, feelings in STORY:
        print(f"{event}: {feelings}")
        agent.send("/agentface/emotions", *feelings)
        time.sleep(seconds / options.pace)
    agent.send("/agentface/neutral", 0.5)
    time.sleep(1.0 / options.pace)
    status = json.loads(agent.ask(options.wait) or "{}")
    print(f"the face took {status.get('messages')} messages, errors: {status.get('errors')}")


if __name__ == "__main__":
    main()
