"""What a look makes of a head before anything is drawn: what chance decides, and how each vertex of skin looks."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.cache import stamp_of
from agentface.conventions import Bytes, Doubles, Floats
from agentface.head.look import HairLook, Look
from agentface.head.model import HeadModel
from agentface.head.skin_image import skin_image
from agentface.view.gl.noise import noise_volume
from agentface.view.hair.brows import BrowLine, brow_hairs, lash_hairs, lash_line
from agentface.view.hair.grown import GrownHair
from agentface.view.hair.hairline import Hairline, hair_shade, hidden
from agentface.view.hair.ribbons import Hairs
from agentface.view.skin.complexion import complexion, folds
from agentface.view.skin.fine_lips import FineLips
from agentface.view.skin.pores import pore_volume
from agentface.view.skin.wrinkle_atlas import skin_grain
from agentface.view.skin.wrinkle_patches import Relief

SOFTNESSES = 0.20, 0.0
"""Of brows and lashes: how they shine."""
_SEED = 20
_BROW_TINT = 0.66
_LIP_CUTS = 2


class Irregularities(NamedTuple):
    """``noise (32, 32, 32, 4)`` bytes, the skin's ``grain (S, S)``, and the hairs of brows and lashes."""

    noise: Bytes
    grain: Relief
    brows: Hairs
    lashes: Hairs


def irregularities(model: HeadModel, look: Look) -> Irregularities:
    """What chance decides about a face, always the same."""
    rng = np.random.default_rng(_SEED)
    noise, grain = noise_volume(rng), skin_grain(rng)
    hair = look.hair
    brows, lashes = model.derived(
        f"view.brows.{stamp_of((), repr(hair))}",
        lambda face: (brow_hairs(face, face.normals, hair, rng), lash_hairs(face, face.normals, hair, rng)),
    )
    return Irregularities(noise, grain, brows, lashes)


def pores() -> Bytes:
    """The texture ``pores`` of ``shaders/skin.frag.glsl``, ``(32, 32, 32, 4)`` bytes."""
    return pore_volume(np.random.default_rng(_SEED))


def fine_lips(model: HeadModel) -> FineLips:
    """The lips of a portrait."""
    return model.derived("view.fine_lips", lambda face: FineLips(face, _LIP_CUTS))


def grown_hair(model: HeadModel, look: Look) -> GrownHair | None:
    """The hair of the head, None without."""
    return None if look.hair.style == "none" else GrownHair(model, look.hair)


def dressed_skin(model: HeadModel, look: Look, grown: GrownHair | None) -> dict[str, Floats]:
    """What the look makes of the skin's vertices: ``(V, 1..4)`` by the names of ``shaders/skin_place.glsl``."""
    ambient = folds(model) * (1 - _shade(model, look.hair, grown)[:, None])
    dressed = {
        "complexion": complexion(model, _covered(model, look.hair), look.skin.stubble),
        "ambient": ambient.astype(np.float32),
    }
    if skin_image(look, 1) is not None:
        dressed["picture"] = np.column_stack([model.uv, model.uv_cover])
    return dressed


def _covered(model: HeadModel, look: HairLook) -> Floats:
    """``(V,)`` 0..1: how much of the skin's colour is that of the hair on it, brows among it."""
    tint = _BROW_TINT * look.brow_density * BrowLine(model, look.brow_arch).density(model.vertices)
    if look.style != "none":
        tint = np.maximum(tint, hidden(model, Hairline(model, look.hairline), look))
    tint = np.maximum(tint, lash_line(model))
    return np.asarray(np.clip(tint, 0, 1), np.float32)


def _shade(model: HeadModel, look: HairLook, grown: GrownHair | None) -> Doubles:
    """``(V,)`` 0..1: the part of the surroundings' light that hair keeps off the skin."""
    kept_off = hair_shade(model, look)
    return kept_off if grown is None else np.maximum(kept_off, grown.shade(model.vertices))
