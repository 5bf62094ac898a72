"""Pictures of a face: uploads one frame's vertices, everything else stays on the GPU."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.anatomy.model import HeadModel
from agentface.conventions import Bytes, Floats
from agentface.deform.geometry import FaceGeometry
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.view.anchored import AnchoredArray, eye_linings
from agentface.view.brows import BrowLine, brow_hairs, lash_hairs
from agentface.view.camera import Camera, named_view
from agentface.view.context import check_alive, compile_program, open_context
from agentface.view.frame import pack_frame, shadow_projection
from agentface.view.hair import Hairline, hidden
from agentface.view.head_hair import HeadHair
from agentface.view.look import Look, load_look
from agentface.view.noise import SIDE, noise_volume
from agentface.view.parts import Eyeball, RigidPart
from agentface.view.refine import vertex_normals
from agentface.view.ribbons import HairArray
from agentface.view.shadow import KeyShadow
from agentface.view.shirt import shirt
from agentface.view.skin import Skin, SkinFields
from agentface.view.targets import Targets
from agentface.view.teeth import crown_places
from agentface.view.wrinkles import WrinkleAtlas

QUALITIES: dict[str, int] = {"fast": 0, "portrait": 4}
"""Name of a quality: samples a pixel (0: one, not resolved)."""
SHADOW_TAPS = {"fast": 0, "portrait": 16}
"""Looks into the key light's depths a pixel; 0: the shadow of the face at rest, by vertex."""
LARGEST_SIDE = 8192
_SEED = 20
_FRAME_BYTES = 3 * 64 + 11 * 16
_BINDING = 0


