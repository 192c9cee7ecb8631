"""Uploads through the decoding process: the same inputs as read here, and one line where they are not."""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from diorama_app.projects.uploads import Upload, decode
from diorama_core.errors import InputError
from diorama_core.io.limited import LimitedProcess
from diorama_core.perception.inputs import read_inputs
from tests.io.test_bombs import png


@pytest.fixture(scope="module")
def process() -> Iterator[LimitedProcess]:
    process = LimitedProcess()
    yield process
    process.stop()


def picture(mode: str, value: int, size: tuple[int, int] = (96, 64)) -> bytes:
    buffer = io.BytesIO()
    Image.fromarray(np.full(size[::-1], value, mode)).save(buffer, "PNG")
    return buffer.getvalue()


UPLOAD = Upload(
    picture("uint8", 90),
    "room.png",
    depth=picture("uint16", 500),
    boxes=b'[{"bbox": [5, 5, 40, 50], "class": "chair"}]',
    fov_deg=60.0,
    depth_scale=250.0,
)


def test_everything_arrives_as_it_was_sent(process: LimitedProcess) -> None:
    read = decode(UPLOAD, process)
    here = read_inputs(
        UPLOAD.photo, name="room.png", depth=UPLOAD.depth, depth_scale=250.0, boxes=UPLOAD.boxes, fov_deg=60.0
    )
    assert read.inputs.depth_m is not None
    assert read.inputs.depth_m[5, 5] == pytest.approx(2.0)
    assert here.inputs.depth_m is not None
    np.testing.assert_array_equal(read.inputs.depth_m, here.inputs.depth_m)
    np.testing.assert_array_equal(read.inputs.photo.rgb, here.inputs.photo.rgb)
    assert read.inputs.boxes == here.inputs.boxes
    assert read.inputs.intrinsics == here.inputs.intrinsics
    assert read.warnings == here.warnings
    sized = decode(replace(UPLOAD, fov_deg=None, intrinsics=(80.0, 80.0, 48.0, 32.0)), process)
    assert sized.inputs.intrinsics is not None
    assert sized.inputs.intrinsics.fx == pytest.approx(80.0)


def test_what_needs_too_much_memory_is_one_line() -> None:
    small = LimitedProcess(memory=700_000_000)
    try:
        with pytest.raises(InputError, match=r"^large\.png: .*memory") as told:
            decode(Upload(png(9_000, 7_000, 8, 6, 4), "large.png"), small)
    finally:
        small.stop()
    assert "\n" not in str(told.value)
