"""Opening and decoding pictures: from untrusted bytes to pixels of full brightness, or one clear line.

Camera raw files are recognised by their tags; the largest picture that the camera put into them is the photo.
"""

from __future__ import annotations

import io
import re
import struct
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import Integer, UInt8
from PIL import Image, UnidentifiedImageError

from diorama_core.errors import InputError
from diorama_core.perception.inputs.source import Source

MAX_MEGAPIXELS = 64
MAX_JPEG_MEGAPIXELS = 120
"""A JPEG is decoded straight to a fraction of its size; others are decoded whole."""
PICTURE_FORMATS = ("JPEG", "PNG", "WEBP", "AVIF", "HEIF", "BMP", "TIFF", "GIF", "PPM", "JPEG2000")
"""What is decoded; formats that start other programs (EPS) or hold no pixels are not."""
_HEIF_BRANDS = (b"heic", b"heix", b"heim", b"heis", b"hevc", b"hevx", b"mif1", b"msf1")
_ASK = "use a JPEG, PNG, HEIC or WebP picture"


def open_picture(source: Source, what: str = "picture", megapixels: float = MAX_MEGAPIXELS) -> Image.Image:
    """Open without decoding, and refuse what would decode to an unreasonable size.

    Raises:
        InputError: when it is no picture, or has more than so many megapixels (`MAX_JPEG_MEGAPIXELS` of a JPEG).
    """
    if is_heif(source.data):
        _register_heif()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            picture = Image.open(io.BytesIO(source.data), formats=_readable_formats())
    except Image.DecompressionBombError as error:
        raise InputError(f"{source.name}: {_too_many_pixels(None, megapixels)}") from error
    except UnidentifiedImageError as error:
        raise InputError(f"{source.name}: {what_it_is(source.data)}; {_ASK}") from error
    except Exception as error:  # decoders of untrusted bytes raise almost anything; each means the same to the user
        raise InputError(f"{source.name}: the {what} is damaged; export or download it again") from error
    most = max(megapixels, MAX_JPEG_MEGAPIXELS) if picture.format == "JPEG" else megapixels
    if picture.width * picture.height > most * 1_000_000:
        raise InputError(f"{source.name}: {_too_many_pixels(picture.size, most)}")
    return picture


def load_pixels(picture: Image.Image, source: Source, what: str = "picture") -> Image.Image:
    """Decode fully.

    Raises:
        InputError: when the bytes end early or are damaged.
    """
    try:
        picture.load()
    except MemoryError as error:
        raise InputError(f"{source.name}: there is not enough memory for this {what}; reduce it first") from error
    except Exception as error:  # as above
        raise InputError(f"{source.name}: the {what} is truncated or damaged; export or download it again") from error
    return picture


def is_heif(data: bytes) -> bool:
    """Whether a file begins as HEIC and HEIF do."""
    return data[4:8] == b"ftyp" and data[8:12] in _HEIF_BRANDS


def what_it_is(data: bytes) -> str:
    """A guess at what was handed in instead of a picture, in words."""
    head = data[:512].lstrip(b"\xef\xbb\xbf \t\r\n").lower()
    if is_heif(data):
        return "the HEIC picture is damaged"
    if head.startswith(b"<svg") or (head.startswith(b"<?xml") and b"<svg" in data[:4096].lower()):
        return "this is an SVG drawing, not a photo"
    if head.startswith(b"%pdf"):
        return "this is a PDF document, not a picture"
    if head.startswith((b"<!doctype", b"<html")):
        return "this is a web page, not a picture"
    if data[:4] == b"\x76\x2f\x31\x01":
        return "this is an EXR file; as a photo it is not supported"
    if data[4:8] == b"ftyp":
        return "this is a video, not a picture"
    if data.startswith(b"8BPS"):
        return "this is a Photoshop document"
    if data.startswith(b"\xff\x0a") or data[4:8] == b"JXL ":
        return "this is a JPEG XL picture, which is not read"
    return "this is not a picture, or one of a kind that is not supported"


def _register_heif() -> None:
    """Teach Pillow HEIC; loaded on first use, since most photos are none."""
    from pillow_heif import register_heif_opener

    register_heif_opener(thumbnails=False)


def _readable_formats() -> tuple[str, ...]:
    Image.init()
    return tuple(name for name in PICTURE_FORMATS if name in Image.OPEN)


def _too_many_pixels(size: tuple[int, int] | None, most: float) -> str:
    shape = f"{size[0]} x {size[1]} pixels are" if size else "the picture is"
    return f"{shape} more than the {most:g} megapixels accepted; reduce it first"


USED_BITS = (8, 10, 12, 14)
"""Bit depths of sensors whose numbers are stored in 16 bits."""
DARK_LEVEL = 64
"""Eight-bit level below which all of a colour picture of 16 bits lies whose numbers have at most 14."""
_STRIP = 256


def eight_bits(values: Integer[np.ndarray, "h w *c"]) -> tuple[UInt8[np.ndarray, "h w *c"], tuple[str, ...]]:
    """Whole numbers of up to 16 bits as 8, by the bits that they use, and a note where those are fewer than 16."""
    most = int(values.max(initial=0))
    bits = next((b for b in USED_BITS if most < 1 << b), 16)
    full = (1 << bits) - 1
    eight = np.empty(values.shape, np.uint8)
    for row in range(0, len(values), _STRIP):  # in strips: the numbers take eight times the room of the result
        strip = np.clip(values[row : row + _STRIP].astype(np.int64), 0, full)
        eight[row : row + _STRIP] = strip // 257 if bits == 16 else (strip * 255 + full // 2) // full
    if bits == 16 or most == 0:
        return eight, ()
    return eight, (f"the photo's numbers use {bits} of 16 bits (up to {most}); they were stretched",)


def dark_colours(picture: Image.Image, source: Source) -> tuple[Image.Image, tuple[str, ...]]:
    """A colour picture of 16 bits read again by the bits that it uses, where the usual 8 of them are nearly black."""
    if picture.mode not in ("RGB", "RGBA") or not _has_16_bits(picture, source.data):
        return picture, ()
    if int(np.asarray(picture.convert("RGB")).max(initial=0)) >= DARK_LEVEL:
        return picture, ()
    import cv2  # the editor opens without it

    values = cv2.imdecode(np.frombuffer(source.data, np.uint8), cv2.IMREAD_UNCHANGED)
    if values is None or values.dtype != np.uint16 or values.ndim != 3:
        return picture, ()
    eight, notes = eight_bits(values[..., 2::-1])
    brighter = Image.fromarray(np.ascontiguousarray(eight))
    if picture.mode == "RGBA":
        brighter.putalpha(picture.getchannel("A"))
    return brighter, notes


def _has_16_bits(picture: Image.Image, data: bytes) -> bool:
    if picture.format == "PNG":
        return data[24:25] == b"\x10"
    tags = getattr(picture, "tag_v2", {})
    return picture.format == "TIFF" and 16 in tuple(tags.get(258, ()))


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
