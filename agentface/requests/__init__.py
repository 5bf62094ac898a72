"""What can be asked of a face, each kind as one record.

Python, OSC, documents, the panel and the command line all make the same ones.
A request is checked where it is made and means the same for every face; ``Face.apply`` carries it out. Requests are
immutable; they compare, hash and pickle, so that they can be noted and applied again. A program's own kind of request
is a subclass of :class:`Request`.
"""

from agentface.requests.action_unit import SetActionUnit
from agentface.requests.arkit import SetArkit
from agentface.requests.blink import Blink
from agentface.requests.block import PlayBlock
from agentface.requests.emotion import SetEmotion, SetEmotions
from agentface.requests.fap import SetFap, SetFaps
from agentface.requests.gesture import Gesture
from agentface.requests.life import SetLiveliness, SetState
from agentface.requests.mood import SetMood
from agentface.requests.muscle import SetMuscle, SetParameter
from agentface.requests.neutral import Neutral
from agentface.requests.performance import Play
from agentface.requests.request import FADE_S, Movable, Request
from agentface.requests.say import Say
from agentface.requests.speech import Hush, ShowViseme, Speak, TakeBack
from agentface.requests.tracked import SetTracked
from agentface.requests.turn import GAZE_FADE_S, HEAD_FADE_S, LookAt, SetGaze, SetHead

__all__ = [
    "FADE_S",
    "GAZE_FADE_S",
    "HEAD_FADE_S",
    "Blink",
    "Gesture",
    "Hush",
    "LookAt",
    "Movable",
    "Neutral",
    "Play",
    "PlayBlock",
    "Request",
    "Say",
    "SetActionUnit",
    "SetArkit",
    "SetEmotion",
    "SetEmotions",
    "SetFap",
    "SetFaps",
    "SetGaze",
    "SetHead",
    "SetLiveliness",
    "SetMood",
    "SetMuscle",
    "SetParameter",
    "SetState",
    "SetTracked",
    "ShowViseme",
    "Speak",
    "TakeBack",
]
