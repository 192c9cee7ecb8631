"""Whatever a person hands in as a photo becomes an upright 8-bit RGB picture without a border, or one clear line."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from jaxtyping import UInt8
from PIL import Image

from diorama_core.artefacts import Photo
from diorama_core.errors import InputError, SphericalPhotoError
from diorama_core.perception.camera.exif import focal_from_exif
from diorama_core.perception.inputs.photos.decoding import (
    PhotoFile,
    dark_colours,
    eight_bits,
    is_heif,
    largest_picture,
    load_pixels,
    open_picture,
    raw_kind,
)
from diorama_core.perception.inputs.photos.frame import PhotoFrame, plain_borders
from diorama_core.perception.inputs.source import Form, Source, form_of

MIN_SIDE_PX = 32
MAX_ASPECT = 8.0
BLACK_LEVEL = 12
"""Level, of 255: a photo whose brightest hundredth is darker shows nothing."""
_EXIF_DIRECTORY = 0x8769
_ORIENTATION = 0x0112
_AVERAGED = ("RGB", "RGBA", "L", "LA", "CMYK", "YCbCr")
SWEEP_ASPECT = 2.2
"""Longer than any single shot of a camera: phones crop to 16:9 (1.78), films to 2.4 with borders cut."""
CERTAIN_ASPECT = 3.0
"""From here on a picture is a panorama whoever made it."""
_SPHERE_ASPECT = (1.97, 2.03)
_CUSTOM_RENDERED, _PANORAMA = 0xA401, 6
_PROJECTION = re.compile(rb"ProjectionType[\s\"'=>]+([A-Za-z]+)")
SEAM_SHARE = 0.5
"""Largest difference of the first and last column of a panorama, as a share of that of unrelated columns."""
POLE_SHARE = 0.3
"""Largest difference of neighbouring pixels in the first and last row, which show the poles, as a share of that in the
middle rows. With both, 65 of 66 rendered spheres are recognised, and none of 176 pieces of 22 photos."""


@dataclass(frozen=True, eq=False)
class DecodedPhoto:
    """The photo, where its pixels are in the file, and what to tell the user."""

    photo: Photo
    frame: PhotoFrame
    notes: tuple[str, ...] = ()


def read_photo(source: Source, max_side: int, *, sphere: bool = False, flat: bool = False) -> DecodedPhoto:
    """The upright photo, reduced to `max_side`.

    Args:
        source: its file.
        max_side: pixels of the longer side, at most.
        sphere: whether it is to be a 360 degree photo, whose borders are no frame.
        flat: whether it shows one direction although it looks like a panorama.

    Raises:
        InputError: when it cannot be used; the message says why.
    """
    form = form_of(PHOTO_FORMS, source)
    assert form is not None  # the last form takes any file
    file = form.read(source)
    source, orientation, notes = file.source, file.orientation, file.notes
    picture, more = _largest_page(open_picture(source), source)
    raw_size = picture.size
    picture.draft(None, (2 * max_side, 2 * max_side))  # JPEG decodes straight to a fraction of its size
    load_pixels(picture, source)
    exif = _exif(picture)
    orientation = _orientation(exif) if orientation is None or _ORIENTATION in exif else orientation
    upright = _upright(picture, orientation)
    original = (raw_size[1], raw_size[0]) if orientation >= 5 else raw_size
    _check_shape(source.name, original)
    focal = focal_from_exif(exif, *original)
    notes += more
    if sphere:
        check_sphere(source.name, upright)
    elif not flat:
        notes += check_perspective(source.name, upright, exif, has_focal=focal is not None)
    brighter, more = dark_colours(upright, source)
    rgb, bits = _to_rgb(_coarser(brighter, max_side), source.name)
    reduced, smaller = _downscale(rgb, original, max_side)
    frame = PhotoFrame(original, (0, 0, 0, 0), orientation)
    cut: tuple[str, ...] = ()
    if not sphere:
        reduced, frame, cut = _without_border(reduced, frame)
    if any(frame.margins):
        focal = focal_from_exif(exif, *frame.inner_size)
    photo = Photo(
        rgb=reduced,
        name=source.name,
        original_size=frame.inner_size,
        exif_focal_px=None if focal is None else focal * max(reduced.shape[:2]) / max(frame.inner_size),
        offset=frame.margins[:2] if any(frame.margins) else None,
        equirectangular=sphere or None,
    )
    return DecodedPhoto(photo, frame, (*notes, *more, *bits, *smaller, *cut, *_darkness(reduced)))


def half_turned(decoded: DecodedPhoto) -> DecodedPhoto:
    """The photo turned by 180 degrees, as all that is laid over it will be."""
    rgb = np.ascontiguousarray(decoded.photo.rgb[::-1, ::-1])
    rgb.setflags(write=False)
    return replace(
        decoded,
        photo=replace(decoded.photo, rgb=rgb, half_turned=True),
        frame=replace(decoded.frame, half_turned=True),
    )


def _largest_page(picture: Image.Image, source: Source) -> tuple[Image.Image, tuple[str, ...]]:
    """Select the largest picture of a TIFF file, the first of equals; other formats hold frames of a film."""
    count = int(getattr(picture, "n_frames", 1) or 1) if picture.format in ("TIFF", "GIF", "WEBP", "PNG") else 1
    if count < 2:
        return picture, ()
    if picture.format != "TIFF":
        return picture, (f"the file holds {count} pictures; the first is used",)
    try:
        sizes = []
        for page in range(min(count, 64)):
            picture.seek(page)
            sizes.append(picture.width * picture.height)
        largest = int(np.argmax(sizes))
        picture = open_picture(source)
        picture.seek(largest)
    except Exception as error:  # a damaged page raises almost anything
        raise InputError(f"{source.name}: one of its {count} pictures is damaged; save the photo alone") from error
    return picture, (
        f"the file holds {count} pictures; number {largest + 1}, {picture.width} x {picture.height}, is used",
    )


def _exif(picture: Image.Image) -> Mapping[int, Any]:
    """The header's tags, the Exif sub-directory included; empty where there is none or it is damaged."""
    try:
        base = picture.getexif()
        return {**dict(base), **dict(base.get_ifd(_EXIF_DIRECTORY))}
    except Exception:  # a damaged header must not cost the picture
        return {}


