"""Pictures of a face: uploads one frame's vertices, everything else stays on the GPU."""

from __future__ import annotations

import weakref
from contextlib import AbstractContextManager
from functools import cached_property
from typing import Any, Self

import numpy as np

from agentface.conventions import SIDES, Bytes, Floats
from agentface.deform.geometry import FaceGeometry
from agentface.head.look import Look, load_look
from agentface.head.model import HeadModel
from agentface.head.skin_image import skin_texture
from agentface.view.camera import Camera, named_view
from agentface.view.dressing import (
    SOFTNESSES,
    dressed_skin,
    fine_lips,
    grown_hair,
    irregularities,
    pores,
)
from agentface.view.gl.context import LostContextCheck, finish, shader_names
from agentface.view.gl.ownership import Ownership
from agentface.view.gl.programs import FRAME_BINDING, Programs
from agentface.view.gl.quality import quality_named
from agentface.view.gl.shadow import KeyShadow
from agentface.view.gl.targets import Targets, checked_size
from agentface.view.gl.uniforms import pack_frame, pixels_a_metre, shadow_projection, unit
from agentface.view.hair.head_hair import HeadHair
from agentface.view.hair.ribbons import HairArray
from agentface.view.parts.anchored import AnchoredArray, eye_linings
from agentface.view.parts.bone import Bone, BoneView
from agentface.view.parts.mouth import Mouth
from agentface.view.parts.rigid import IRIS_RADIUS, Eyeball, RigidPart
from agentface.view.parts.shirt import shirt_mesh
from agentface.view.skin.meshes import Skin, SkinFields, SkinMeshes
from agentface.view.skin.wrinkle_atlas import WrinkleAtlas

_FRAME_BYTES = 3 * 64 + 11 * 16
_LONGEST_EDGE = 16.0  # pixels; longer edges of fine skin are cut and curved
_SPARE_PIXELS = 400_000  # samples, of 20 bytes, that pictures of other sizes may keep
_COARSEST, _FINEST = 6, 10  # the lengths of those edges are powers of two: 16 mm to 1 mm


