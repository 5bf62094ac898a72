"""A face that listens for five seconds: what it does by itself, a look aside, a nod."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from agentface.conventions import Bytes
from agentface.face import Face
from agentface.studies.figures.overlay import in_colours
from agentface.view.contact_sheet import sheet

HZ, EVERY, FRAMES = 30, 10, 150
_SIZE = (300, 330)
_SEED = 11
_TOLD: dict[int, tuple[str, Callable[[Face], None]]] = {
    40: ("looks aside", lambda face: face.look_at((0.45, 0.1, 0.5))),
    85: ("and back", lambda face: face.look_at((0.0, 0.0, 0.8))),
    100: ("nods", lambda face: face.gesture("nod")),
}


def figures(face: str | Path) -> dict[str, bytes]:
    """``life.png``: every tenth frame of five seconds at 30 a second, with the times."""
    pictures: list[tuple[Bytes, str, str]] = []
    with Face(face, liveliness=0.6, seed=_SEED) as shown:
        shown.set_state("listening")
        shown.set_emotion("happiness", 0.3, fade=0.0)
        said = ""
        for frame in range(FRAMES):
            if frame in _TOLD:
                said, tell = _TOLD[frame]
                tell(shown)
            shown.step(1.0 / HZ)
            if frame % EVERY == 0:
                pictures.append((shown.render(_SIZE, quality="portrait"), f"{frame / HZ:.2f} s", said))
                said = ""
    return {"life.png": in_colours(sheet(pictures, columns=5))}
