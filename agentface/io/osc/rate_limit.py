"""How many answers may be sent."""

from __future__ import annotations

from agentface.clock import Clock


class RateLimit:
    """A token bucket: so many at once, and then so many a second."""

    def __init__(self, clock: Clock, at_once: float, a_second: float) -> None:
        self._clock, self._at_once, self._a_second = clock, at_once, a_second
        self._left, self._counted = at_once, clock.now()

    def take(self) -> bool:
        """Whether one more is allowed; if so, it is counted."""
        now = self._clock.now()
        self._left = min(self._at_once, self._left + self._a_second * (now - self._counted))
        self._counted = now
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True
