"""Masks in one picture, a colour or a number for each object, a palette, a cut-out, or pages, and masks one over
another as one map of numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Int32, Shaped
from PIL import Image

from diorama_core.errors import InputError
from diorama_core.perception.inputs.photos.decoding import load_pixels, open_picture
from diorama_core.perception.inputs.source import Source

MAX_STACKED = 500


@dataclass(frozen=True, eq=False)
class MaskMap:
    """A number for the object at each pixel, 0 for none, and what was understood."""

    values: Int32[np.ndarray, "h w"]
    notes: tuple[str, ...] = ()


def paint_masks(masks: Sequence[Bool[np.ndarray, "_ _"]], name: str, what: str) -> MaskMap:
    """Overlapping masks as one map, smaller ones in front.

    Raises:
        InputError: they have different sizes, or are none or too many.
    """
    if not masks:
        raise InputError(f"{name}: holds no mask; give a PNG with one colour for each object, or one file for each")
    if len(masks) > MAX_STACKED:
        raise InputError(f"{name}: {len(masks)} masks are more than the {MAX_STACKED} accepted; keep the furniture")
    sizes = sorted({m.shape for m in masks})
    if len(sizes) > 1:
        shown = ", ".join(f"{w} x {h}" for h, w in sizes[:3])
        raise InputError(f"{name}: its {what} have different sizes ({shown}); give masks of this very photo")
    areas = [int(np.count_nonzero(m)) for m in masks]
    values = np.zeros(sizes[0], np.int32)
    for number in sorted(range(len(masks)), key=lambda k: -areas[k]):
        values[masks[number]] = number + 1
    overlap = sum(areas) - int(np.count_nonzero(values))
    over = "; where they overlap the smaller one is in front" if overlap > 0 else ""
    return MaskMap(values, (f"{name}: {len(masks)} {what}, one object each{over}",))


MAX_MASK_MEGAPIXELS = 40
MAX_PAGES = 600
EXACT_FORMATS = ("PNG", "TIFF", "BMP", "GIF", "WEBP", "PPM")
VOC_VOID = 224 << 16 | 224 << 8 | 192
"""The colour of Pascal VOC's palette for pixels that belong to nobody."""
SMALL_ID = 128
"""Ids of objects below it leave the type's largest number free to mean nothing."""
DENSE = 3
"""Ids are counted up, not chosen, where there are at least a third of so many as the largest says."""
PHOTO_SHARE, PHOTO_LEVELS = 0.15, 64
"""Share of pixels neither dark nor bright, and number of their levels: smoothed outlines have far fewer."""
THIN_SHARE = 0.012
"""Share of the longer side: half the width up to which a region is an outline."""
LOSSY_FORMATS = ("JPEG", "MPO")
BRIGHT = 100
"""Level of white after a lossy format; a mask darker everywhere is empty, or holds small numbers."""
GREY_OFF = 24
"""Differences of channels that a lossy format makes of grey."""
MAX_BLURRED_SHARE = 0.08
"""Share of pixels between white and black, along outlines of a white mask."""
CUT_OUT_COLOURS = 256
"""Under transparency more colours than these are a photo's."""


def read_picture(source: Source) -> MaskMap:
    """The objects of one picture."""
    picture = open_picture(source, "mask", MAX_MASK_MEGAPIXELS)
    if picture.format in LOSSY_FORMATS:
        mask = white_on_black(load_pixels(picture, source, "mask"))
        if mask is not None and mask.any():
            return MaskMap(mask.astype(np.int32), (f"{source.name} is lossy; it was read as white on black",))
    if picture.format not in EXACT_FORMATS:
        raise InputError(f"{source.name}: masks need exact colours, which {picture.format} blurs; save them as PNG")
    if picture.format == "TIFF" and getattr(picture, "n_frames", 1) > 1:
        return paint_masks(_pages(picture, source), source.name, "pages")
    load_pixels(picture, source, "mask")
    try:
        return _picture_masks(picture, source.name)
    except (ValueError, OSError, TypeError) as error:  # a palette that is not whole
        raise InputError(f"{source.name}: the masks are damaged; save them again as PNG") from error


def one_object(source: Source) -> Bool[np.ndarray, "h w"] | None:
    """The object of a picture that shows only one: white on black, or cut out of the photo by transparency.

    None where it has the colours of a photo.

    Raises:
        InputError: it is no such picture.
    """
    picture = load_pixels(open_picture(source, "mask", MAX_MASK_MEGAPIXELS), source, "mask")
    if picture.format in LOSSY_FORMATS:
        return white_on_black(picture)
    if picture.mode in ("RGBA", "LA", "PA") or "transparency" in picture.info:
        alpha = np.asarray(picture.convert("RGBA").getchannel("A"))
        if alpha.min() < 128:
            return np.asarray(alpha >= 128)
    grey = np.asarray(picture.convert("L") if picture.mode in ("1", "P", "RGB", "RGBA", "LA", "PA") else picture)
    most = grey.max()
    between = (grey > 0.15 * most) & (grey < 0.85 * most)
    if most > 1 and float(between.mean()) > PHOTO_SHARE and len(np.unique(grey)) > PHOTO_LEVELS:
        return None
    return np.asarray(grey > (most / 2 if most > 1 else 0))


