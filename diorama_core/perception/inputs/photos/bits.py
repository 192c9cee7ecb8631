"""Brightness of pictures whose numbers use fewer bits than their files have."""

from __future__ import annotations

import numpy as np
from jaxtyping import Integer, UInt8
from PIL import Image

from diorama_core.perception.inputs.source import Source

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
