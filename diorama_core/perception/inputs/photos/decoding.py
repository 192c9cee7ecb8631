"""Opening and decoding pictures: from untrusted bytes to pixels of full brightness, or one clear line."""

from __future__ import annotations

import io
import warnings

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