def _orientation(exif: Mapping[int, Any]) -> int:
    value = exif.get(_ORIENTATION)
    return value if isinstance(value, int) and 1 <= value <= 8 else 1


_TRANSPOSED = {
    2: Image.Transpose.FLIP_LEFT_RIGHT,
    3: Image.Transpose.ROTATE_180,
    4: Image.Transpose.FLIP_TOP_BOTTOM,
    5: Image.Transpose.TRANSPOSE,
    6: Image.Transpose.ROTATE_270,
    7: Image.Transpose.TRANSVERSE,
    8: Image.Transpose.ROTATE_90,
}


def _upright(picture: Image.Image, orientation: int) -> Image.Image:
    return picture.transpose(_TRANSPOSED[orientation]) if orientation in _TRANSPOSED else picture


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
        eight, notes = eight_bits(np.asarray(picture))
        return Image.fromarray(eight).convert("RGB"), notes
    if picture.mode in ("RGBA", "LA", "PA", "RGBa", "La") or "transparency" in picture.info:
        rgba = picture.convert("RGBA")
        if rgba.getchannel("A").getextrema()[0] == 255:
            return rgba.convert("RGB"), ()
        white = Image.new("RGBA", rgba.size, (255, 255, 255, 255))
        note = "the photo is partly transparent; it was laid on white"
        return Image.alpha_composite(white, rgba).convert("RGB"), (note,)
    return picture.convert("RGB"), ()