def white_on_black(picture: Image.Image) -> Bool[np.ndarray, "h w"] | None:
    """The white of a lossy picture of black and white; all False where it is dark; None where it has other tones."""
    pixels = np.asarray(picture.convert("RGB")).astype(np.int16)
    grey = pixels[..., 1]
    blurred = (grey > 0.15 * 255) & (grey < 0.85 * 255)
    if np.ptp(pixels, axis=2).max() > 2 * GREY_OFF or (np.ptp(pixels, axis=2) > GREY_OFF).mean() > MAX_BLURRED_SHARE:
        return None
    if grey.max() < BRIGHT:
        return np.zeros(grey.shape, bool) if grey.max() < GREY_OFF else None
    return np.asarray(grey >= 128) if blurred.mean() <= MAX_BLURRED_SHARE else None


def _picture_masks(picture: Image.Image, name: str) -> MaskMap:
    if picture.mode == "P" and "transparency" not in picture.info:
        return _palette(picture)
    if picture.mode in ("RGBA", "LA", "PA", "P"):
        rgba = np.array(picture.convert("RGBA"))
        hidden = rgba[..., 3] < 128
        if hidden.any() and len(np.unique(_numbers(rgba[..., :3])[~hidden])) > CUT_OUT_COLOURS:
            note = f"{name} is one object cut out of the photo; its transparency is the mask"
            return MaskMap((~hidden).astype(np.int32), (note,))
        rgba[hidden] = 0
        return MaskMap(_numbers(rgba[..., :3]))
    pixels = np.asarray(picture.convert("L") if picture.mode == "1" else picture)
    if pixels.ndim == 3:
        return MaskMap(_numbers(pixels))
    return without_void(pixels.astype(np.int32), int(np.iinfo(pixels.dtype).max) if pixels.dtype.kind in "iu" else 255)


def _palette(picture: Image.Image) -> MaskMap:
    """A palette's colours decide, unless two of its numbers look alike or none of them is black."""
    indices = np.asarray(picture).astype(np.int32)
    colours = _numbers(np.asarray(picture.convert("RGB")))
    used = np.unique(indices)
    shown = [int(colours.flat[int(np.argmax(indices == k))]) for k in used]
    if len(set(shown)) < len(shown):
        return without_void(indices, 255)
    if 255 in used and VOC_VOID in shown:
        hit = colours == VOC_VOID
        return MaskMap(np.where(hit, 0, colours), _void_note(255, hit))
    ids = without_void(indices, 255)
    if ids.notes:  # 255 along the outlines of small ids, whatever its colour
        return MaskMap(np.where(ids.values == 0, 0, colours) if 0 in shown else ids.values, ids.notes)
    return MaskMap(colours if 0 in shown else indices)


def without_void(ids: Int32[np.ndarray, "h w"], most: int) -> MaskMap:
    """Ids without the largest number of the file's type, `most`, where that marks pixels that belong to nobody."""
    void = ids == most
    others = np.unique(ids[~void & (ids != 0)])
    if not void.any() or not len(others) or others.max() >= SMALL_ID:
        return MaskMap(ids)
    if DENSE * len(others) < others.max() and not _is_thin(void):
        return MaskMap(ids)
    return MaskMap(np.where(void, 0, ids), _void_note(most, void))


def _is_thin(region: Bool[np.ndarray, "h w"]) -> bool:
    import cv2  # the editor opens without it

    inside = cv2.distanceTransform(region.astype(np.uint8), cv2.DIST_L2, 3)
    return float(np.percentile(inside[region], 95)) <= max(3.0, THIN_SHARE * max(region.shape))


def _void_note(number: int, void: Bool[np.ndarray, "h w"]) -> tuple[str, ...]:
    return (f"the number {number} of the masks ({void.mean():.0%}) means that pixels belong to nobody",)


def _numbers(rgb: Shaped[np.ndarray, "h w c"]) -> Int32[np.ndarray, "h w"]:
    """One number per colour, 0 for black."""
    numbers = rgb[..., 0].astype(np.int32)
    for channel in (1, 2):  # in place: a large picture's numbers take hundreds of megabytes
        numbers <<= 8
        numbers |= rgb[..., channel]
    return numbers


def _pages(picture: Image.Image, source: Source) -> list[Bool[np.ndarray, "h w"]]:
    pages = []
    try:
        for page in range(min(int(getattr(picture, "n_frames", 1)), MAX_PAGES)):
            picture.seek(page)
            pages.append(np.asarray(picture.convert("L")) > 0)
    except Exception as error:  # a damaged page raises almost anything
        raise InputError(f"{source.name}: one of its pages is damaged; save the masks again") from error
    return pages