class Renderer:
    """Draws one face.

    Args:
        model: the face.
        look: its colours and lights; the model's own ``look.yaml`` when None.
        context: a ``moderngl.Context``; a headless one is opened when None.

    A context of its own is current only while it draws: a program's own, and its state, stay as they are, and any
    thread may draw, one at a time. In a ``context`` that is given, what OpenGL is set to and bound to is changed.
    ``with Renderer(model) as renderer:`` closes it in the end.

    Raises GraphicsError when there is no OpenGL, a shader does not compile, or the process may not draw.
    """

    def __init__(self, model: HeadModel, look: Look | None = None, context: Any = None) -> None:
        self.model = model
        self.look = look if look is not None else load_look(model)
        self._ownership = Ownership(context)
        self._finalizer = weakref.finalize(self, self._ownership.abandon)
        self._finalizer.atexit = False  # the system takes everything back then
        self.context = self._ownership.context
        self._targets: dict[tuple[tuple[int, int], int], Targets] = {}
        with self._ownership.current():
            self._build(self._ownership.maker)

    @shader_names()
    def _build(self, context: Any) -> None:
        """Hand to the GPU what stays the same in all pictures."""
        model = self.model
        self._lost = LostContextCheck(context)
        self._aside = context.framebuffer([context.renderbuffer((1, 1), 4)])
        self._frame = context.buffer(reserve=_FRAME_BYTES)
        chance, lips, grown = irregularities(model, self.look), fine_lips(model), grown_hair(model, self.look)
        self._noise = context.texture3d(chance.noise.shape[:3], 4, chance.noise.tobytes())
        self._picture = skin_texture(context, self.look)
        self._programs = Programs(context, textured=self._picture is not None)
        self._screens = {name: context.vertex_array(self._programs[name], []) for name in ("background", "copy")}
        self._fields = SkinFields(context, model, lips)
        self._wrinkles = WrinkleAtlas(context, model, unit(self.look.lights.key.towards), chance.grain)
        self._head_hair = None if grown is None else HeadHair(context, self._programs, model, self.look.hair, grown)
        self._shadow = KeyShadow(context, self._programs.depth, model)
        dressed = dressed_skin(model, self.look, grown)
        self._meshes = SkinMeshes(model, lips, {**dressed, "lit_at_rest": self._lit_at_rest(model.normals)})
        self._skins: dict[tuple[str, int], Skin] = {}
        self._mouth = Mouth(context, self._programs["part"], model)
        self._eyes = [Eyeball(context, self._programs["eye"], model, side) for side in SIDES]
        self._shirt = RigidPart(context, self._programs["cloth"], shirt_mesh(model))
        self._linings = [
            AnchoredArray(context, self._programs["lining"], mesh, model.vertices) for mesh in eye_linings(model)
        ]
        self._hairs = [
            HairArray(context, self._programs["ribbon"], hairs, softness)
            for hairs, softness in zip((chance.brows, chance.lashes), SOFTNESSES, strict=True)
        ]
        self._programs.wear(self.look)
        self._programs.set({"atlas_height": self._wrinkles.height, "iris_radius": IRIS_RADIUS})

    def current(self) -> AbstractContextManager[None]:
        """A block in which several pictures are drawn with no change of contexts between them.

        It ends with the context current that was so before. Raises GraphicsError as :meth:`render`.
        """
        return self._ownership.current()

    def close(self) -> None:
        """Give back to the driver what was taken from it; it cannot draw any more. A second time does nothing.

        Without it, that happens when the renderer is collected; but in a ``context`` that was given everything then
        waits for its owner's ``context.gc()``.
        """
        self._finalizer.detach()
        self._ownership.release()
        self._targets.clear()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def render(
        self,
        geometry: FaceGeometry,
        size: tuple[int, int] = (1280, 720),
        camera: Camera | str = "front",
        quality: str = "fast",
        *,
        alpha: bool = False,
        bone: Bone | None = None,
    ) -> Bytes:
        """A picture of ``geometry`` as ``(height, width, 3)`` uint8 sRGB, the top row first.

        Args:
            geometry: the face at one instant.
            size: width and height in pixels, 1..8192 each.
            camera: a camera, or the name of a view: front, three-quarter, profile.
            quality: ``fast`` or ``portrait``.
            alpha: leave the background out: ``(height, width, 4)`` with straight (not premultiplied) alpha.
            bone: show this under the skin, which is then a film, without hair.

        Raises InvalidValueError for a wrong size, UnknownNameError for an unknown view or quality, GraphicsError when
        the driver has lost the context, in a child forked after the parent had drawn, and after :meth:`close`.
        """
        with self._ownership.current():
            targets = self._targets_for(size, quality)
            self.draw(geometry, targets, camera, quality, alpha=alpha, bone=bone)
            finish(self.context)
            picture = targets.read(alpha=alpha)
            self._lost.check()
        return picture

    @shader_names()
    def draw(
        self,
        geometry: FaceGeometry,
        targets: Targets,
        camera: Camera | str,
        quality: str,
        onto: Any = None,
        *,
        alpha: bool = False,
        bone: Bone | None = None,
    ) -> None:
        """Draw into the picture of ``targets``, and copy it to the framebuffer ``onto``; the rest as :meth:`render`."""
        with self._ownership.current():
            self._draw(geometry, targets, camera, quality, alpha=alpha, bone=bone)
            if onto is not None:
                onto.use()
                targets.light.use(0)
                self._screens["copy"].render(self.context.TRIANGLES, 3)

    def _draw(
        self,
        geometry: FaceGeometry,
        targets: Targets,
        camera: Camera | str,
        quality: str,
        *,
        alpha: bool,
        bone: Bone | None,
    ) -> None:
        context, detail = self.context, quality_named(quality)
        seen_from = named_view(self.model, camera) if isinstance(camera, str) else camera
        self.upload_skin(geometry)
        self._frame.write(pack_frame(seen_from, targets.size, geometry.head, self.look.lights))
        self._frame.bind_to_uniform_block(FRAME_BINDING)
        self._fields.texture.use(0)
        self._noise.use(1)
        self._wrinkles.texture.use(3)
        if self._picture is not None:
            self._picture.use(4)
        if detail.fine:
            self._pores.use(5)
            self._shadow.draw()
        self._shadow.use(2)
        self._clear(targets, alpha=alpha)
        context.enable_only(context.DEPTH_TEST)
        if bone is None:
            self._draw_face(geometry, targets, seen_from, quality)
        else:
            self._draw_bone(geometry, targets, bone)
        context.enable_only(context.NOTHING)
        if targets.samples:
            finish(context)
            context.copy_framebuffer(targets.picture, targets.scene)

    def _draw_face(self, geometry: FaceGeometry, targets: Targets, seen_from: Camera, quality: str) -> None:
        context, head_hair = self.context, self._head_hair
        if head_hair is not None:
            head_hair.draw_solid(quality, seen_from, geometry.head)
            self._begin(targets)
        self.upload_wrinkles(geometry)
        if quality_named(quality).fine:
            self._fields.update_lips(geometry)
        self._programs.set(self._mouth.opening(geometry))
        self._skin(quality, pixels_a_metre(seen_from, targets.size)).draw(wrinkled=self._wrinkled)
        self._begin(targets)
        if head_hair is not None:
            head_hair.draw_inside()
        self._draw_solids(geometry)
        context.enable_only(context.DEPTH_TEST | context.BLEND)
        context.blend_func = context.SRC_ALPHA, context.ONE_MINUS_SRC_ALPHA, context.ONE, context.ONE_MINUS_SRC_ALPHA
        for hairs in self._hairs:
            hairs.draw()
        if head_hair is not None:
            head_hair.draw_soft(quality, targets.scene)

    def _draw_bone(self, geometry: FaceGeometry, targets: Targets, bone: Bone) -> None:
        self._bones.draw(geometry, bone)
        self.context.enable(self.context.CULL_FACE)
        self._shirt.draw(geometry.shoulders)
        for eye in self._eyes:
            eye.draw(geometry)
        self._bones.draw_film(self.context, targets.scene)

    @cached_property
    def _bones(self) -> BoneView:
        return BoneView(self._ownership.maker, self._programs, self.model)

    @cached_property
    def _pores(self) -> Any:
        volume = pores()
        return self._ownership.maker.texture3d(volume.shape[:3], 4, volume.tobytes())

    def upload_skin(self, geometry: FaceGeometry) -> None:
        """Hand the skin of the frame to the GPU; ``draw`` does it itself."""
        with self._ownership.current():
            self._fields.update(geometry)

    def upload_wrinkles(self, geometry: FaceGeometry) -> None:
        """Hand its wrinkles to the GPU; ``draw`` does it itself."""
        with self._ownership.current():
            self._wrinkled = self._wrinkles.update(geometry.wrinkle_levels)

    def _begin(self, targets: Targets) -> None:
        """Let a software driver begin with what it has been told: it waits until another picture is drawn into."""
        self._aside.clear()
        targets.scene.use()

    def _draw_solids(self, geometry: FaceGeometry) -> None:
        self.context.enable(self.context.CULL_FACE)
        self._mouth.draw(geometry)
        self._shirt.draw(geometry.shoulders)
        for lining in self._linings:
            lining.draw()
        for eye in self._eyes:
            eye.draw(geometry)

    def _clear(self, targets: Targets, *, alpha: bool) -> None:
        import moderngl

        if not targets.painted:
            targets.backdrop.use()
            self.context.enable_only(moderngl.NOTHING)
            self._programs["background"]["aspect"].value = targets.size[0] / targets.size[1]
            self._screens["background"].render(moderngl.TRIANGLES, 3)
            targets.painted = True
        if alpha:
            targets.scene.clear(0.0, 0.0, 0.0, 0.0)
        else:
            self.context.copy_framebuffer(targets.scene, targets.backdrop)
            targets.scene.color_mask = (False,) * 4
            targets.scene.clear()  # depth alone
            targets.scene.color_mask = (True,) * 4
        targets.scene.use()

    def _skin(self, quality: str, pixels_a_metre: float) -> Skin:
        """The skin of a quality, cut finely enough where a metre is so many pixels."""
        detail = quality_named(quality)
        octave = round(np.log2(pixels_a_metre / _LONGEST_EDGE)) if detail.fine else 0
        octave = min(max(octave, _COARSEST), _FINEST) if detail.fine else 0
        if (quality, octave) not in self._skins:
            mesh = self._meshes.fine(2.0**-octave) if detail.fine else self._meshes.coarse()
            self._skins[quality, octave] = Skin(self._ownership.maker, self._programs.skins(detail.skin), mesh)
        return self._skins[quality, octave]

    def _lit_at_rest(self, normals: Floats) -> Floats:
        model, lights = self.model, self.look.lights
        geometry = FaceGeometry.at_rest(model, normals=normals)
        self._frame.write(pack_frame(named_view(model, "front"), (1, 1), geometry.head, lights))
        self._frame.bind_to_uniform_block(FRAME_BINDING)
        self._fields.update(geometry)
        self._fields.texture.use(0)
        self._shadow.draw()
        return self._shadow.lit(model.vertices, normals, shadow_projection(lights))

    def _targets_for(self, size: tuple[int, int], quality: str) -> Targets:
        key = checked_size(size), quality_named(quality).samples
        targets = self._targets.pop(key, None)
        if targets is None:
            spare = _SPARE_PIXELS
            for other in reversed(list(self._targets)):  # what was drawn last may soon be wanted again
                spare -= other[0][0] * other[0][1] * max(other[1], 1)
                if spare < 0:
                    self._targets.pop(other).release()
            targets = Targets.make(self._ownership.maker, *key)
        self._targets[key] = targets
        return targets
