"""Poses as NumPy's NPZ: for long performances, and for programs in Python."""

from __future__ import annotations

import math
import zipfile
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from agentface.errors import DataError, FaultList, shown
from agentface.io.performances.poses import FIELDS, fields_of, performance_of
from agentface.motion.performance import Performance

LARGEST_FILE = 256 * 1024 * 1024
LARGEST_CONTENT = 256 * 1024 * 1024
"""Bytes, and those of all arrays unpacked: a small archive can hold a million times its size."""
_TEXTS = ("format", "name", "sound")
_SINGLE = ("version", "rate_hz")
_LISTS = ("units", "parameters")
_NUMBERS = ("times_s", "weights", "poses")
_LAST_CHARACTER, _SURROGATES = 0x10FFFF, (0xD800, 0xDFFF)


def write_npz(performance: Performance) -> bytes:
    """The archive of a performance; :func:`read_npz` gives back the same. The same performance gives the same bytes."""
    content = BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_STORED) as archive:
        for name, field in fields_of(performance).items():
            array = BytesIO()
            np.lib.format.write_array(array, np.asarray(field), allow_pickle=False)
            archive.writestr(zipfile.ZipInfo(f"{name}.npy"), array.getvalue())
    return content.getvalue()


def read_npz(data: bytes, where: str | Path = "poses.npz") -> Performance:
    """The performance that an archive holds; ``where`` is what messages call it.

    No object is unpickled, and no array is made that its file does not have. Raises DataError with the faults of the
    archive, 20 at most.
    """
    faults = FaultList(where)
    if len(data) > LARGEST_FILE:
        faults.stop(None, "", f"at most {LARGEST_FILE:,} bytes", "more")
    fields: dict[str, Any] = {}
    for name, array in _arrays(data, faults).items():
        if name in _TEXTS and array.shape == () and _is_text(array):
            fields[name] = str(array)
        elif name in _LISTS and array.ndim == 1 and _is_text(array):
            fields[name] = array.tolist()
        elif name in _SINGLE and array.shape == () and array.dtype.kind in "fiu":
            fields[name] = array.item()
        else:  # of another field than these, whatever it is, it is refused as a list of something
            fields[name] = array if name in _NUMBERS else [array.shape]
    return performance_of(fields, faults)


def _arrays(data: bytes, faults: FaultList) -> dict[str, np.ndarray[Any, Any]]:
    arrays: dict[str, np.ndarray[Any, Any]] = {}
    try:
        with zipfile.ZipFile(BytesIO(data)) as archive:
            infos = archive.infolist()
            if len(infos) > len(FIELDS) or sum(info.file_size for info in infos) > LARGEST_CONTENT:
                faults.stop(None, "", f"{len(FIELDS)} arrays of at most {LARGEST_CONTENT:,} bytes in all", "more")
            for info in infos:
                arrays[info.filename.removesuffix(".npy")] = _array(archive.read(info), info.filename, faults)
    except DataError:
        raise
    except Exception as error:  # of zipfile, zlib, lzma, ast and tokenize, each its own
        faults.stop(None, "", "an archive of NumPy arrays (.npz)", shown(str(error) or type(error).__name__))
    return arrays


def _array(content: bytes, name: str, faults: FaultList) -> np.ndarray[Any, Any]:
    stream = BytesIO(content)
    version = np.lib.format.read_magic(stream)
    if version == (1, 0):
        shape, _, dtype = np.lib.format.read_array_header_1_0(stream)
    else:
        shape, _, dtype = np.lib.format.read_array_header_2_0(stream)
    there = len(content) - stream.tell()
    if dtype.hasobject or not dtype.itemsize or math.prod(shape) * dtype.itemsize != there:
        faults.stop(None, name, f"numbers or texts, {there} bytes of them as the archive has", f"{dtype} of {shape}")
    stream.seek(0)
    array: np.ndarray[Any, Any] = np.lib.format.read_array(stream, allow_pickle=False)
    return array


def _is_text(array: np.ndarray[Any, Any]) -> bool:
    """Whether every character of an array of texts is one; of others Python cannot make a text."""
    if array.dtype.kind != "U":
        return False
    codes = np.frombuffer(array.tobytes(), np.dtype(np.uint32).newbyteorder(array.dtype.byteorder))
    surrogates = (codes >= _SURROGATES[0]) & (codes <= _SURROGATES[1])
    return not ((codes > _LAST_CHARACTER) | surrogates).any()
