"""The qualities in which a face is drawn."""

from __future__ import annotations

from dataclasses import dataclass

from agentface.errors import UnknownNameError


@dataclass(frozen=True, slots=True)
class Tier:
    """What a quality costs.

    Attributes:
        samples: a pixel; 0: one, not resolved.
        skin: its shaders are ``shaders/<skin>.*.glsl``.
        fine: curved edges, lips on their spline, wrinkles that bend normals, the key light's shadow of the frame.
    """

    samples: int
    skin: str
    fine: bool


TIERS = {"fast": Tier(0, "skin_fast", fine=False), "portrait": Tier(4, "skin", fine=True)}
QUALITIES: dict[str, int] = {name: tier.samples for name, tier in TIERS.items()}
"""Name of a quality: samples a pixel (0: one, not resolved)."""


def tier_named(quality: str) -> Tier:
    """The tier ``quality``; raises UnknownNameError."""
    if quality not in TIERS:
        raise UnknownNameError("quality", quality, tuple(TIERS))
    return TIERS[quality]


_WITHOUT_GPU = ("llvmpipe", "softpipe", "software", "swiftshader", "swrast", "gdi generic", "basic render")


def suited_quality(driver: str) -> str:
    """The quality for a live picture on the ``driver`` that OpenGL names: ``portrait`` where there is a GPU."""
    return "fast" if any(name in driver.lower() for name in _WITHOUT_GPU) else "portrait"
