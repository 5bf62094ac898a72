""":class:`Calls`: what every call of a face is made with."""

from __future__ import annotations

from abc import ABC, abstractmethod
from concurrent.futures import Future

from agentface.motion.doing import Doing
from agentface.requests import Request


class Calls(ABC):
    """A face as its calls need it: each makes a request, which checks itself, and hands it over."""

    @abstractmethod
    def apply(self, request: Request) -> Doing | None:
        """Do what is asked, now."""

    @abstractmethod
    def ask(self, request: Request) -> Future[bool]:
        """Have a request applied by the next step."""
