"""What commands that film share: how a film is seen, and where it goes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from agentface.commands.progress import progress

if TYPE_CHECKING:
    from agentface.conventions import Bytes
    from agentface.deform.geometry import FaceGeometry
    from agentface.head.model import HeadModel
    from agentface.io.sequence import SequenceWriter
    from agentface.io.sound_track import Heard
    from agentface.io.video import VideoWriter
    from agentface.live.films import FilmSink


@dataclass(frozen=True)
class Shot:
    """How a film is seen and where it goes; a path that ends with .png is that of numbered transparent pictures.

    ``live``: it cannot be filmed again, so that an error keeps what there is.
    """

    path: Path
    size: tuple[int, int]
    camera: str
    quality: str
    fps: float
    look: str | None = None
    live: bool = False

    @contextmanager
    def open(self, model: HeadModel, last_s: float | None = None, sound: Heard | None = None) -> Iterator[FilmSink]:
        """Films ``model`` until the end of the block; the bar is full at ``last_s``, without it there is none.

        ``sound`` is heard from its start; numbered pictures come without it.

        What cannot be written or drawn is told at its beginning, and then, as without frames, no file is left. All of
        it is for one thread: OpenGL draws in the one that begins.
        """
        from agentface.live.films import FilmSink

        with self._writer(sound) as writer, progress(self.path.name, last_s) as advance:
            yield FilmSink(self._drawing(model), writer, advance)

    def _drawing(self, model: HeadModel) -> Callable[[FaceGeometry], Bytes]:
        from agentface.deform.geometry import FaceGeometry
        from agentface.head.look import load_look
        from agentface.view.renderer import Renderer

        renderer = Renderer(model, load_look(model, self.look))

        def draw(geometry: FaceGeometry) -> Bytes:
            return renderer.render(geometry, self.size, self.camera, self.quality, alpha=self._transparent)

        # the first picture takes a driver longer than those that follow
        draw(FaceGeometry.at_rest(model))
        return draw

    @property
    def _transparent(self) -> bool:
        return self.path.suffix.lower() == ".png"

    def _writer(self, sound: Heard | None) -> VideoWriter | SequenceWriter:
        if self._transparent:
            from agentface.io.sequence import SequenceWriter

            return SequenceWriter(self.path, self.size, self.fps, keep=self.live)
        from agentface.io.video import VideoWriter

        return VideoWriter(self.path, self.size, self.fps, keep=self.live, sound=sound)
