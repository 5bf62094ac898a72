"""Hair of the head: where it begins, where it is rooted, and what of the skin it hides."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep
from agentface.view.hair.hull import spread_over
from agentface.view.hair.ribbons import unit_rows

# The hairline over the azimuth about the head's vertical axis: 0 the forehead, 180 the nape; heights over the eyes
# in distances between the pupils.
_AZIMUTH_DEG = (0, 12, 20, 26, 32, 38, 43, 47, 51, 55, 59, 63, 67, 72, 84, 90, 97, 105, 118, 150, 180)
_HEIGHT = (
    1.0, 0.988, 0.955, 0.905, 0.835, 0.73, 0.60, 0.42, 0.16, -0.18, -0.42,
    -0.47, -0.44, -0.38, -0.36, -0.40, -0.56, -0.85, -1.05, -1.18, -1.22,
)  # fmt: skip
_METRES_A_DEGREE = 0.0016
"""Round the head, on the skin."""
_ALL_ROUND = 0.04
"""Metres above the hairline from where on it no longer matters how steep it is."""
_TAPER, _TAPER_FROM_DEG, _TAPER_TO_DEG = 0.028, 25.0, 66.0
"""Metres over which a crop grows from nothing at the sides and the nape; from which turn on, and where wholly."""
_AXIS_Z = -0.69
_SOFT = 0.003
"""Metres over which hair grows denser behind the hairline."""
_SHADE = {"cropped": 0.15, "swept": 0.45, "bob": 0.60, "bun": 0.35}
_SCALP_TINT, _SOFT_FRONT = 0.9, 0.016
"""How much a crop tints the scalp below it, and the metres at the forehead over which it does so."""
_SHADE_REACH = 0.007
"""Metres in which the shade of hair falls to a third."""
_STRIP = 0.012
"""Metres behind the hairline where single hairs are seen."""


_WANDERING = ((0.0018, 130.0, 0.0, 1.0), (0.0012, 310.0, 60.0, 0.0), (0.0008, 720.0, 0.0, 2.0))
"""Waves of the hairline: metres up and down, radians a metre to the left and ahead, where each starts."""


_SIDE_WANDERING = ((0.0016, 170.0, 0.6), (0.0012, 420.0, 2.0), (0.0007, 900.0, 1.0))
"""The same beside the forehead: metres to and fro, radians a metre upward, where each starts on the left."""


_EAR = 0.28, 0.42
"""How far an ear keeps hair away ahead and behind, in eye separations: before it grow sideburns."""
_BARE = 0.02
"""Metres by which the skin of an ear counts as before the hairline."""


class Hairline:
    """How far points lie behind the hairline of a face."""

    def __init__(self, model: HeadModel, height: float) -> None:
        self.unit = model.landmarks.eye_separation
        self.top = height * float(model.landmarks["hairline_middle"][1])
        turns = np.arange(181.0)
        table = np.interp(turns, _AZIMUTH_DEG, _HEIGHT)
        padded = np.concatenate([table[4:0:-1], table, table[-2:-6:-1]])
        self._turns, self._heights = turns, np.convolve(padded, np.hanning(11)[1:-1] / np.hanning(11).sum(), "valid")
        self._slant = 1.0 / np.hypot(1.0, np.gradient(self._heights) * self.unit / _METRES_A_DEGREE)

    def behind(self, points: Floats | Doubles) -> Doubles:
        """``(N,)`` metres behind the hairline at each point ``(N, 3)`` of the head; negative on face and ears."""
        turn = self._turn(points)
        height = np.interp(turn, self._turns, self._heights)
        # the forehead's part is fixed by the landmark, the rest by the size of the face
        above = points[:, 1] - np.where(height > 0, height * self.top, height * self.unit)
        above = above + _uneven(points)
        slant = np.interp(turn, self._turns, self._slant)
        away = above * (slant + (1.0 - slant) * np.clip(above / _ALL_ROUND, 0.0, 1.0))
        return np.asarray(np.minimum(away + (1.0 - slant) * _uneven_sides(points), self.off_ear(points)))

    def off_ear(self, points: Floats | Doubles) -> Doubles:
        """``(N,)`` metres from the ear's surroundings, where no hair grows; negative in them."""
        y, z = points[:, 1] / self.unit + 0.40, points[:, 2] / self.unit + 0.24
        ahead = z + 0.25 * y
        return np.asarray((np.hypot(y / 0.54, ahead / np.where(ahead > 0.0, *_EAR)) - 1) * 0.42 * self.unit)

    def taper(self, points: Floats | Doubles, front: float) -> Doubles:
        """``(N,)`` metres behind the hairline where a crop has its whole length: ``front`` at the forehead."""
        side = smoothstep(_TAPER_FROM_DEG, _TAPER_TO_DEG, self._turn(points))
        return np.asarray(front + (_TAPER - front) * side)

    def _turn(self, points: Floats | Doubles) -> Doubles:
        return np.asarray(np.degrees(np.arctan2(np.abs(points[:, 0]), points[:, 2] - _AXIS_Z * self.unit)))

    def over(self, model: HeadModel) -> Doubles:
        """``(V,)`` metres behind the hairline for the vertices of the skin."""
        return self.behind(model.vertices) - _bare(model.material[:, 3])


