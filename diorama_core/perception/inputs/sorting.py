"""Which sort of input a file is: a photo, boxes, masks or depth of the photo that is open."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from PIL import Image

from diorama_core.errors import InputError
from diorama_core.perception.inputs.boxes.reading import BOX_FORMS, parse_box_text
from diorama_core.perception.inputs.depth.channels import depth_of_colours
from diorama_core.perception.inputs.depth.confidence import is_confidence
from diorama_core.perception.inputs.depth.containers import DEPTH_FORMS
from diorama_core.perception.inputs.depth.numpy_files import DepthContent
from diorama_core.perception.inputs.masks.pictures import white_on_black
from diorama_core.perception.inputs.photos.decoding import load_pixels, open_picture, raw_kind, what_it_is
from diorama_core.perception.inputs.photos.frame import ASPECT_TOLERANCE
from diorama_core.perception.inputs.source import Source, form_of

Sort = Literal["photo", "boxes", "masks", "depth", "confidence"]
FEW_COLOURS = 80
"""Colours among sampled pixels, without smoothing: masks of the fullest scenes have no more, photos thousands."""
_SAMPLED_PX = 256
_TEXT_STARTS = (b"[", b"{", b"<")


@dataclass(frozen=True)
class Recognised:
    """What a file may be."""

    sort: Sort
    words: str
    """For people, as in "COCO data set"."""


def recognise(content: bytes, name: str, photo_size: tuple[int, int] | None) -> tuple[Recognised, ...]:
    """What a file may be, likeliest first; several where its content leaves that open.

    `photo_size` is that of the photo that is open, where there is one.

    Raises:
        InputError: nothing that is read.
    """
    source = Source(content, name)
    if is_confidence(name):
        return (Recognised("confidence", "confidence of depth"),)
    if content.startswith((b"\x93NUMPY", b"PK\x03\x04")):
        return _recognise_array(source, photo_size)
    if raw_kind(content) is not None:
        return (Recognised("photo", "a camera's raw photo"),)
    picture = _picture(source)
    if picture is not None:
        return _recognise_picture(picture, source, photo_size)
    form = form_of(DEPTH_FORMS, DepthContent(source, photo_size or (4, 3)))
    if form is not None and not content.lstrip()[:1].startswith(_TEXT_STARTS):
        return (Recognised("depth", form.name),)
    return _recognise_text(source)


def recognise_alone(content: bytes, name: str) -> tuple[Recognised, ...]:
    """What a file may be by itself: a picture may be depth or masks of any photo.

    Raises:
        InputError: nothing that is read.
    """
    picture = _picture(Source(content, name))
    return recognise(content, name, None if picture is None else picture.size)


def _recognise_array(source: Source, photo_size: tuple[int, int] | None) -> tuple[Recognised, ...]:
    data = source.data
    if data.startswith(b"PK") and b".npy" not in data[:300]:
        return (Recognised("masks", "a zip archive of masks"),)
    header = data[:200]
    whole = any(kind in header for kind in (b"'|b1'", b"'|u1'", b"'|i1'", b"'<i4'", b"'<i8'"))
    named = next((word for word in (b"mask", b"instance", b"segment") if word in header.lower()), None)
    likely = [Recognised("depth", "an array of depth"), Recognised("masks", "an array of masks")]
    if named is not None or b"'|b1'" in header:
        return (likely[1],)
    return (likely[1], likely[0]) if whole else (likely[0],)


def _recognise_picture(
    picture: Image.Image, source: Source, photo_size: tuple[int, int] | None
) -> tuple[Recognised, ...]:
    photo = Recognised("photo", f"a photo ({picture.width} x {picture.height})")
    if photo_size is not None and picture.format == "JPEG":
        return (Recognised("masks", "one object, white on black"), photo) if _is_mask(picture, source) else (photo,)
    if photo_size is None or picture.format in ("JPEG", "MPO", "HEIF", "AVIF"):
        return (photo,)
    if picture.mode == "F" or picture.mode.startswith("I"):
        return (Recognised("depth", "a depth map"), Recognised("photo", "a grey photo of more than 8 bits"))
    ratio = (picture.width / picture.height) / (photo_size[0] / photo_size[1])
    if abs(ratio - 1.0) > ASPECT_TOLERANCE:
        return (photo,)
    step = max(1, max(picture.size) // _SAMPLED_PX)
    pixels = np.asarray(picture.convert("RGBA"))[::step, ::step].reshape(-1, 4)
    if len(np.unique(pixels, axis=0)) <= FEW_COLOURS:
        return (Recognised("masks", "a picture of masks"),)
    if pixels[:, 3].min() < 128:
        return Recognised("masks", "one object cut out of the photo"), photo
    grey = bool((pixels[:, :3] == pixels[:, :1]).all())
    if picture.mode == "RGB" and picture.format == "PNG" and depth_of_colours(np.asarray(picture)) is not None:
        packed = Recognised("depth", "a depth map packed in colours")
        return (photo, packed) if grey else (packed, photo)
    return (photo, Recognised("depth", "a depth map of 8 bits")) if grey else (photo,)


def _is_mask(picture: Image.Image, source: Source) -> bool:
    """Whether a JPEG is of black and white, by a look at it reduced."""
    picture.draft("RGB", (2 * _SAMPLED_PX, 2 * _SAMPLED_PX))
    try:
        mask = white_on_black(load_pixels(picture, source))
    except InputError:
        return False
    return mask is not None and bool(mask.any())


def _recognise_text(source: Source) -> tuple[Recognised, ...]:
    try:
        form = form_of(BOX_FORMS, parse_box_text(source, source.name, (0, 0)))
    except InputError as error:
        what = what_it_is(source.data)
        raise InputError(f"{source.name}: {what}" if source.data[:1] not in _TEXT_STARTS else str(error)) from error
    runs = b'"counts"' in source.data or b'"segmentation"' in source.data
    masks = (Recognised("masks", "segments in JSON"),) if runs else ()
    if form is None and not masks:
        raise InputError(f"{source.name}: {what_it_is(source.data)}, and no boxes, masks or depth of a photo")
    boxes = (Recognised("boxes", f"boxes ({form.name})"),) if form is not None else ()
    return boxes + masks


def _picture(source: Source) -> Image.Image | None:
    """The picture, opened but not decoded; None where it is none."""
    try:
        return open_picture(source)
    except InputError:
        return None
