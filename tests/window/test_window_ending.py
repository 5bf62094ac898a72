"""However a window ends, the film that it was making is valid."""

from __future__ import annotations

import os
import re
import subprocess
import sys

import pytest

from tests.display import on_a_virtual_display
from tests.tools import require

pytestmark = [pytest.mark.gl, pytest.mark.slow, pytest.mark.untraced]

FILMING = """
"$0" -m agentface $COMMAND &
face=$!
until window=$(xdotool search --name "for help"); do kill -0 $face || exit; sleep 0.1; done
until ls *.mp4 2>/dev/null; do
    xdotool windowfocus $window key r  # lost while the window is not ready; a second one ends the film
    for turn in $(seq 80); do kill -0 $face || exit; ls *.mp4 2>/dev/null && break; sleep 0.25; done
done
until "$0" -c "$1" *.mp4 2>/dev/null; do kill -0 $face || exit; sleep 0.1; done
$END
wait $face
echo code $?
"""

WRITTEN = """
import sys, av
with av.open(sys.argv[1]) as film:
    sys.exit(max(float(frame.time) for frame in film.decode(video=0)) <= 0.4)
"""


@pytest.mark.parametrize(
    ("command", "end", "code"),
    [
        ("show", "kill -HUP $face", 0),
        ("serve --osc 127.0.0.1:0 --view window", "kill -INT $face; kill -INT $face", 0),
        ("show", "xdotool windowkill $window", 1),  # as when the display goes away
        ("show", "xdotool key --window $window Escape", 0),
    ],
    ids=["hangup", "interrupted-twice", "display", "escape"],
)
def test_the_film_of_a_window_that_ends(tmp_path, command, end, code):
    require("xvfb-run", "xauth", "xdotool")
    import av

    pytest.importorskip("glfw")
    script = FILMING.replace("$COMMAND", command).replace("$END", end)
    done = subprocess.run(
        [*on_a_virtual_display(), "sh", "-c", script, sys.executable, WRITTEN],
        check=False, capture_output=True, text=True, timeout=240, cwd=tmp_path, env=os.environ | {"DISPLAY": ""},
    )  # fmt: skip
    assert f"code {code}" in done.stdout, done.stdout + done.stderr
    (path,) = tmp_path.glob("*.mp4")
    assert re.search(rf"filmed \d+\.\d s: {path}", done.stdout)
    with av.open(str(path)) as film:
        assert max(float(frame.time) for frame in film.decode(video=0)) > 0.4
