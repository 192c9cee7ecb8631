"""Decoding the photo: whatever a person hands in becomes an upright 8-bit RGB picture, or one clear line."""

from __future__ import annotations

import io
import stat
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import UInt8
from PIL import Image, ImageOps, UnidentifiedImageError

from diorama_core.artefacts import Photo
from diorama_core.errors import InputError
from diorama_core.perception.camera.exif import focal_from_exif

MAX_FILE_MB = 200
MAX_MEGAPIXELS = 64
MAX_JPEG_MEGAPIXELS = 120
"""A JPEG is decoded straight to a fraction of its size; others are decoded whole."""
MIN_SIDE_PX = 32
MAX_ASPECT = 8.0
PICTURE_FORMATS = ("JPEG", "PNG", "WEBP", "AVIF", "BMP", "TIFF", "GIF", "PPM", "JPEG2000")
"""What is decoded; formats that start other programs (EPS) or hold no pixels are not."""

_EXIF_DIRECTORY = 0x8769
_AVERAGED = ("RGB", "RGBA", "L", "LA", "CMYK", "YCbCr")
_ASK = "use a JPEG, PNG or WebP picture"


@dataclass(frozen=True)
class Source:
    """A file or an upload: its bytes and what to call it in messages."""

    data: bytes
    name: str


def read_source(given: Path | bytes, what: str, name: str | None = None) -> Source:
    """Bytes of a path or an upload.

    Raises:
        InputError: when the file is missing, unreadable, empty or larger than `MAX_FILE_MB`.
    """
    label = name or (given.name if isinstance(given, Path) else f"the uploaded {what}")
    if isinstance(given, Path):
        _check_size(label, _file_size(given, what))
        try:
            data = given.read_bytes()
        except OSError as error:
            raise InputError(f"{given}: the {what} cannot be read ({error.strerror}); check the path") from error
    else:
        data = bytes(given)
    _check_size(label, len(data))
    return Source(data, label)


def _file_size(path: Path, what: str) -> int:
    if path.is_dir():
        raise InputError(f"{path}: is a folder; give the {what} file itself")
    try:
        about = path.stat()
        if not stat.S_ISREG(about.st_mode):
            raise InputError(f"{path}: is not a file; give the {what} file itself")
        return about.st_size
    except OSError as error:
        raise InputError(f"{path}: the {what} cannot be read ({error.strerror}); check the path") from error


def _check_size(label: str, size: int) -> None:
    if size == 0:
        raise InputError(f"{label}: the file is empty (0 bytes); choose another file")
    if size > MAX_FILE_MB * 1_000_000:
        raise InputError(f"{label}: {size / 1e6:.0f} MB is more than the {MAX_FILE_MB} MB accepted; reduce it first")


def open_picture(source: Source, what: str = "picture", megapixels: float = MAX_MEGAPIXELS) -> Image.Image:
    """Open without decoding, and refuse what would decode to an unreasonable size.

    Raises:
        InputError: when it is no picture, or has more than so many megapixels (`MAX_JPEG_MEGAPIXELS` of a JPEG).
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            picture = Image.open(io.BytesIO(source.data), formats=PICTURE_FORMATS)
    except Image.DecompressionBombError as error:
        raise InputError(f"{source.name}: {_too_many_pixels(None, megapixels)}") from error
    except UnidentifiedImageError as error:
        raise InputError(f"{source.name}: {_what_it_is(source.data)}; {_ASK}") from error
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


def read_photo(source: Source, max_side: int) -> tuple[Photo, tuple[str, ...]]:
    """The upright photo, reduced to `max_side`, and warnings worth showing.

    Raises:
        InputError: when it cannot be used; the message says why.
    """
    picture = open_picture(source)
    raw_size = picture.size
    picture.draft(None, (2 * max_side, 2 * max_side))  # JPEG decodes straight to a fraction of its size
    load_pixels(picture, source)
    exif = _exif(picture)
    upright = _upright(picture) if exif else picture
    turned = (upright.width > upright.height) != (picture.width > picture.height) and raw_size[0] != raw_size[1]
    original = (raw_size[1], raw_size[0]) if turned else raw_size
    _check_shape(source.name, original)
    rgb, notes = _to_rgb(_coarser(upright, max_side), source.name)
    reduced, more = _reduced(rgb, original, max_side)
    focal = focal_from_exif(exif, *original)
    photo = Photo(
        rgb=reduced,
        name=source.name,
        original_size=original,
        exif_focal_px=None if focal is None else focal * max(reduced.shape[:2]) / max(original),
    )
    return photo, (*notes, *more)


def _exif(picture: Image.Image) -> Mapping[int, Any]:
    """The header's tags, the Exif sub-directory included; empty where there is none or it is damaged."""
    try:
        base = picture.getexif()
        return {**dict(base), **dict(base.get_ifd(_EXIF_DIRECTORY))}
    except Exception:  # a damaged header must not cost the picture
        return {}


