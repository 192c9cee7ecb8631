"""Arrays to bytes, and out of bytes that may be damaged.

Nothing is allocated that the bytes do not hold, and nothing is unpickled.
"""

from __future__ import annotations

import io
import math
import re
import zipfile
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.lib import format as npy

_Header = tuple[tuple[int, ...], bool, np.dtype, int]
"""Shape, whether columns come first, type, and where the numbers start."""
_USUAL = re.compile(
    rb"\x93NUMPY\x01\x00..\{'descr': '([<|][biuf][1248])', 'fortran_order': (True|False), "
    rb"'shape': \(((?:\d{1,18}, )*(?:\d{1,18},?)?)\), \} *\n",
    re.DOTALL,
)
MAX_ARCHIVE_BYTES = 400_000_000
"""Bytes of all arrays of an archive, unpacked."""


def npz_bytes(arrays: Mapping[str, np.ndarray], *, compressed: bool = False) -> bytes:
    """The content of a `.npz` file with these arrays by name; `arrays_of` reads it."""
    content, named = io.BytesIO(), dict[str, Any](arrays)
    (np.savez_compressed if compressed else np.savez)(content, **named)
    return content.getvalue()


def array_of(content: bytes) -> np.ndarray:
    """A read-only array over the bytes of a `.npy` file.

    Raises:
        ValueError: the bytes are no such file of numbers or words, or not of the stated size. A damaged header may
            also raise whatever its parser does.
    """
    shape, fortran, dtype, start = _usual_header(content) or _header(content)
    count = math.prod(shape)
    if dtype.hasobject or dtype.kind not in "biufU" or len(content) - start != count * dtype.itemsize:
        raise ValueError("an array has another size than stated")
    flat = np.frombuffer(content, dtype, count=count, offset=start) if count else np.zeros(0, dtype)
    array = flat.reshape(shape, order="F" if fortran else "C")
    array.setflags(write=False)
    return array


def _usual_header(content: bytes) -> _Header | None:
    """The header as `numpy.save` writes it for plain numbers, read without Python's parser; None for any other."""
    match = _USUAL.match(content)
    if match is None or match.end() != 10 + int.from_bytes(content[8:10], "little"):
        return None
    kind, fortran, shape = match.groups()
    return (
        tuple(int(n) for n in shape.split(b",") if n.strip()),
        fortran == b"True",
        np.dtype(kind.decode()),
        match.end(),
    )


def _header(content: bytes) -> _Header:
    stream = io.BytesIO(content)
    version = npy.read_magic(stream)
    read = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
    return *read(stream), stream.tell()


def arrays_of(content: bytes, names: Iterable[str]) -> tuple[np.ndarray, ...]:
    """Arrays of an `.npz` file, by name, read-only.

    Raises:
        ValueError, KeyError, zipfile.BadZipFile: as `array_of`; one is missing; it would unpack to too much.
    """
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        if sum(info.file_size for info in archive.infolist()) > MAX_ARCHIVE_BYTES:
            raise ValueError(f"it would unpack to more than {MAX_ARCHIVE_BYTES / 1e6:.0f} MB")
        return tuple(array_of(entry(archive, f"{name}.npy")) for name in names)


def entry(archive: zipfile.ZipFile, name: str) -> bytes:
    """One entry's bytes, of the stated size and never more.

    Raises:
        ValueError, KeyError, zipfile.BadZipFile: it is absent, damaged or of another size.
    """
    stated = archive.getinfo(name).file_size
    with archive.open(name) as stream:
        content = stream.read(stated)
    if len(content) != stated:
        raise ValueError(f"{name} has another size than stated")
    return content
