"""Camera raw files: recognised by their tags; the largest picture that the camera put into them is the photo."""

from __future__ import annotations

import io
import re
import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from PIL import Image

from diorama_core.errors import InputError
from diorama_core.perception.inputs.source import Source

_MAGIC = {
    b"FUJIFILMCCD-RAW": "Fujifilm RAF",
    b"IIU\0": "Panasonic RW2",
    b"IIRO": "Olympus ORF",
    b"IIRS": "Olympus ORF",
    b"MMOR": "Olympus ORF",
    b"FOVb": "Sigma X3F",
}
_MAKERS = {
    "nikon": "Nikon NEF",
    "sony": "Sony ARW",
    "pentax": "Pentax PEF",
    "ricoh": "Pentax PEF",
    "samsung": "Samsung SRW",
}
_DNG_VERSION, _MAKE, _SUB_IFDS, _SUBFILE_TYPE, _PHOTOMETRIC, _ORIENTATION = 50706, 271, 330, 254, 262, 274
_SENSOR_MOSAIC, _LINEAR_RAW = 32803, 34892
MAX_DIRECTORIES = 40
MAX_EMBEDDED = 60
"""Places at which a JPEG seems to begin that are tried."""
SMALL_SIDE_PX = 1000
"""A largest picture below this is a thumbnail: the sensor's own data are developed where `rawpy` is installed."""
MAX_RAW_PIXELS = 120_000_000


def raw_kind(data: bytes) -> str | None:
    """Which camera raw format a file is of, or None."""
    for magic, name in _MAGIC.items():
        if data.startswith(magic):
            return name
    if data[4:12] == b"ftypcrx ":
        return "Canon CR3"
    if data[:4] not in (b"II*\0", b"MM\0*"):
        return None
    if data[8:10] == b"CR":
        return "Canon CR2"
    directories = list(_directories(data))
    if not directories:
        return None
    _, first = directories[0]
    if _DNG_VERSION in first:
        return "DNG"
    mosaic = any(d.get(_PHOTOMETRIC) in ((_SENSOR_MOSAIC,), (_LINEAR_RAW,)) for _, d in directories)
    reduced = first.get(_SUBFILE_TYPE) == (1,) and _SUB_IFDS in first
    if not (mosaic or reduced):
        return None
    maker = bytes(first.get(_MAKE, ())).decode("latin-1").lower()
    return next((name for word, name in _MAKERS.items() if word in maker), "camera raw")


@dataclass(frozen=True)
class PhotoFile:
    """The picture of a file, as a file of its own."""

    source: Source
    orientation: int | None = None
    """EXIF orientation of the file around it; None where the picture's own counts."""
    notes: tuple[str, ...] = ()


def largest_picture(source: Source) -> PhotoFile:
    """The largest picture in a raw file.

    Raises:
        InputError: when it holds none that can be read.
    """
    kind = raw_kind(source.data)
    largest = max(_pictures(source.data), key=lambda p: p[0][0] * p[0][1], default=None)
    if largest is None or max(largest[0]) < SMALL_SIDE_PX:
        developed = _develop(source)
        if developed is not None:
            return PhotoFile(developed, 1, (f"{source.name} is a camera's raw file ({kind}); it was developed",))
    if largest is None:
        raise InputError(
            f"{source.name}: this is a camera's raw file ({kind}) without a readable picture; "
            "export it as JPEG, or install rawpy"
        )
    (width, height), content = largest
    note = f"{source.name} is a camera's raw file ({kind}); its largest picture ({width} x {height}) is used"
    orientation = next((d.get(_ORIENTATION, (1,))[0] for _, d in _directories(source.data)), 1)
    return PhotoFile(replace(source, data=content), int(orientation), (note,))


def _pictures(data: bytes) -> Iterator[tuple[tuple[int, int], bytes]]:
    """Size and content of every picture in the file that Pillow can open."""
    tiff = data[:2] + (struct.pack("<H", 42) if data[:2] == b"II" else struct.pack(">H", 42))
    for offset, tags in _directories(data):
        if tags.get(_PHOTOMETRIC, (2,))[0] in (_SENSOR_MOSAIC, _LINEAR_RAW):
            continue
        packed = struct.pack("<I" if data[:2] == b"II" else ">I", offset)
        content = tiff + packed + data[8:]
        size = _readable_size(content, "TIFF")
        if size is not None:
            yield size, content
    for count, match in enumerate(re.finditer(rb"\xff\xd8\xff[\xc0-\xfe]", data)):
        if count >= MAX_EMBEDDED:
            return
        content = data[match.start() :]
        size = _readable_size(content, "JPEG")
        if size is not None:
            yield size, content


def _readable_size(content: bytes, kind: str) -> tuple[int, int] | None:
    """Width and height of a picture in three colours that can be decoded; None otherwise."""
    try:
        with Image.open(io.BytesIO(content), formats=(kind,)) as picture:
            if picture.mode not in ("RGB", "YCbCr", "L") or picture.width * picture.height > MAX_RAW_PIXELS:
                return None
            picture.draft("RGB", (64, 64))
            picture.load()
            return Image.open(io.BytesIO(content), formats=(kind,)).size
    except Exception:  # decoders of untrusted bytes raise almost anything; such a picture is not the one
        return None


def _develop(source: Source) -> Source | None:
    """The sensor's data as a picture; None where rawpy is not installed or does not read them."""
    try:
        import rawpy
    except ImportError:
        return None
    try:
        with rawpy.imread(io.BytesIO(source.data)) as raw:
            rgb = np.asarray(raw.postprocess(use_camera_wb=True, half_size=True))
    except Exception:  # of untrusted bytes, as above
        return None
    stream = io.BytesIO()
    Image.fromarray(rgb).save(stream, "PPM")
    return replace(source, data=stream.getvalue())


def _directories(data: bytes) -> Iterator[tuple[int, Mapping[int, Any]]]:
    """Offset and tags (short values only) of every directory of a TIFF, those within others included."""
    if data[:2] not in (b"II", b"MM") or len(data) < 8:
        return
    order = "<" if data[:2] == b"II" else ">"
    waiting, seen = [struct.unpack(order + "I", data[4:8])[0]], set[int]()
    while waiting and len(seen) < MAX_DIRECTORIES:
        offset = waiting.pop(0)
        if offset in seen or not 0 < offset <= len(data) - 2:
            continue
        seen.add(offset)
        count = struct.unpack_from(order + "H", data, offset)[0]
        end = offset + 2 + 12 * count
        if end + 4 > len(data):
            continue
        tags = {}
        for at in range(offset + 2, end, 12):
            tag, kind, number = struct.unpack_from(order + "HHI", data, at)
            tags[tag] = _values(data, at + 8, order, kind, number)
        yield offset, tags
        waiting += [int(v) for v in tags.get(_SUB_IFDS, ())]
        waiting.append(struct.unpack_from(order + "I", data, end)[0])


def _values(data: bytes, at: int, order: str, kind: int, number: int) -> tuple[int, ...]:
    """The whole numbers of a tag; none where they are of another kind, or many."""
    letter = {1: "B", 2: "B", 3: "H", 4: "I", 13: "I"}.get(kind)
    if letter is None or number > 256:
        return ()
    form = f"{order}{number}{letter}"
    size = struct.calcsize(form)
    if size > 4:
        at = struct.unpack_from(order + "I", data, at)[0]
    return struct.unpack_from(form, data, at) if 0 <= at <= len(data) - size else ()
