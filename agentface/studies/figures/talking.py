"""Faces that say sentences while they feel something: frames of both."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image

from agentface.conventions import Bytes
from agentface.face import Face
from agentface.resources import face_names
from agentface.studies.figures.overlay import in_colours
from agentface.studies.harvard import harvard

_FEELINGS = ({"surprise": 0.8}, {"happiness": 0.9}), ({"happiness": 0.6}, {"anger": 0.9})
"""Of each face in its row, a sentence each."""
_FRAMES, _HZ = 4, 60
_SIZE = 360
_CUT = slice(40, 330), slice(60, 300)
_BEGIN_S, _APART_S = 0.45, 0.24
"""Of a sentence, when its first frame is taken and how long after one another they are."""


def figures(face: str | Path) -> dict[str, bytes]:
    """``talking.png``: a row for ``face`` and one for another face."""
    faces = [face, next(name for name in face_names() if name != str(face))]
    rows = [np.hstack(_row(which, row)) for row, which in enumerate(faces)]
    return {"talking.png": in_colours(Image.fromarray(np.vstack(rows)))}


def _row(face: str | Path, row: int) -> list[Bytes]:
    pictures: list[Bytes] = []
    with Face(face, liveliness=0.6, seed=3) as shown:
        for place, feeling in enumerate(_FEELINGS[row]):
            sentence = harvard()[2 * row + place]
            shown.set_emotion(feeling, fade=0.3)
            shown.speak(sentence.phones)
            times = [_BEGIN_S + _APART_S * frame for frame in range(_FRAMES)]
            now = 0.0
            for time in (*times, sentence.duration_s + 0.5):
                while now < time:
                    shown.step(1.0 / _HZ)
                    now += 1.0 / _HZ
                if time in times:
                    pictures.append(shown.render((_SIZE, _SIZE), quality="portrait")[_CUT])
    return pictures
