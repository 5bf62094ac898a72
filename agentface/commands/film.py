"""What commands that film share: the writer, the progress bar, and how SIGTERM ends them."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from agentface.face import Face
    from agentface.io.sequence import SequenceWriter
    from agentface.io.video import VideoWriter
    from agentface.parameters import FacePose

Draw = Callable[["FacePose | None", float], None]
"""``draw(pose, time_s)`` adds a frame: of a pose, or for None of the face as it is then."""


@dataclass(frozen=True)
class Film:
    """Where a film goes and how it is seen; a path that ends with .png is that of numbered transparent pictures."""

    path: Path
    size: tuple[int, int]
    camera: str
    quality: str
    fps: float

    @contextmanager
    def open(self, face: Face, last_s: float | None) -> Iterator[Draw]:
        """Films ``face`` until the end of the block; the bar is full at ``last_s``, without it there is none."""
        transparent = self.path.suffix.lower() == ".png"
        with self._writer() as writer, _progress(self.path.name, last_s) as advance:

            def draw(pose: FacePose | None, time_s: float) -> None:
                writer.add(face.render(self.size, self.camera, self.quality, pose=pose, alpha=transparent), time_s)
                advance(time_s)

            yield draw

    def _writer(self) -> VideoWriter | SequenceWriter:
        if self.path.suffix.lower() == ".png":
            from agentface.io.sequence import SequenceWriter

            return SequenceWriter(self.path, self.size, self.fps)
        from agentface.io.video import VideoWriter

        return VideoWriter(self.path, self.size, self.fps)


@contextmanager
def terminated_as_interrupted() -> Iterator[None]:
    """Inside, SIGTERM is what Ctrl-C is: KeyboardInterrupt."""
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


@contextmanager
def _progress(name: str, total_s: float | None) -> Iterator[Callable[[float], None]]:
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True)
    if total_s is None or not console.is_terminal:
        yield lambda _: None
        return
    with Progress(console=console) as progress:  # rich's own columns end with the time left
        task = progress.add_task(name, total=total_s)
        yield lambda time_s: progress.update(task, completed=time_s)
