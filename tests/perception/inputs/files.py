"""Files that a person can hand in, made in memory, and the line with which one is refused."""

from __future__ import annotations

import io
import json
import struct
import zlib

import numpy as np
import pytest
from PIL import Image

from diorama_core.artefacts import Photo
from diorama_core.errors import InputError
from diorama_core.perception.inputs import read_inputs
from diorama_core.perception.inputs.photos.frame import PhotoFrame
from diorama_core.perception.inputs.photos.reading import DecodedPhoto

WIDTH, HEIGHT = 96, 64


def picture(width: int = WIDTH, height: int = HEIGHT, mode: str = "RGB") -> Image.Image:
    """A gradient to the right in red and downward in green, so that turns and flips show."""
    x, y = np.meshgrid(np.linspace(0, 255, width), np.linspace(0, 255, height))
    return Image.fromarray(np.stack([x, y, 0 * x + 40], axis=-1).astype(np.uint8)).convert(mode)


def encoded(image: Image.Image, fmt: str = "PNG", **options: object) -> bytes:
    stream = io.BytesIO()
    image.save(stream, fmt, **options)
    return stream.getvalue()


def claiming(width: int, height: int) -> bytes:
    """A small PNG whose header promises other dimensions."""
    data = encoded(picture())
    header = data[12:16] + struct.pack(">II", width, height) + data[24:29]
    return data[:12] + header + struct.pack(">I", zlib.crc32(header)) + data[33:]


def boxes_json(*records: object) -> bytes:
    return json.dumps(list(records)).encode()


def box(*bbox: float, word: str = "chair") -> dict[str, object]:
    return {"bbox": list(bbox), "class": word}


def depth_png(values: np.ndarray) -> bytes:
    return encoded(Image.fromarray(values.astype(np.uint16)))


def npy(array: np.ndarray) -> bytes:
    stream = io.BytesIO()
    np.save(stream, array)
    return stream.getvalue()


def decoded(width: int = WIDTH, height: int = HEIGHT, *, original: tuple[int, int] | None = None) -> DecodedPhoto:
    """A photo of plain colour as it was read, perhaps reduced from an original."""
    full = original or (width, height)
    return DecodedPhoto(Photo(np.full((height, width, 3), 90, np.uint8), "photo.png", full), PhotoFrame(full))


def refusal(*args: object, **kwargs: object) -> str:
    """The one line with which the input is refused."""
    with pytest.raises(InputError) as caught:
        read_inputs(*args, **kwargs)
    line = str(caught.value)
    assert "\n" not in line
    assert 15 < len(line) < 240
    return line
