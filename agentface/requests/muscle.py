"""Hold muscles and other parameters by hand."""

from __future__ import annotations

import math
from collections.abc import Hashable
from dataclasses import dataclass
from typing import Any

from agentface.conventions import check_duration, check_fraction, check_range
from agentface.errors import UnknownNameError
from agentface.parameters import PARAMETERS, check_degrees, indices_of, muscle_names, parameter_names
from agentface.requests.request import FADE_S, Movable, Request

_DEGREES = "_deg"


@dataclass(frozen=True, slots=True)
class SetMuscle(Request):
    """Hold a muscle or the jaw, whatever else moves it.

    Attributes:
        name: one of ``muscle_names()``; without its side it means both.
        contraction: 0..1; None to release it.
        fade: seconds.
    """

    name: str
    contraction: float | None
    fade: float = FADE_S

    def __post_init__(self) -> None:
        if self.name not in muscle_names():
            raise UnknownNameError("muscle", self.name, muscle_names())
        self._keep(
            contraction=None if self.contraction is None else check_fraction(self.name, self.contraction),
            fade=check_duration("fade", self.fade),
        )

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each muscle by itself."""
        return type(self).__name__, self.name

    def apply(self, face: Movable) -> None:
        """Tell the muscles' channel."""
        if self.contraction is None:
            face.channels.muscles.release(self.fade, self.name)
        else:
            face.channels.muscles.set(self.name, self.contraction, self.fade)


@dataclass(frozen=True, slots=True)
class SetParameter(Request):
    """Set any one parameter: a muscle as :class:`SetMuscle` does, an angle of gaze or head beside the others.

    Attributes:
        name: a parameter, a paired one also without its side; an angle also with ``_deg`` at its end.
        value: in the parameter's unit and range, radians for angles, degrees where the name says so;
            None to release it.
        fade: seconds.
    """

    name: str
    value: float | None
    fade: float = FADE_S

    def __post_init__(self) -> None:
        name, value = _check_parameter(self.name, self.value)
        self._keep(name=name, value=value, fade=check_duration("fade", self.fade))

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each parameter by itself."""
        return type(self).__name__, self.name

    def apply(self, face: Movable) -> None:
        """Tell the channel that has it."""
        kind = PARAMETERS[indices_of(self.name)[0]].kind
        if kind in ("gaze", "head"):
            turned = face.channels.gaze if kind == "gaze" else face.channels.head
            turned.turn_one(self.name, 0.0 if self.value is None else self.value, self.fade)
        elif self.value is None:
            face.channels.muscles.release(self.fade, self.name)
        else:
            face.channels.muscles.set(self.name, self.value, self.fade)


def _check_parameter(name: Any, value: Any) -> tuple[str, float | None]:
    """The parameter that is meant, and the value in its unit; raises UnknownNameError or InvalidValueError."""
    known = parameter_names()
    if name not in known:
        raise UnknownNameError("parameter", name, known)
    plain = str(name).removesuffix(_DEGREES)
    if value is None:
        return plain, None
    meant = PARAMETERS[indices_of(plain)[0]]
    if plain == name:
        return plain, check_range(plain, value, meant.low, meant.high)
    return plain, min(max(math.radians(check_degrees(plain, value)), meant.low), meant.high)
