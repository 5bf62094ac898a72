""":class:`VmcSender`: the sink that shows a face on an avatar somewhere else."""

from __future__ import annotations

import socket
from collections.abc import Callable
from types import TracebackType
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from agentface.errors import ServerError, UnknownNameError
from agentface.face import Face
from agentface.io.vmc.axes import position_between, turn_between
from agentface.io.vmc.bundle import BONES, FrameBundle
from agentface.io.vmc.names import are_presets, looks_of, names_of
from agentface.live.loop import Frame
from agentface.vrm.bones import FaceBones
from agentface.vrm.turns import STILL

EYES = ("bones", "shapes")
"""By what eyes turn: avatars have either, or both, which then would turn them twice."""
DEFAULT_PORT = 39539
"""Where what draws an avatar, the Marionette, listens."""


class VmcSender:
    """Sends each frame as one datagram; what cannot be sent is counted, and nothing waits for it.

    Args:
        face: whose frames are shown.
        host: the machine of the receiver.
        port: 39539 for one that draws, 39540 for one that sends on.
        names: of the blend shapes, one of ``NAMES``.
        axes: one of ``AXES``.
        eyes: one of ``EYES``; the others say that they look ahead.

    Raises UnknownNameError for names and eyes, ServerError for a host that is none.
    """

    def __init__(
        self,
        face: Face,
        host: str,
        port: int = DEFAULT_PORT,
        *,
        names: str = "vrm0",
        axes: str = "unity",
        eyes: str = "bones",
    ) -> None:
        if eyes not in EYES:
            raise UnknownNameError("way to turn eyes", eyes, EYES)
        self.names, self.axes, self._eyes = names, axes, eyes
        self._bundle = FrameBundle(names_of(names))
        self._looks = looks_of(names) if eyes == "bones" else []
        self._weights = _presets_of(face) if are_presets(names) else _arkit_of(face)
        self._bones = FaceBones(face.model)
        self._socket, self._place = _to(host, port)
        self.sent = self.failed = 0

    @property
    def to(self) -> str:
        """Host and port of the receiver."""
        host, port = self._place[:2]
        return f"{host}:{port}"

    @property
    def status(self) -> dict[str, Any]:
        """Where it sends, in whose names, and how many frames were sent and could not be, JSON-ready."""
        return {"to": self.to, "names": self.names, "frames": self.sent, "failed": self.failed}

    def show(self, frame: Frame) -> None:
        """Send one frame."""
        bones = self._bones.bones(frame.geometry)
        numbers: list[float] = []
        for name in BONES:
            still = self._eyes == "shapes" and name.endswith("Eye")
            numbers += position_between(self.axes, bones[name].position)
            numbers += turn_between(self.axes, STILL if still else bones[name].turn)
        weights = np.array(self._weights(frame))
        weights[self._looks] = 0.0
        packet = self._bundle.packet(frame.time_s, numbers, weights)
        try:
            self._socket.sendto(packet, self._place)
            self.sent += 1
        except OSError:  # the network is down, or the system's buffer is full: the next frame may arrive
            self.failed += 1

    def close(self) -> None:
        """Give the socket back; may be called twice."""
        self._socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _presets_of(face: Face) -> Callable[[Frame], npt.ArrayLike]:
    from agentface.emotion.inference import default_inference
    from agentface.vrm.shown_expressions import ShownExpressions

    shown = ShownExpressions(face.model, default_inference())
    return lambda frame: shown.weights(frame.pose.array, face.channels)


def _arkit_of(face: Face) -> Callable[[Frame], npt.ArrayLike]:
    """The 52 weights; a pose is read once."""
    from agentface.arkit.shape_solver import ShapeSolver

    solver = ShapeSolver(face.model)
    last: dict[Any, npt.ArrayLike] = {}

    def weights(frame: Frame) -> npt.ArrayLike:
        if frame.pose not in last:
            last.clear()
            last[frame.pose] = solver.weights(frame.pose.array)
        return last[frame.pose]

    return weights


def _to(host: str, port: int) -> tuple[socket.socket, Any]:
    try:
        family, kind, protocol, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
        sender = socket.socket(family, kind, protocol)
    except OSError as error:
        raise ServerError(f"VMC sender: expected a host to send to, got {host!r}: {error.strerror}") from error
    sender.setblocking(False)
    return sender, place
