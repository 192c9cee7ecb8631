"""What a dropped file is, by its content."""

from __future__ import annotations

import json

import numpy as np
import pytest
from PIL import Image

from diorama_core.errors import InputError
from diorama_core.perception.inputs.sorting import recognise
from tests.perception.inputs.depth.rooms import HEIGHT, WIDTH, room
from tests.perception.inputs.files import box, boxes_json, depth_png, encoded, npy, picture

DEPTH, _ = room()
IDS = (np.arange(WIDTH)[None] // 40 * np.ones((HEIGHT, 1))).astype(np.uint8)
PHOTO = (WIDTH * 2, HEIGHT * 2)


@pytest.mark.parametrize(
    ("content", "sorts"),
    [
        (encoded(picture(WIDTH, HEIGHT), "JPEG"), ["photo"]),
        (encoded(picture(WIDTH, HEIGHT)), ["photo"]),
        (encoded(picture(300, 100)), ["photo"]),
        (encoded(picture(WIDTH, HEIGHT, "L")), ["photo", "depth"]),
        (encoded(Image.fromarray(IDS)), ["masks"]),
        (encoded(Image.fromarray(np.where(IDS > 1, 255, 0).astype(np.uint8)), "JPEG"), ["masks", "photo"]),
        (encoded(Image.fromarray(IDS), "JPEG"), ["photo"]),
        (depth_png(DEPTH * 1000), ["depth", "photo"]),
        (npy(DEPTH), ["depth"]),
        (npy(IDS > 0), ["masks"]),
        (npy(IDS.astype(np.int32)), ["masks", "depth"]),
        (boxes_json(box(1, 2, 30, 40)), ["boxes"]),
        (b"<annotation><object/></annotation>", ["boxes"]),
        (b"0 0.5 0.5 0.2 0.2\n", ["boxes"]),
        (
            json.dumps([{"segmentation": {"size": [2, 2], "counts": [4]}, "bbox": [0, 0, 9, 9]}]).encode(),
            ["boxes", "masks"],
        ),
        ((DEPTH * 1000).astype(np.uint16).tobytes(), ["depth"]),
    ],
)
def test_files_are_sorted(content: bytes, sorts: list[str]) -> None:
    assert [r.sort for r in recognise(content, "file", PHOTO)] == sorts


@pytest.mark.parametrize("content", [b"%PDF-1.4", b"<html></html>", b"hello", b'{"a": 1}'])
def test_what_is_not_read_is_said(content: bytes) -> None:
    with pytest.raises(InputError):
        recognise(content, "file", PHOTO)


def test_without_a_photo_a_picture_is_one() -> None:
    assert recognise(encoded(Image.fromarray(IDS)), "file", None)[0].sort == "photo"
