"""``agentface render``: one picture."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from agentface.commands.options import (
    action_unit_option,
    angles,
    assignments,
    camera_option,
    emotion_option,
    face_options,
    look_option,
    make_face,
    point,
    quality_option,
    size_option,
)

if TYPE_CHECKING:
    from agentface.commands.options import AskedUnit
    from agentface.requests import Request


@click.command()
@emotion_option
@click.option(
    "--muscle",
    "muscles",
    multiple=True,
    callback=assignments,
    metavar="NAME=V",
    help="A muscle, 0..1.",
)
@action_unit_option
@click.option(
    "--fap",
    "faps",
    multiple=True,
    callback=assignments,
    metavar="N=V",
    help="A FAP of MPEG-4 by its number 3..68, in its unit.",
)
@click.option("--gaze", callback=angles, metavar="YAW,PITCH", help="Degrees to the person's left, and upward.")
@click.option(
    "--look-at",
    callback=point,
    metavar="X,Y,Z",
    help="A point to look at instead: metres to the person's left, up and forward of the head's origin.",
)
@click.option(
    "--parameter",
    "parameters",
    multiple=True,
    callback=assignments,
    metavar="NAME=V",
    help="Any other parameter; an angle in radians, or in degrees as in head_yaw_deg=20.",
)
@click.option("--jaw", type=float, metavar="V", help="Opening of the jaw, 0..1.")
@look_option
@size_option
@quality_option
@camera_option
@click.option("--alpha", is_flag=True, help="Leave the background out: a transparent picture.")
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, metavar="FILE.png")
@face_options
def render(
    *,
    emotions: dict[str, float],
    muscles: dict[str, float],
    parameters: dict[str, float],
    action_units: list[AskedUnit],
    faps: dict[str, float],
    gaze: tuple[float, float] | None,
    look_at: tuple[float, float, float] | None,
    jaw: float | None,
    look: str | None,
    size: tuple[int, int],
    quality: str,
    camera: str,
    alpha: bool,
    output: Path,
    face: str,
    deformer: str,
) -> None:
    """Write a picture of a face.

    Emotions and muscles may be given several times: --emotion happiness=0.6 --emotion surprise=0.4
    """
    from agentface.emotion.state import EmotionState
    from agentface.io.files import check_writable
    from agentface.io.picture import check_picture_name, write_picture
    from agentface.requests import LookAt, SetActionUnit, SetEmotions, SetFaps, SetGaze, SetMuscle, SetParameter

    if gaze is not None and look_at is not None:
        raise click.UsageError("--gaze and --look-at both say where the eyes look: give one of them")
    check_picture_name(output, alpha=alpha)
    check_writable(output)
    requests: list[Request] = [SetEmotions(EmotionState.of(emotions), 0.0)]
    requests += [SetMuscle(name, contraction, 0.0) for name, contraction in muscles.items()]
    requests += [SetActionUnit(number, level, side, 0.0) for number, level, side in action_units]  # type: ignore[arg-type]
    if faps:
        requests.append(SetFaps(_numbered(faps), fade=0.0))
    if jaw is not None:
        requests.append(SetMuscle("jaw_open", jaw, 0.0))
    if gaze is not None:
        requests.append(SetGaze(*gaze, fade=0.0))
    if look_at is not None:
        requests.append(LookAt(*look_at, fade=0.0))
    requests += [SetParameter(name, value, 0.0) for name, value in parameters.items()]
    shown = make_face(face, deformer, compiled=False, look=look)  # one frame does not pay for loading the compiler
    for request in requests:
        shown.apply(request)
    write_picture(output, shown.render(size, camera, quality, alpha=alpha))


def _numbered(faps: dict[str, float]) -> tuple[tuple[int, float], ...]:
    for number in faps:
        if not number.isdecimal():
            raise click.BadParameter(f"expected N=V with the number of a FAP, got {number!r}; for example 3=400")
    return tuple((int(number), value) for number, value in faps.items())