def _upright(picture: Image.Image) -> Image.Image:
    try:
        return ImageOps.exif_transpose(picture)
    except Exception:  # as above
        return picture


def _coarser(picture: Image.Image, max_side: int) -> Image.Image:
    """A very large picture averaged down to no less than twice what is asked for, before anything copies it."""
    factor = max(picture.size) // (2 * max_side)
    return picture.reduce(factor) if factor > 1 and picture.mode in _AVERAGED else picture


def _check_shape(name: str, size: tuple[int, int]) -> None:
    width, height = size
    if min(size) < MIN_SIDE_PX:
        raise InputError(
            f"{name}: {width} x {height} pixels are too few; at least {MIN_SIDE_PX} on each side are needed"
        )
    if max(size) > MAX_ASPECT * min(size):
        raise InputError(f"{name}: {width} x {height} is a strip, not a photo of a room; crop it to the room")


def _to_rgb(picture: Image.Image, name: str) -> tuple[Image.Image, tuple[str, ...]]:
    """Eight bits and three channels from any mode; transparency is laid on white, as viewers show it."""
    if picture.mode == "F":
        raise InputError(f"{name}: a picture of floating-point numbers is not a photo; save it with 8 bits per channel")
    if picture.mode.startswith("I"):
        values = np.asarray(picture)
        eight = np.empty(values.shape, np.uint8)
        for row in range(0, len(values), 256):  # in strips: the numbers take eight times the room of the result
            eight[row : row + 256] = np.clip(values[row : row + 256].astype(np.int64), 0, 65535) // 257
        return Image.fromarray(eight).convert("RGB"), ()
    if picture.mode in ("RGBA", "LA", "PA", "RGBa", "La") or "transparency" in picture.info:
        rgba = picture.convert("RGBA")
        if rgba.getchannel("A").getextrema()[0] == 255:
            return rgba.convert("RGB"), ()
        white = Image.new("RGBA", rgba.size, (255, 255, 255, 255))
        note = "the photo is partly transparent; it was laid on white"
        return Image.alpha_composite(white, rgba).convert("RGB"), (note,)
    return picture.convert("RGB"), ()


def _reduced(
    rgb: Image.Image, original: tuple[int, int], max_side: int
) -> tuple[UInt8[np.ndarray, "h w 3"], tuple[str, ...]]:
    factor = min(1.0, max_side / max(original))
    size = (max(1, round(original[0] * factor)), max(1, round(original[1] * factor)))
    small = rgb if rgb.size == size else rgb.resize(size, Image.Resampling.LANCZOS)
    array = np.array(small, dtype=np.uint8)
    array.setflags(write=False)
    if factor == 1.0:
        return array, ()
    return array, (f"the photo was reduced from {original[0]} x {original[1]} to {size[0]} x {size[1]} pixels",)


def _too_many_pixels(size: tuple[int, int] | None, most: float) -> str:
    shape = f"{size[0]} x {size[1]} pixels are" if size else "the picture is"
    return f"{shape} more than the {most:g} megapixels accepted; reduce it first"


def _what_it_is(data: bytes) -> str:
    """A guess at what was handed in instead of a picture, in words."""
    head = data[:512].lstrip(b"\xef\xbb\xbf \t\r\n").lower()
    if data[4:8] == b"ftyp" and data[8:12] in (b"heic", b"heix", b"hevc", b"mif1", b"msf1", b"heim"):
        return "this is a HEIC picture, which is not supported"
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
    return "this is not a picture, or one of a kind that is not supported"
