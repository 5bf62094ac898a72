"""The live window, as it is on a virtual display of its own: a picture of the screen."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from agentface.errors import GraphicsError

SIZE = (1280, 800)
_FRAMES = 12
"""After so many the panel has found its layout and the driver has drawn everything once."""
_TIMEOUT_S = 120


def figures(face: str | Path) -> dict[str, bytes]:
    """``window.png``: the window with its panel, and a smile.

    Raises GraphicsError without Xvfb (Debian's xvfb and xauth), or when the window does not open.
    """
    if not (shutil.which("xvfb-run") and shutil.which("xauth")):
        raise GraphicsError(
            "the picture of the window: expected xvfb-run, a virtual display; "
            "apt-get install --no-install-recommends xvfb xauth"
        )
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "window.png"
        screen = f"-screen 0 {SIZE[0]}x{SIZE[1]}x24 -noreset"
        command = ["xvfb-run", "--auto-servernum", f"--server-args={screen}", sys.executable, "-m", __name__]
        done = subprocess.run(  # noqa: S603 - our own command
            [*command, str(face), str(picture)], check=False, capture_output=True, text=True, timeout=_TIMEOUT_S
        )
        if done.returncode:
            raise GraphicsError(f"the picture of the window: expected it to open: {done.stderr.strip()[-500:]}")
        return {"window.png": picture.read_bytes()}


def photograph(face: str, path: str | Path) -> None:
    """Open the window on the display at hand, which it fills, and write what the display shows."""
    from PIL import ImageGrab

    from agentface.face import Face
    from agentface.studies.figures.overlay import in_colours
    from agentface.window.window import Window

    shown = Face(face)
    shown.set_emotion("happiness", 0.75, fade=0.0)
    window = Window(shown, size=SIZE, quality="portrait")
    frames = 0

    def each_frame() -> None:
        nonlocal frames
        frames += 1
        shown.set_gaze(6.0 + 0.1 * frames, 1.0, fade=0.0)  # a still face would not be drawn again
        if frames == _FRAMES:
            Path(path).write_bytes(in_colours(ImageGrab.grab()))
            window.controls.closing = True

    window.run(each_frame=each_frame)


if __name__ == "__main__":
    photograph(sys.argv[1], sys.argv[2])
