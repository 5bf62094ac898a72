""":class:`PerformancePage`: a performance as one file that plays in any browser, with neither Python nor a network."""

from __future__ import annotations

import base64
import gzip
import json
from collections.abc import Callable

from agentface.errors import InvalidValueError
from agentface.head.look import Look
from agentface.head.model import HeadModel
from agentface.io.sound import encode_wav
from agentface.io.web.basis import Basis
from agentface.io.web.frames import FrameWriter
from agentface.io.web.head_file import encode_head
from agentface.io.web.page_files import page_file
from agentface.live.loop import Frame
from agentface.speech.sound import Sound

TYPE, VERSION = "agentface performance", 1
MOST_FRAMES = 120_000


class PerformancePage:
    """A sink that keeps frames, as weights, for a page.

    Args:
        model: the face.
        look: its colours and lights.
        basis: its movements.

    ``show`` raises InvalidValueError for more than 120 000 frames; ``told`` is told the time of each, in s.
    """

    def __init__(self, model: HeadModel, look: Look, basis: Basis) -> None:
        self._model, self._look, self._basis = model, look, basis
        self._writer = FrameWriter(model, basis)
        self._messages: list[bytes] = []
        self.told: Callable[[float], object] = lambda _: None

    @staticmethod
    def check() -> None:
        """Raise OutputError where the page was not built."""
        page_file("recording.html")

    @property
    def frames(self) -> int:
        """How many have been taken."""
        return len(self._messages)

    def show(self, frame: Frame) -> None:
        """Take the next frame."""
        if len(self._messages) >= MOST_FRAMES:
            raise InvalidValueError("frames of a page", f"at most {MOST_FRAMES}", "more", "ask for fewer a second")
        self._messages.append(self._writer.write("basis", len(self._messages), frame.time_s, frame.geometry))
        self.told(frame.time_s)

    def record(self, sound: Sound | None = None) -> str:
        """The performance in JSON, as ``page/src/recording.js`` reads it; the sound begins with the first frame.

        Raises InvalidValueError without a frame.
        """
        if not self._messages:
            raise InvalidValueError("performance", "one frame or more", "none")
        head = encode_head(self._model, self._look, self._basis)
        return json.dumps({
            "type": TYPE,
            "version": VERSION,
            "face": self._model.name,
            "fields": self._writer.layouts["basis"].as_json(),
            "head": _packed(head),
            "frames": _packed(b"".join(self._messages)),
            "sound": None if sound is None else f"data:audio/wav;base64,{base64.b64encode(encode_wav(sound)).decode()}",
        })  # fmt: skip

    def content(self, sound: Sound | None = None) -> str:
        """The page in HTML, all in one; raises as :meth:`record`, and OutputError where the page was not built."""
        parts = {
            "/*PERFORMANCE*/": self.record(sound),
            "/*LICENCES*/": page_file("licences.txt"),
            "/*BUNDLE*/": page_file("agentface.js"),
        }
        page = page_file("recording.html")
        for place, text in parts.items():
            before, _, behind = page.partition(place)
            page = before + text.replace("</script", "<\\/script") + behind
        return page


def _packed(content: bytes) -> str:
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode()
