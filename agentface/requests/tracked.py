"""Ask for a frame of a tracker."""

from __future__ import annotations

from dataclasses import dataclass

from agentface.conventions import check_duration
from agentface.motion.stream import STREAM_FADE_S
from agentface.requests.request import Movable, Request
from agentface.vrm.tracked import TRACKER_CHANNEL, Tracked, TrackerChannel


@dataclass(frozen=True, slots=True)
class SetTracked(Request):
    """A whole frame of a tracker, in place of the one before.

    Attributes:
        frame: weights, expressions, head and gaze.
        fade: seconds from the frame before.
    """

    frame: Tracked
    fade: float = STREAM_FADE_S

    def __post_init__(self) -> None:
        self._keep(fade=check_duration("fade", self.fade))

    def apply(self, face: Movable) -> None:
        """Tell the tracker's channel, which is there from the first frame on."""
        tracker_channel(face).change(face.model, self.frame, self.fade)


def tracker_channel(face: Movable) -> TrackerChannel:
    """The tracker's channel of a face, which it has from now on."""
    channel = face.channels.get(TRACKER_CHANNEL)
    if not isinstance(channel, TrackerChannel):
        from agentface.emotion.inference import default_inference

        channel = TrackerChannel(default_inference())
        face.channels[TRACKER_CHANNEL] = channel
    return channel
