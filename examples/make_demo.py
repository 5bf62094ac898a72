"""What ``make demo`` runs: a sheet of expressions, and a talking face that a separate process drives over OSC."""

from __future__ import annotations

import argparse
import signal
import socket
import subprocess
import sys
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

from agentface import EMOTIONS, AgentFaceError, Face
from agentface.speech.voices.choose import open_voice

HERE = Path(__file__).resolve().parent
TILE = 480
LABEL = 56
MIXTURE = {"happiness": 0.8, "surprise": 0.3}


def draw_expressions(path: Path) -> None:
    """The neutral face, the six emotions at full strength and a mixture, each with its name."""
    face = Face()
    sheet = Image.new("RGB", (4 * TILE, 2 * (TILE + LABEL)), "#14181c")
    pen = ImageDraw.Draw(sheet)
    shown = {"neutral": {}} | {name: {name: 1.0} for name in EMOTIONS} | {"happiness 0.8, surprise 0.3": MIXTURE}
    for place, (name, emotions) in enumerate(shown.items()):
        face.set_emotion(emotions, fade=0.0)
        left, top = TILE * (place % 4), (TILE + LABEL) * (place // 4)
        sheet.paste(Image.fromarray(face.render((TILE, TILE), quality="portrait")), (left, top))
        middle = (left + TILE / 2, top + TILE + LABEL / 2)
        pen.text(middle, name, "#e8e4dc", ImageFont.load_default(26), anchor="mm")
    sheet.save(path)


def film_agent(path: Path, pace: float, *words: str) -> None:
    """A running server films its face while the agent of another process tells it what to feel and to say."""
    port = free_port()
    command = [sys.executable, "-m", "agentface", "serve", "--osc", f"127.0.0.1:{port}", "--record", str(path)]
    with subprocess.Popen([*command, "--every-frame", "--size", "540x540"]) as server:  # noqa: S603  # our own program
        try:
            agent = [sys.executable, str(HERE / "osc_agent.py"), "--osc", f"127.0.0.1:{port}", "--wait", "120"]
            subprocess.run([*agent, "--pace", str(pace), *words], check=True)  # noqa: S603  # our own program
        finally:
            server.send_signal(signal.SIGINT)
    if server.returncode:
        raise SystemExit(f"agentface serve ended with code {server.returncode}")


def film_recording(path: Path) -> None:
    """A face says a recording of which the times of the phones are known: nothing but agentface is needed."""
    command = [sys.executable, "-m", "agentface", "say", "--phones", str(HERE / "hello.json"), "-o", str(path)]
    subprocess.run([*command, "--emotion", "happiness=0.5", "--size", "540x540"], check=True)  # noqa: S603  # our own


def voice_missing() -> str:
    """What to install for a voice; empty where there is one."""
    try:
        open_voice().close()
    except AgentFaceError as error:
        return str(error)
    return ""


def free_port() -> int:
    """A UDP port that nobody has."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def main() -> None:
    """Run the example."""
    parser = argparse.ArgumentParser(description="Make out/expressions.png and out/demo.mp4.")
    parser.add_argument("--out", type=Path, default=Path("out"))
    parser.add_argument("--pace", type=float, default=1.0)
    parser.add_argument("--mute", action="store_true", help="without words")
    options = parser.parse_args()

    options.out.mkdir(parents=True, exist_ok=True)
    try:
        draw_expressions(options.out / "expressions.png")
    except AgentFaceError as error:
        raise SystemExit(str(error)) from error
    missing = voice_missing()
    recording = ("--phones", str(HERE / "hello.json")) if missing else ()
    film_agent(options.out / "demo.mp4", options.pace, *(("--mute",) if options.mute else recording))
    print(f"\n{options.out / 'expressions.png'}: the neutral face and the six emotions")
    print(f"{options.out / 'demo.mp4'}: an agent in another process talks OSC to the face, which feels and speaks")
    if missing and not options.mute:
        film_recording(options.out / "hello.mp4")
        print(f"{options.out / 'hello.mp4'}: the face says a recording. demo.mp4 is silent: {missing}")
    print("\nFor a live window:           agentface show      (keys 1 to 6 raise an emotion each)")
    print("For one that takes OSC:      agentface serve --view window")
    print("and in a second terminal:    python examples/osc_agent.py")


if __name__ == "__main__":
    main()
