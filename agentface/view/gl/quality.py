"""The qualities in which a face is drawn."""

from __future__ import annotations

from dataclasses import dataclass

from agentface.errors import UnknownNameError


@dataclass(frozen=True, slots=True)
class Quality:
    """What a quality costs.

    Attributes:
        samples: a pixel; 0: one, not resolved.
        skin: its shaders are ``shaders/<skin>.*.glsl``.
        fine: curved edges, lips on their spline, wrinkles that bend normals, the key light's shadow of the frame.
    """

    samples: int
    skin: str
    fine: bool


QUALITIES = {"fast": Quality(0, "skin_fast", fine=False), "portrait": Quality(4, "skin", fine=True)}


def quality_named(name: str) -> Quality:
    """The quality ``name``; raises UnknownNameError."""
    if name not in QUALITIES:
        raise UnknownNameError("quality", name, tuple(QUALITIES))
    return QUALITIES[name]


_WITHOUT_GPU = ("llvmpipe", "softpipe", "software", "swiftshader", "swrast", "gdi generic", "basic render")


def suited_quality(driver: str) -> str:
    """The quality for a live picture on the ``driver`` that OpenGL names: ``portrait`` where there is a GPU."""
    return "fast" if any(name in driver.lower() for name in _WITHOUT_GPU) else "portrait"
