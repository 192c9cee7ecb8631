"""Arrays and lists in memory as the files that `read_inputs` checks, so that both are read in one place, and what a
file of an array promises.
"""

from __future__ import annotations

import io
import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import IO, Any

import numpy as np
from jaxtyping import Float, Int, UInt8
from numpy.lib import format as npy
from PIL import Image

from diorama_core.errors import InputError

Picture = UInt8[np.ndarray, "h w 3"]
"""sRGB."""
Masks = Int[np.ndarray, "h w"]
"""Id of the object at each pixel, 0 for background."""
Depth = Float[np.ndarray, "h w"]
"""z in camera in metres; 0 and NaN where missing."""
Boxes = Sequence[Mapping[str, Any]]
"""List of `{"bbox": [x1, y1, x2, y2], "class": "chair"}`, in pixels of the upright original photo."""

MAX_ID = 65535


def photo_file(photo: Path | str | bytes | Picture) -> Path | bytes:
    """The photo as a path or the content of a file; raises `InputError` when an array is no picture."""
    if isinstance(photo, Path | str | bytes):
        return _file(photo)
    return _encode(photo, "PPM", "photo", "h x w x 3 of uint8")


def masks_file(masks: Path | str | bytes | Masks | None) -> Path | bytes | None:
    """The instance map as a path or the content of a file; raises `InputError` when ids are out of range."""
    if masks is None or isinstance(masks, Path | str | bytes):
        return None if masks is None else _file(masks)
    if not np.issubdtype(masks.dtype, np.integer) or not masks.size or masks.min() < 0 or masks.max() > MAX_ID:
        raise InputError(f"masks: give an array of integer ids, 0 (background) to {MAX_ID}, one for each pixel")
    return _encode(masks.astype(np.uint16), "PNG", "masks", "h x w of integers")


def depth_file(depth: Path | str | bytes | Depth | None) -> Path | bytes | None:
    """The depth as a path or the content of a file."""
    if depth is None or isinstance(depth, Path | str | bytes):
        return None if depth is None else _file(depth)
    buffer = io.BytesIO()
    np.save(buffer, depth, allow_pickle=False)
    return buffer.getvalue()


def boxes_file(boxes: Path | str | bytes | Boxes | None) -> Path | bytes | None:
    """The boxes as a path or the content of a file; raises `InputError` when JSON cannot hold them."""
    if boxes is None or isinstance(boxes, Path | str | bytes):
        return None if boxes is None else _file(boxes)
    try:
        return json.dumps([dict(box) for box in boxes], default=_plain).encode()
    except (TypeError, ValueError) as error:
        raise InputError(f'boxes: {error}; give dictionaries {{"bbox": [x1, y1, x2, y2], "class": "chair"}}') from error


def _file(given: Path | str | bytes) -> Path | bytes:
    return Path(given) if isinstance(given, str) else given


def array_header(stream: IO[bytes] | io.BytesIO, most: float = math.inf) -> tuple[tuple[int, ...], np.dtype]:
    """Shape and type of an array whose header promises no more than so many bytes; the stream is where it was.

    Raises:
        ValueError: the header is damaged, or promises more.
    """
    version = npy.read_magic(stream)
    shape, _, dtype = npy.read_array_header_1_0(stream) if version == (1, 0) else npy.read_array_header_2_0(stream)
    stream.seek(0)
    size = math.inf if dtype.hasobject else float(np.prod(shape, dtype=float)) * dtype.itemsize
    if any(n < 0 for n in shape) or size > most:
        raise ValueError("its header promises too much")
    return shape, dtype


def _plain(value: object) -> object:
    """numpy's numbers and arrays as JSON knows them."""
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    raise TypeError(f"{value!r} is not a number, a string or a list")


def _encode(pixels: np.ndarray, kind: str, what: str, shape: str) -> bytes:
    buffer = io.BytesIO()
    try:
        Image.fromarray(pixels).save(buffer, kind)
    except (TypeError, ValueError, OSError, AttributeError) as error:
        text = f"{getattr(pixels, 'dtype', type(pixels).__name__)} {getattr(pixels, 'shape', '')}".strip()
        raise InputError(f"{what}: {text} is not a picture; give an array of {shape}, or a file") from error
    return buffer.getvalue()
