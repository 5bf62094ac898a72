"""The names of ARKit's 52 face weights (Apple, ``ARFaceAnchor.BlendShapeLocation``): the artists' shapes have them."""

from __future__ import annotations

_SIDES = ("Left", "Right")
_EYES = ("eyeBlink", "eyeLookDown", "eyeLookIn", "eyeLookOut", "eyeLookUp", "eyeSquint", "eyeWide")
_MOUTH = (
    "mouthSmile", "mouthFrown", "mouthDimple", "mouthStretch", "mouthPress", "mouthLowerDown", "mouthUpperUp",
)  # fmt: skip


def _both(*names: str) -> tuple[str, ...]:
    return tuple(f"{name}{side}" for name in names for side in _SIDES)


ARKIT_SHAPES: tuple[str, ...] = (
    *_both(*_EYES),
    "jawForward", "jawLeft", "jawRight", "jawOpen",
    "mouthClose", "mouthFunnel", "mouthPucker", "mouthLeft", "mouthRight",
    *_both(*_MOUTH),
    "mouthRollLower", "mouthRollUpper", "mouthShrugLower", "mouthShrugUpper",
    "browDownLeft", "browDownRight", "browInnerUp", "browOuterUpLeft", "browOuterUpRight",
    "cheekPuff", *_both("cheekSquint", "noseSneer"), "tongueOut",
)  # fmt: skip
"""``Left`` and ``Right`` are the person's."""


def sided(name: str, side: str) -> str | None:
    """The shape of ``name`` for side ``l`` or ``r``, as mouthDimpleLeft for mouthDimple; None if it has no sides."""
    full = name + _SIDES["lr".index(side)]
    return full if full in ARKIT_SHAPES else None
