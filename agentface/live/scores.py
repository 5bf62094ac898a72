"""A score that is played: the source of what an EmotionML document tells a face."""

from __future__ import annotations

from agentface.emotion.score import Change, Score
from agentface.face import Face
from agentface.requests import SetEmotions


class ScorePlayer:
    """Plays ``score`` to ``face`` from the start of the loop; with ``again``, from the beginning whenever it ends."""

    def __init__(self, face: Face, score: Score, *, again: bool = False) -> None:
        self._face, self._score, self._again = face, score, again
        self._told: Change | None = None

    def take_in(self, time_s: float) -> None:
        """Ask for the change that has come due, if there is one."""
        change = self._score.change(time_s % self._score.length_s if self._again else time_s)
        if change is not self._told:
            self._told = change
            self._face.apply(SetEmotions(change.state, change.fade_s))
