"""Pictures as files."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

from agentface.conventions import Bytes
from agentface.errors import OutputError
from agentface.io.files import write_file

_FORMATS = {".png": "PNG", ".webp": "WEBP", ".jpg": "JPEG", ".jpeg": "JPEG"}
_WITH_ALPHA = (".png", ".webp")


def check_picture_name(path: str | Path, *, alpha: bool = False) -> None:
    """Raise OutputError for a name whose ending is no picture format, or none that can be transparent."""
    path = Path(path)
    known = _WITH_ALPHA if alpha else tuple(_FORMATS)
    if path.suffix.lower() not in known:
        kind = " for a transparent picture" if alpha else ""
        raise OutputError(
            f"{path}: expected a name that ends in {', '.join(known)}{kind}, got {path.suffix or 'no ending'!r}"
        )


def write_picture(path: str | Path, image: Bytes) -> None:
    """Write ``image`` ``(H, W, 3)``, or ``(H, W, 4)`` with straight alpha, uint8; raises OutputError."""
    path = Path(path)
    write_file(path, encode(image, path))


def encode(image: Bytes, path: str | Path) -> bytes:
    """The file of ``image`` in the format that the ending of ``path`` says; raises OutputError for another ending."""
    from PIL import Image

    path = Path(path)
    check_picture_name(path, alpha=image.shape[-1] == 4)
    buffer = BytesIO()
    # Level 4 takes half the time of the usual 6 for a file a tenth larger.
    Image.fromarray(image).save(buffer, _FORMATS[path.suffix.lower()], compress_level=4)
    return buffer.getvalue()
