"""Readers of photos and what comes with them, for the decoding process: it loads no more than they need."""

from __future__ import annotations

import io
from functools import cache

from PIL import Image

from diorama_core.perception.inputs import read_inputs


@cache
def _photo() -> bytes:
    buffer = io.BytesIO()
    Image.new("RGB", (96, 64), (90, 120, 200)).save(buffer, "PNG")
    return buffer.getvalue()


def as_photo(data: bytes) -> object:
    return read_inputs(data, name="photo.jpg")


def with_depth(data: bytes) -> object:
    return read_inputs(_photo(), name="p.png", depth=data)


def with_boxes(data: bytes) -> object:
    return read_inputs(_photo(), name="p.png", boxes=data)


def with_masks(data: bytes) -> object:
    return read_inputs(_photo(), name="p.png", masks=data)
