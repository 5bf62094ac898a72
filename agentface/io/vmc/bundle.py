""":class:`FrameBundle`: a frame as one OSC bundle, whose numbers alone change."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from pythonosc.osc_message import OscMessage

BONES = ("Neck", "Head", "LeftEye", "RightEye")
"""Those that are sent, by the names of Unity's HumanBodyBones."""
POSE = 7
"""Numbers of a bone: a position, and a quaternion x, y, z, w."""


class FrameBundle:
    """One bundle a frame, to be played at once, in the order of the protocol: the values, and then that they apply.

    ``/VMC/Ext/OK``, ``/VMC/Ext/T``, ``/VMC/Ext/Root/Pos``, ``/VMC/Ext/Bone/Pos`` for each bone,
    ``/VMC/Ext/Blend/Val`` for each name, ``/VMC/Ext/Blend/Apply``. The bytes are laid out once.

    Args:
        names: of the blend shapes.
    """

    def __init__(self, names: Sequence[str]) -> None:
        from pythonosc.osc_bundle_builder import IMMEDIATELY, OscBundleBuilder

        builder, numbers = OscBundleBuilder(IMMEDIATELY), []
        rows: list[tuple[str, list[str | int | float]]] = [("OK", [1]), ("T", [0.0]), ("Root/Pos", ["root", *_AT_REST])]
        rows += [("Bone/Pos", [bone, *_AT_REST]) for bone in BONES]
        rows += [("Blend/Val", [name, 0.0]) for name in names]
        place = len(_HEADER)
        for address, values in [*rows, ("Blend/Apply", [])]:
            message = _message(address, values)
            builder.add_content(message)
            place += 4 + message.size
            moving = 0 if address == "Root/Pos" else sum(isinstance(value, float) for value in values)
            numbers += [place - 4 * (moving - number) for number in range(moving)]
        self._bytes: npt.NDArray[np.uint8] = np.frombuffer(bytearray(builder.build().dgram), np.uint8)
        self._places = np.array(numbers)[:, None] + np.arange(4)

    def packet(self, time_s: float, bones: Sequence[float], weights: npt.NDArray[np.floating[Any]]) -> bytes:
        """The frame's bytes.

        Args:
            time_s: the sender's time.
            bones: ``POSE`` numbers for each of ``BONES``, in the protocol's axes.
            weights: 0..1 for each name.
        """
        numbers = np.array([time_s, *bones, *weights.tolist()]) + 0.0  # no negative zeros
        self._bytes[self._places] = numbers.astype(">f4").view(np.uint8).reshape(-1, 4)
        return self._bytes.tobytes()


_HEADER = bytes(16)
_AT_REST = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def _message(address: str, values: Sequence[str | int | float]) -> OscMessage:
    from pythonosc.osc_message_builder import OscMessageBuilder

    builder = OscMessageBuilder(f"/VMC/Ext/{address}")
    for value in values:
        builder.add_arg(value, "i" if isinstance(value, int) else "f" if isinstance(value, float) else "s")
    return builder.build()
