"""Masks in XML: polygons and run lengths of CVAT."""

from __future__ import annotations

from xml.etree.ElementTree import Element

import numpy as np
from jaxtyping import Bool

from diorama_core.errors import InputError
from diorama_core.perception.inputs.boxes.entry import Size
from diorama_core.perception.inputs.boxes.markup import image_of, is_cvat
from diorama_core.perception.inputs.boxes.table import parsed
from diorama_core.perception.inputs.masks.pictures import MAX_MASK_MEGAPIXELS
from diorama_core.perception.inputs.masks.segments import MAX_TOTAL_MEGAPIXELS, filled_polygon
from diorama_core.perception.inputs.masks.stack import MaskMap, painted
from diorama_core.perception.inputs.source import Source


def is_markup(source: Source) -> bool:
    """Whether it is XML."""
    return source.data.lstrip(b"\xef\xbb\xbf \r\n\t")[:1] == b"<"


def read_cvat_masks(source: Source, photo_name: str, photo_size: Size) -> MaskMap:
    """The polygons and masks of the photo in CVAT's XML.

    Raises:
        InputError: it is another XML, of other pictures only, without masks, or damaged.
    """
    text = parsed(source, photo_name, photo_size)
    image = image_of(text.document.findall("image"), text) if isinstance(text.document, Element) else None
    if not is_cvat(text) or image is None:
        raise InputError(f"{source.name}: this XML holds no masks; give CVAT's, JSON with polygons, or pictures")
    try:
        size = int(image.get("width") or photo_size[0]), int(image.get("height") or photo_size[1])
        if not 0 < size[0] * size[1] <= MAX_MASK_MEGAPIXELS * 1_000_000:
            raise ValueError(size)
        figures = [f for f in image if f.tag in ("polygon", "mask")]
        if len(figures) * size[0] * size[1] > MAX_TOTAL_MEGAPIXELS * 1_000_000:
            raise InputError(f"{source.name}: its masks have too many pixels together; reduce them first")
        masks = [_mask(figure, size, source.name) for figure in figures]
    except (ValueError, OverflowError) as error:
        raise InputError(f"{source.name}: a mask of this CVAT file is damaged; export it again") from error
    return painted([m for m in masks if m.any()], source.name, "segments")


def _mask(figure: Element, size: Size, name: str) -> Bool[np.ndarray, "h w"]:
    if figure.tag == "polygon":
        pairs = [[float(v) for v in pair.split(",")] for pair in (figure.get("points") or "").split(";")]
        return filled_polygon([pairs], size, name)
    left, top, width, height = (int(figure.get(key) or 0) for key in ("left", "top", "width", "height"))
    runs = [int(v) for v in (figure.get("rle") or "").split(",")]
    inside = min(left, top) >= 0 and left + width <= size[0] and top + height <= size[1]
    if not inside or min(runs) < 0 or sum(runs) != width * height:
        raise ValueError(runs)
    mask = np.zeros(size[::-1], bool)
    part = np.repeat(np.arange(len(runs)) % 2 == 1, runs).reshape(height, width)
    mask[top : top + height, left : left + width] = part
    return mask
