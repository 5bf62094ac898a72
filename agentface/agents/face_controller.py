""":class:`FaceController`: a face as agent kits call it."""

from __future__ import annotations

from collections.abc import Mapping
from concurrent.futures import Future

from agentface.agents.faces import default_faces
from agentface.conventions import check_duration
from agentface.emotion.state import NEUTRAL, EmotionState
from agentface.errors import UnknownNameError
from agentface.face import Face
from agentface.requests import Request, SetEmotion, SetEmotions


class FaceController:
    """Has the members of aiavatarkit's class of this name, and may be called from any thread.

    Nothing waits for the face: what is asked is applied by its next step.

    Args:
        face: what is shown; stepped elsewhere.
        faces: what each name shows; that of ``rules/agents.yaml`` when None.
    """

    def __init__(self, face: Face, faces: Mapping[str, EmotionState] | None = None) -> None:
        self.faces = dict(default_faces() if faces is None else faces)
        self._face = face
        self._name = NEUTRAL
        self._asked: Future[bool] | None = None

    @property
    def current_face(self) -> str:
        """The name that was set last, as long as the face shows it; ``neutral`` otherwise."""
        waits = self._asked is not None and not self._asked.done()
        shows = self._name == NEUTRAL or self._face.emotion == self.faces[self._name]
        return self._name if waits or shows else NEUTRAL

    async def set_face(self, name: str, duration: float = 0.0) -> None:
        """Show a face for ``duration`` seconds once it is there, in place of the one before; 0 or less: until the next.

        Raises UnknownNameError, InvalidValueError.
        """
        if name not in self.faces:
            raise UnknownNameError("face", name, tuple(self.faces))
        for_good = isinstance(duration, int | float) and duration <= 0.0
        hold = None if for_good else check_duration("duration", duration)
        state = self.faces[name]
        self._ask(name, SetEmotions(state, hold=hold) if any(state.values()) else SetEmotion(NEUTRAL, 1.0))

    def reset(self) -> None:
        """Let go of what is felt: back to the mood."""
        self._ask(NEUTRAL, SetEmotion(NEUTRAL, 1.0))

    def _ask(self, name: str, request: Request) -> None:
        self._name, self._asked = name, self._face.ask(request)