@dataclass(frozen=True, slots=True)
class HairRoots:
    """Places on the scalp: ``places`` and ``normals`` ``(N, 3)``, ``depth (N,)`` metres behind the hairline."""

    places: Doubles
    normals: Doubles
    depth: Doubles

    @classmethod
    def drawn(
        cls,
        model: HeadModel,
        normals: Floats,
        line: Hairline,
        count: int,
        rng: np.random.Generator,
        *,
        behind: float = 0.0,
        elsewhere: float = 1.0,
    ) -> HairRoots:
        """At most ``count`` roots spread over the scalp, fewer and fewer towards the hairline.

        None nearer than ``behind`` metres; behind the strip at the hairline only the part ``elsewhere`` of them.
        """
        over = line.over(model)
        triangles = model.triangles[over[model.triangles].max(1) > -0.02]
        drawn, weights = spread_over(model.vertices, triangles, round(3 * count / max(elsewhere, 0.3)), rng)
        corners = triangles[drawn]
        places = (model.vertices[corners] * weights[..., None]).sum(1)
        depth = line.behind(places) - _bare((model.material[corners, 3] * weights).sum(1))
        depth += 0.0020 * _wave(places * 190.0) + 0.0012 * _wave(places * 520.0)
        grown = (depth > _SOFT * (rng.random(len(depth)) ** 1.5 - 0.35)) & (depth >= behind)
        grown &= (depth < _STRIP) | (rng.random(len(depth)) < elsewhere)
        kept = np.flatnonzero(grown)[:count]
        shown = unit_rows((normals[corners[kept]] * weights[kept][..., None]).sum(1))
        return cls(places[kept], shown, depth[kept])

    def before(self, line: Hairline, depth: float) -> HairRoots:
        """Those that are less than ``depth`` metres behind the hairline and none on the ears."""
        kept = line.behind(self.places) < depth
        return HairRoots(self.places[kept], self.normals[kept], self.depth[kept])

    def __len__(self) -> int:
        return len(self.depth)


def hidden(model: HeadModel, line: Hairline, look: HairLook) -> Doubles:
    """``(V,)`` 0..1: how much hair hides each vertex of the skin, on the scalp and behind hair that falls over it."""
    over = line.over(model)
    if look.style == "cropped":
        return np.asarray(_SCALP_TINT * np.clip(over / line.taper(model.vertices, _SOFT_FRONT), 0, 1))
    scalp = np.clip((over + 0.003) / 0.014, 0, 1)
    if look.style != "bob":
        return np.asarray(scalp)
    y, z = model.vertices[:, 1], model.vertices[:, 2]
    bottom = look.length * float(model.landmarks["menton"][1])
    behind = np.clip((0.05 * line.unit - z) / (0.35 * line.unit), 0, 1) * np.clip((y - bottom) / 0.03, 0, 1)
    ears = smoothstep(0.5, 0.95, model.material[:, 3])
    return np.maximum(np.maximum(scalp, ears), 0.9 * behind * (y < 0.6 * line.unit))


def hair_shade(model: HeadModel, look: HairLook) -> Doubles:
    """``(V,)`` 0..1: the part of the surroundings' light that hair keeps off the bare skin next to it."""
    if look.style == "none":
        return np.zeros(len(model.vertices))
    line = Hairline(model, look.hairline)
    before = np.maximum(-line.over(model), 0.0)
    thick = min(look.volume * _SHADE[look.style], 1.0)
    return np.asarray(np.maximum(thick * np.exp(-before / _SHADE_REACH), 0.5 * hidden(model, line, look)))


def _bare(ear: Floats | Doubles) -> Doubles:
    """``(N,)`` m: by how much what is ``ear (N,)``, 0..1, counts as before the hairline."""
    return _BARE * smoothstep(0.9, 1.0, ear)


def _uneven(points: Floats | Doubles) -> Doubles:
    """``(N,)`` m: how far a hairline wanders, which is no line; not the same on both sides."""
    x, z = points[:, 0], points[:, 2]
    return np.asarray(sum(far * np.sin(turns * x + aside * z + start) for far, turns, aside, start in _WANDERING))


def _uneven_sides(points: Floats | Doubles) -> Doubles:
    """``(N,)`` m: how far it wanders to and fro where it is steep."""
    x, y = points[:, 0], points[:, 1]
    return np.asarray(sum(far * np.sin(turns * y + start * np.sign(x)) for far, turns, start in _SIDE_WANDERING))


def _wave(points: Doubles) -> Doubles:
    x, y, z = points.T
    return np.asarray(np.sin(x + 1.7 * np.sin(y)) * np.cos(z + 1.3 * np.sin(x)))