class Renderer:
    """Draws one face.

    Args:
        model: the face.
        look: its colours and lights; the model's own ``look.yaml`` when None.
        context: a ``moderngl.Context``; a headless one is opened when None.

    Raises GraphicsError when there is no OpenGL or a shader does not compile.
    """

    def __init__(self, model: HeadModel, look: Look | None = None, context: Any = None) -> None:
        self.model = model
        self.look = look if look is not None else load_look(model)
        self.context = context if context is not None else open_context()
        self._targets: dict[tuple[tuple[int, int], int], Targets] = {}
        self._frame = self.context.buffer(reserve=_FRAME_BYTES)
        rng = np.random.default_rng(_SEED)
        self._noise = self.context.texture3d((SIDE,) * 3, 4, noise_volume(rng).tobytes())
        self._programs = {
            name: self._compile(f"{name}.vert.glsl", f"{name}.frag.glsl")
            for name in ("skin", "part", "eye", "ribbon", "strand")
        }
        self._programs["lining"] = self._compile("anchored.vert.glsl", "part.frag.glsl")
        self._programs["cap"] = self._compile("anchored.vert.glsl", "cap.frag.glsl")
        self._depth = self._compile("depth.vert.glsl", None)
        self._develop = self._compile("screen.vert.glsl", "develop.frag.glsl")
        self._screen = self.context.vertex_array(self._develop, [])
        self._fields = SkinFields(self.context, len(model.vertices))
        self._wrinkles = WrinkleAtlas(self.context, model)
        normals = vertex_normals(model.vertices, model.triangles)
        self._shadow = KeyShadow(self.context, self._depth, model)
        lit, covered = self._lit_at_rest(normals), self._covered()
        self._skins = {
            name: Skin(self.context, self._programs["skin"], model, covered, lit, fine=samples > 0)
            for name, samples in QUALITIES.items()
        }
        self._parts = {name: self._part(name) for name in ("teeth_upper", "teeth_lower", "tongue")}
        self._eyes = [Eyeball(self.context, self._programs["eye"], model, side) for side in "lr"]
        self._parts["shirt"] = self._shirt()
        self._linings = [
            AnchoredArray(self.context, self._programs["lining"], mesh, model.vertices) for mesh in eye_linings(model)
        ]
        hair = self.look.hair
        self._hairs = [
            HairArray(self.context, self._programs["ribbon"], brow_hairs(model, normals, hair, rng), 0.35),
            HairArray(self.context, self._programs["ribbon"], lash_hairs(model, normals, hair, rng), 0.1),
        ]
        self._head_hair: HeadHair | None = None
        if hair.style != "none":
            self._head_hair = HeadHair(self.context, self._programs["cap"], self._programs["strand"], model, hair)
        ring = model.lips.rings[0]
        self._lips = [half[len(half) // 2 - 2 : len(half) // 2 + 3] for half in (ring.upper, ring.lower)]
        self._set_look()

    def render(
        self,
        geometry: FaceGeometry,
        size: tuple[int, int] = (1280, 720),
        camera: Camera | str = "front",
        quality: str = "fast",
        *,
        alpha: bool = False,
    ) -> Bytes:
        """A picture of ``geometry`` as ``(height, width, 3)`` uint8 sRGB, the top row first.

        Args:
            geometry: the face at one instant.
            size: width and height in pixels, 1..8192 each.
            camera: a camera, or the name of a view: front, three-quarter, profile.
            quality: ``fast`` or ``portrait``.
            alpha: leave the background out: ``(height, width, 4)`` with straight (not premultiplied) alpha.

        Raises InvalidValueError for a wrong size, UnknownNameError for an unknown view or quality, GraphicsError when
        the driver has lost the context.
        """
        targets = self._targets_for(size, quality)
        self.draw(geometry, targets, camera, quality, alpha=alpha)
        width, height = targets.size
        channels = 4 if alpha else 3
        pixels = np.frombuffer(targets.picture.read(components=channels, alignment=1), np.uint8)
        check_alive(self.context)
        return np.ascontiguousarray(pixels.reshape(height, width, channels)[::-1])

    def draw(
        self,
        geometry: FaceGeometry,
        targets: Targets,
        camera: Camera | str,
        quality: str,
        onto: Any = None,
        *,
        alpha: bool = False,
    ) -> None:
        """Draw into ``targets`` and develop into its picture, or into the framebuffer ``onto``."""
        import moderngl

        context = self.context
        seen_from = named_view(self.model, camera) if isinstance(camera, str) else camera
        self._frame.write(pack_frame(seen_from, targets.size, geometry.head, self.look.lights))
        self._frame.bind_to_uniform_block(_BINDING)
        self.upload(geometry)
        self._fields.texture.use(0)
        self._noise.use(1)
        self._wrinkles.texture.use(3)
        if SHADOW_TAPS[quality]:
            self._shadow.draw()
        self._shadow.use(2)
        _set(self._programs["skin"], {"shadow_taps": SHADOW_TAPS[quality], "wrinkled": self._wrinkled})
        targets.scene.use()
        targets.scene.clear(0.0, 0.0, 0.0, 0.0)
        context.enable_only(moderngl.DEPTH_TEST)
        self._draw_solids(geometry, quality)
        if self._head_hair is not None:
            self._head_hair.draw_solid(quality)
        context.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        context.blend_func = (
            moderngl.SRC_ALPHA,
            moderngl.ONE_MINUS_SRC_ALPHA,
            moderngl.ONE,
            moderngl.ONE_MINUS_SRC_ALPHA,
        )
        for hairs in self._hairs:
            hairs.draw()
        if self._head_hair is not None:
            self._head_hair.draw_soft(quality, targets.scene)
        if targets.samples:
            context.copy_framebuffer(targets.resolved, targets.scene)
        context.enable_only(moderngl.NOTHING)
        screen = onto if onto is not None else targets.picture
        screen.use()
        targets.light.use(0)
        self._develop["aspect"].value = targets.size[0] / targets.size[1]
        self._develop["see_through"].value = alpha
        self._screen.render(moderngl.TRIANGLES, 3)

    def upload(self, geometry: FaceGeometry) -> None:
        """Hand to the GPU what changes from frame to frame; ``draw`` does it itself."""
        self._fields.update(geometry)
        self._wrinkled = self._wrinkles.update(geometry.wrinkle_levels)

    def _draw_solids(self, geometry: FaceGeometry, quality: str) -> None:
        for name in ("part", "skin"):
            self._programs[name]["mouth_light"].value = self._mouth_light(geometry)
        self._skins[quality].draw()
        self._parts["teeth_upper"].draw(geometry.head)
        for name in ("teeth_lower", "tongue"):
            self._parts[name].draw(geometry.head @ geometry.jaw)
        self._parts["shirt"].draw(np.eye(4, dtype=np.float32))
        for lining in self._linings:
            lining.draw()
        for eye in self._eyes:
            eye.draw(geometry)

    def _compile(self, vertex: str, fragment: str | None) -> Any:
        program = compile_program(self.context, vertex, fragment)
        for name, slot in (
            ("skin_fields", 0),
            ("noise_volume", 1),
            ("light", 0),
            ("key_depth", 2),
            ("wrinkle_atlas", 3),
        ):
            if name in program:
                program[name].value = slot
        if "Frame" in program:
            program["Frame"].binding = _BINDING
        return program

    def _part(self, name: str) -> RigidPart:
        mesh = self.model.parts[name]
        material = mesh.attributes["_MATERIAL"].astype(np.float32) / np.float32(255)
        material[:, 3] = 0.0
        positions = mesh.attributes["POSITION"]
        detail = crown_places(positions, mesh.triangles, material[:, 0])
        return RigidPart(self.context, self._programs["part"], positions, mesh.triangles, material, detail)

    def _mouth_light(self, geometry: FaceGeometry) -> float:
        """The part of the light that reaches the teeth: all through a mouth open by a finger, little through a slit."""
        wider = self._lip_gap(geometry.vertices) - self._lip_gap(self.model.vertices)
        opened = wider / (0.12 * self.model.landmarks.eye_separation)
        return min(1.0, 0.12 + 0.88 * max(0.0, opened))

    def _lip_gap(self, vertices: Floats) -> float:
        upper, lower = (vertices[ring, 1] for ring in self._lips)
        return float(upper.mean() - lower.mean())

    def _lit_at_rest(self, normals: Floats) -> Floats:
        model, lights = self.model, self.look.lights
        geometry = FaceGeometry.at_rest(model.vertices, normals)
        self._frame.write(pack_frame(named_view(model, "front"), (1, 1), geometry.head, lights))
        self._frame.bind_to_uniform_block(_BINDING)
        self._fields.update(geometry)
        self._fields.texture.use(0)
        self._shadow.draw()
        return self._shadow.lit(model.vertices, normals, shadow_projection(lights))

    def _covered(self) -> Floats:
        hair, model = self.look.hair, self.model
        covered = 0.55 * hair.brow_density * BrowLine(model).density(model.vertices)
        if hair.style != "none":
            covered = np.maximum(covered, hidden(model, Hairline(model, hair.hairline), hair))
        return np.asarray(np.clip(covered, 0, 1), np.float32)

    def _shirt(self) -> RigidPart:
        vertices, triangles, weave = shirt(self.model)
        material = np.tile(np.array([0, 0, 0, 1], np.float32), (len(vertices), 1))
        return RigidPart(self.context, self._programs["part"], vertices, triangles, material, weave)

    def _set_look(self) -> None:
        look, front = self.look, float(self.model.landmarks["upper_lip_middle"][2])
        values: dict[str, dict[str, Any]] = {
            "skin": {"skin_tone": look.skin.tone, "lip_tint": look.skin.lips, "shine": look.skin.shine,
                     "mouth_front": front, "hair_colour": look.hair.colour,
                     "atlas_height": self._wrinkles.height},
            "part": {"mouth_front": front, "cloth": look.cloth},
            "lining": {"mouth_front": front, "mouth_light": 1.0, "cloth": look.cloth},
            "eye": {"iris_inner": look.eyes.iris_inner, "iris_outer": look.eyes.iris_outer, "sclera": look.eyes.sclera,
                    "pupil_radius": look.eyes.pupil, "iris_radius": 0.445},
        }  # fmt: skip
        for name, rows in values.items():
            _set(self._programs[name], rows)
        developed = {
            "background_inner": look.background_inner,
            "background_outer": look.background_outer,
            "exposure": look.exposure,
        }
        _set(self._develop, developed)

    def _targets_for(self, size: tuple[int, int], quality: str) -> Targets:
        if quality not in QUALITIES:
            raise UnknownNameError("quality", quality, tuple(QUALITIES))
        key = (checked_size(size), QUALITIES[quality])
        if key not in self._targets:
            if len(self._targets) >= 4:
                self._targets.pop(next(iter(self._targets))).release()
            self._targets[key] = Targets.make(self.context, *key)
        return self._targets[key]


def checked_size(size: Any) -> tuple[int, int]:
    """Width and height in pixels; raises InvalidValueError unless both are whole numbers in 1..8192."""
    expected = f"(width, height), whole numbers of pixels in 1..{LARGEST_SIDE}"
    try:
        width, height = size
    except (TypeError, ValueError):
        raise InvalidValueError("size", expected, size) from None
    if not all(isinstance(side, (int, np.integer)) and not isinstance(side, bool) for side in (width, height)):
        raise InvalidValueError("size", expected, size)
    if not (1 <= width <= LARGEST_SIDE and 1 <= height <= LARGEST_SIDE):
        raise InvalidValueError("size", expected, size)
    return int(width), int(height)


def _set(program: Any, values: dict[str, Any]) -> None:
    for name, value in values.items():
        if name in program:  # a compiler drops what a shader does not use
            program[name].value = tuple(value) if isinstance(value, list) else value