def _downscale(
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


def _without_border(
    rgb: UInt8[np.ndarray, "h w 3"], frame: PhotoFrame
) -> tuple[UInt8[np.ndarray, "h2 w2 3"], PhotoFrame, tuple[str, ...]]:
    """The photo without a plain border, and the note that it was cut off."""
    margins = plain_borders(rgb)
    if margins is None:
        return rgb, frame, ()
    left, top, right, bottom = margins
    height, width = rgb.shape[:2]
    if min(width - left - right, height - top - bottom) < MIN_SIDE_PX:
        return rgb, frame, ()
    inner = np.ascontiguousarray(rgb[top : height - bottom, left : width - right])
    inner.setflags(write=False)
    scale = frame.full_size[0] / width
    left, top, right, bottom = (round(m * scale) for m in margins)
    cut = PhotoFrame(frame.full_size, (left, top, right, bottom), frame.orientation)
    words = f"left {left}, top {top}, right {right}, bottom {bottom} pixels"
    return inner, cut, (f"a plain border around the photo was cut off ({words})",)


def _darkness(rgb: UInt8[np.ndarray, "h w 3"]) -> tuple[str, ...]:
    coarse = rgb[::4, ::4]
    if float(np.percentile(coarse, 99)) >= BLACK_LEVEL:
        return ()
    return ("the photo is nearly black; little can be seen in it",)


PHOTO_FORMS: tuple[Form[Source, PhotoFile], ...] = (
    Form(
        "camera raw (DNG, CR2, CR3, NEF, ARW, RAF, RW2, ORF)",
        "cameras, phones",
        "the largest picture within; developed where that is a thumbnail and `rawpy` is installed (`diorama[raw]`)",
        lambda source: raw_kind(source.data) is not None,
        largest_picture,
    ),
    Form("HEIC, HEIF", "iPhones, Samsung", "the main picture, upright", lambda source: is_heif(source.data), PhotoFile),
    Form(
        "JPEG, PNG, WebP, AVIF, TIFF, BMP, GIF, PPM, JPEG 2000",
        "everything else",
        "turned by its EXIF; 10, 12 and 14 bits stretched; plain borders cut off; of several pages the largest; "
        "a 360 degree photo alone is [a whole room](many-photos.md#one-360-degree-photo); sweep panoramas are refused",
        lambda _: True,
        PhotoFile,
    ),
)


def check_perspective(name: str, picture: Image.Image, exif: Mapping[int, Any], *, has_focal: bool) -> tuple[str, ...]:
    """A note where the picture may be a panorama.

    Args:
        name: of the file.
        picture: upright, decoded.
        exif: the header's tags.
        has_focal: whether the header states the focal length of a single shot.

    Raises:
        SphericalPhotoError: it shows all directions.
        InputError: it is another panorama.
    """
    projection = _read_projection(picture)
    aspect = max(picture.size) / min(picture.size)
    crop = "crop it to one direction, without its bent lines"
    if projection == "equirectangular" or (projection is None and _is_sphere(picture)):
        raise SphericalPhotoError(
            f"{name}: this is a 360 degree photo (equirectangular), not a perspective one; upload it "
            f"alone in the editor, give it to 'diorama build' (--flat if it is none), or {crop}"
        )
    if projection not in (None, "perspective", "rectilinear") or exif.get(_CUSTOM_RENDERED) == _PANORAMA:
        raise InputError(
            f"{name}: this is a panorama ({projection or 'by its header'}), not a perspective photo; {crop}"
        )
    if aspect > CERTAIN_ASPECT or (aspect > SWEEP_ASPECT and has_focal):
        raise InputError(f"{name}: {aspect:.1f} : 1 is a sweep panorama, not a perspective photo; {crop}")
    if aspect > SWEEP_ASPECT:
        return (f"{aspect:.1f} : 1 is the shape of a panorama; if it is one, {crop}",)
    return ()


def check_sphere(name: str, picture: Image.Image) -> None:
    """Raise `InputError` where an upright picture is not all of a sphere."""
    if not _SPHERE_ASPECT[0] <= picture.width / picture.height <= _SPHERE_ASPECT[1]:
        size = f"{picture.width} x {picture.height}"
        raise InputError(f"{name}: {size} is not 2 : 1, so it is no whole 360 degree photo; stitch all directions")
    if _read_projection(picture) != "equirectangular" and not _is_sphere(picture):
        raise InputError(f"{name}: its left and right sides do not meet, so it is no 360 degree photo")


def _read_projection(picture: Image.Image) -> str | None:
    """The projection that the header names (GPano), in lower case."""
    xmp = picture.info.get("xmp", b"")
    match = _PROJECTION.search(xmp.encode() if isinstance(xmp, str) else bytes(xmp))
    return match.group(1).decode().lower() if match else None


def _is_sphere(picture: Image.Image) -> bool:
    """Whether a picture of 2:1 closes around the viewer, with poles above and below."""
    if not _SPHERE_ASPECT[0] <= picture.width / picture.height <= _SPHERE_ASPECT[1]:
        return False
    small = np.asarray(picture.convert("L").resize((256, 128), Image.Resampling.BOX), np.float64)
    apart = np.abs(small - np.roll(small, 64, axis=1)).mean()
    seam = np.abs(small[:, 0] - small[:, -1]).mean()
    across = np.abs(np.diff(small, axis=1)).mean(axis=1)
    poles = max(across[0], across[-1])
    return bool(apart > 2.0 and seam < SEAM_SHARE * apart and poles < POLE_SHARE * across[32:96].mean())
