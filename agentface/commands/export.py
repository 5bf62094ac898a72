"""``agentface export``: the face as a file that other programs show."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from agentface.commands.ending import Ending, until_told
from agentface.commands.options import face_options, json_option, look_option, make_face, write_json
from agentface.commands.progress import progress
from agentface.commands.recordings import USUAL_HZ, Opened, file_fps_option, opened, player_of
from agentface.commands.streams import tell

if TYPE_CHECKING:
    from agentface.face import Face
    from agentface.io.gltf.recorder import SurfaceRecorder
    from agentface.io.web.performance_page import PerformancePage


_SHAPES, _EXPRESSIONS = 52, 18 + 52


@dataclass(frozen=True)
class Asked:
    """What the options say."""

    output: Path
    performance: Path | None
    shapes: str | None
    error_mm: float
    fps: float | None
    file_fps: float | None
    look: str | None
    face: str
    deformer: str


@click.command()
@click.argument("output", type=click.Path(path_type=Path), metavar="FILE")
@click.option(
    "--performance",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="What the face does in it: a file as for agentface play. Its sound is written beside it.",
)
@click.option(
    "--shapes",
    type=click.Choice(["arkit", "exact"]),
    help="Of a .glb: ARKit's 52, or the performance's own; if not given, these where there is a performance.",
)
@click.option(
    "--error-mm",
    type=click.FloatRange(0.01, 10),
    default=0.1,
    show_default=True,
    help="With --shapes exact: how far a vertex may be off; the file has as few shapes as that takes.",
)
@click.option(
    "--fps", type=click.FloatRange(1, 240), help="Frames a second; the performance's own, or 30, if not given."
)
@file_fps_option
@look_option
@json_option
@face_options
def export(*, json_file: str | None, **options: Any) -> None:
    """Write a face for other programs: .glb for anything that draws, .vrm for avatars, .html for browsers.

    \b
    agentface export amber.glb                               # with ARKit's 52 shapes
    agentface export smile.glb --performance smile.fap       # what the face does, to 0.1 mm
    agentface export onyx.vrm --face onyx                    # VRM 1.0: expressions, visemes, look-at
    agentface export hello.html --performance hello.bml      # plays in any browser, with its sound, without a network
    """  # noqa: D301 - \b is click's mark of lines to keep
    from agentface.io.files import check_writable

    asked = Asked(**options)
    kind = _KINDS.get(asked.output.suffix.lower())
    if kind is None:
        endings = ", ".join(_KINDS)
        raise click.UsageError(f"expected a FILE that ends in {endings}, got {asked.output.suffix or 'no ending'!r}")
    check_writable(asked.output)
    figures = kind(asked)
    if json_file is not None:
        write_json(json_file, {"file": str(asked.output), **figures})


def _glb(asked: Asked) -> dict[str, Any]:
    from agentface.deform.protocol import make_deformer
    from agentface.head.look import load_look
    from agentface.io.files import write_file
    from agentface.io.gltf.face_glb import FaceGlb

    shapes = asked.shapes or ("arkit" if asked.performance is None else "exact")
    if shapes == "exact" and asked.performance is None:
        raise click.UsageError("--shapes exact goes with --performance FILE, whose shapes they are")
    found = None if asked.performance is None else opened(asked.performance, asked.file_fps)
    face = make_face(asked.face, asked.deformer, look=asked.look, running=True)
    made = FaceGlb(face.model, load_look(face.model, asked.look), make_deformer(asked.deformer, face.model))
    with until_told() as ending:
        played = None if found is None else _playing(face, found, asked.fps, ending)
        if shapes == "arkit":
            with progress("shapes", _SHAPES) as told:
                made.bake(told)
            file = made.with_arkit(played)
        else:
            assert played is not None, "checked above"  # noqa: S101 - for the type checker
            file = made.with_modes(played, asked.error_mm)
    write_file(asked.output, file.content)
    sound = None if found is None else _write_sound(found, asked.output)
    _tell_figures(asked.output, file.figures)
    return {"format": "glb", "kind": shapes, **file.figures, "sound": sound}


def _vrm(asked: Asked) -> dict[str, Any]:
    from agentface.deform.protocol import make_deformer
    from agentface.head.look import load_look
    from agentface.head.model import load_model
    from agentface.io.files import write_file
    from agentface.io.vrm.avatar import encode_avatar

    for name, given in (("--performance", asked.performance), ("--shapes", asked.shapes)):
        if given is not None:
            raise click.UsageError(f"{name} goes with a .glb; an avatar has its own expressions, and no animation")
    model = load_model(asked.face)
    look, deformer = load_look(model, asked.look), make_deformer(asked.deformer, model)
    with progress("expressions", _EXPRESSIONS) as told:
        made = encode_avatar(model, look, deformer, told)
    write_file(asked.output, made.content)
    _tell_figures(asked.output, made.figures)
    return {"format": "vrm", **made.figures}


def _html(asked: Asked) -> dict[str, Any]:
    from agentface.head.look import load_look
    from agentface.io.files import write_file
    from agentface.io.web.performance_page import PerformancePage
    from agentface.io.web.stage import basis_of

    if asked.performance is None:
        raise click.UsageError("a .html plays a performance: --performance FILE says which")
    if asked.shapes is not None:
        raise click.UsageError("--shapes goes with a .glb; a page has the modes of its deformer")
    found = opened(asked.performance, asked.file_fps)
    face = make_face(asked.face, asked.deformer, look=asked.look, running=True)
    PerformancePage.check()
    basis = basis_of(face, asked.deformer, tell, partial(progress, total=1.0))
    page = PerformancePage(face.model, load_look(face.model, asked.look), basis)
    with until_told() as ending:
        _playing(face, found, asked.fps, ending)(page)
    sound = found.sound()
    content = page.content(sound).encode()
    write_file(asked.output, content)
    tell(f"{asked.output}: {len(content) / 1e6:.2f} MB, {page.frames} frames, opens in any browser")
    return {"format": "html", "bytes": len(content), "frames": page.frames, "sound": sound is not None}


def _playing(
    face: Face, found: Opened, fps: float | None, ending: Ending
) -> Callable[[SurfaceRecorder | PerformancePage], None]:
    from agentface.clock import FrameClock
    from agentface.io.gltf.face_glb import LONGEST
    from agentface.live.loop import run

    source, length_s = player_of(found, face)
    rate = fps or getattr(found.recording, "rate_hz", None) or USUAL_HZ
    frames = math.ceil(length_s * rate - 1e-6)
    if frames > LONGEST:
        raise click.UsageError(f"expected at most {LONGEST} frames, got {frames}; choose a lower --fps")

    def play(recorder: SurfaceRecorder | PerformancePage) -> None:
        with progress(found.path.name, length_s) as told:
            recorder.told = told
            run(
                face,
                FrameClock(rate),
                [source],
                [recorder],
                fps=rate,
                duration=(frames - 0.5) / rate,
                stopped=ending.told,
            )
        if ending.told():
            tell("stopped; nothing is written")
            raise SystemExit(ending.code)

    return play


def _write_sound(found: Opened, output: Path) -> str | None:
    """The sound of a performance, beside the file, where it is not there itself; returns its path."""
    from agentface.io.sound import write_wav

    sound = found.sound()
    if sound is None:
        return None
    path, own = output.with_suffix(".wav"), getattr(found.recording, "sound", None)
    if own is None or not path.exists() or not path.samefile(found.path.parent / own):
        write_wav(path, sound)
    return str(path)


def _tell_figures(output: Path, figures: dict[str, Any]) -> None:
    said = f"{output}: {figures['bytes'] / 1e6:.2f} MB, {len(figures['shapes'])} shapes"
    if "error_max_mm" in figures:
        said += (
            f", {figures['frames']} frames, at most {figures['error_max_mm']:.3f} mm off"
            f" ({figures['error_rms_mm']:.3f} mm rms)"
        )
    tell(said)


_KINDS: dict[str, Callable[[Asked], dict[str, Any]]] = {".glb": _glb, ".vrm": _vrm, ".html": _html}
"""What writes a file, by its ending; it returns the figures of ``--json``."""
