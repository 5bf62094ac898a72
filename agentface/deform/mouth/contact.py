"""Contact: the lips never pass through each other, nor through the teeth, and touch what speech has them touch."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.deform.morphs import jaw_slide
from agentface.deform.mouth.contact_tables import ContactTables, prepare
from agentface.deform.mouth.dental_arch import arch_distance
from agentface.deform.mouth.lip_bite import bite
from agentface.deform.mouth.lip_parting import close, part, seal

__all__ = ["ContactTables", "apply", "prepare"]

ROUNDS = 5
"""How often pressed lips are drawn together and parted: each round leaves less of the gap."""
PARTINGS = 3
"""How often lips are parted after the teeth have pushed them: each time takes what the last one left."""
APART = np.float32(1.5e-4)
"""m more between lips that shapes move, too: they slide along each other at a slant to the rings."""


def apply(tables: ContactTables, values: Floats, points: Floats) -> None:
    """Draw lips together and part them, bring them to the teeth and hold them out of them; ``points`` in place."""
    apart = APART * min(np.float32(1.0), np.abs(values[tables.morphs]).sum())
    if values[tables.seal] > 0.0:
        seal(tables, values[tables.seal], apart, points)
    for _ in range(ROUNDS if values[tables.press] > 0.0 else 1):
        close(tables, values[tables.press], points)
        part(tables, points, apart)
    if values[tables.bite] > 0.0:
        bite(tables, values[tables.bite], points)
    _hold_out(tables, values, values[tables.bite], points)
    for _ in range(PARTINGS):
        part(tables, points, apart)
    if values[tables.seal] > 0.0:
        seal(tables, values[tables.seal], apart, points)
        _hold_out(tables, values, values[tables.bite] * (np.float32(1.0) - values[tables.seal]), points)


def _hold_out(tables: ContactTables, values: Floats, bitten: np.float32, points: Floats) -> None:
    """Push what has come too near to the teeth out of them; a lip ``bitten`` 0..1 may come nearer.

    They push along x and z in their own frame: the lower arch's turns with the jaw.
    """
    points[tables.vertex, ::2] += _push_out(tables, 0, bitten, points[tables.vertex])
    angle = np.float32(tables.widest * values[tables.jaw])
    cosine, sine = np.cos(angle), np.sin(angle)
    places = points[tables.vertex]
    up, forward = (places[:, 1:] - tables.hinge).T
    places[:, 1] = tables.hinge[0] + cosine * up + sine * forward
    ahead, aside = jaw_slide(tables.slides, values)
    places[:, 0] -= np.float32(aside)
    places[:, 2] = tables.hinge[1] - sine * up + cosine * forward - np.float32(ahead)
    across, ahead = _push_out(tables, 1, bitten, places).T
    points[tables.vertex] += np.stack([across, -sine * ahead, cosine * ahead], axis=1)


def _push_out(tables: ContactTables, arch: int, bitten: np.float32, places: Floats) -> Floats:
    """``(K, 2)`` m: how ``places (K, 3)`` must move along x and z to keep their distance from an arch.

    With t the distance less what is to be kept, and s the softness, the push is 0 for t > s, -t for t < -s,
    and between them (s - t)^2 / 4s, which joins both with their slopes.
    """
    front, bend, edge, fade = tables.arch[arch]
    distance, normal = arch_distance(places, front, bend)
    beyond = (edge - places[:, 1]) / fade
    share = np.clip(np.float32(1.0) - beyond, np.float32(0.0), np.float32(1.0))
    share = share * share * (np.float32(3.0) - np.float32(2.0) * share)
    soft = tables.softness[arch]
    kept = tables.kept[arch] - bitten * tables.relief[arch]
    over = np.clip(soft - (distance - kept), np.float32(0.0), None)
    push = np.where(over < 2 * soft, over * over / (4 * soft), over - soft)
    push = np.where(tables.kept[arch] >= 0.0, share * push, np.float32(0.0))
    return np.asarray(push[:, None] * normal, np.float32)
