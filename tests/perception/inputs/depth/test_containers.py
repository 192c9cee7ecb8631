"""Depth as text. The containers of depth give the same numbers."""

from __future__ import annotations

import io

import cv2
import numpy as np
import pytest
from PIL import Image

from diorama_core.errors import InputError
from diorama_core.perception.inputs.depth.channels import one_channel
from diorama_core.perception.inputs.depth.containers import DEPTH_FORMS, is_number_table, read_number_table
from diorama_core.perception.inputs.depth.numpy_files import DepthContent, RawDepth
from diorama_core.perception.inputs.source import Source, form_of
from tests.perception.inputs.depth.rooms import FOCAL, HEIGHT, WIDTH, room
from tests.perception.inputs.depth.test_channels import in_bytes
from tests.perception.inputs.files import encoded, npy

ROW = ",".join(str(k / 10) for k in range(30))


def text_of(*rows: str) -> DepthContent:
    return DepthContent(Source("\n".join(rows).encode(), "d.csv"), (4, 3))


def test_rows_of_equal_length_are_a_map() -> None:
    values = read_number_table(text_of(*[ROW] * 30)).values
    assert values.shape == (30, 30)
    assert values[0, 29] == 2.9
    assert np.isnan(read_number_table(text_of(*[ROW.replace("0.0", "nan")] * 30)).values[0, 0])


@pytest.mark.parametrize("rows", [[ROW] * 5, ["0 0.1 0.2 0.3 0.4"] * 40, [ROW, *[ROW + ",1"] * 30], ["a" + ROW] * 30])
def test_other_texts_are_none(rows: list[str]) -> None:
    assert not is_number_table(text_of(*rows))


def test_a_damaged_row_is_refused_in_one_line() -> None:
    with pytest.raises(InputError, match="damaged"):
        read_number_table(text_of(*[ROW] * 30, "1,2"))


DEPTH, _ = room()
MILLIMETRES = (DEPTH * 1000).astype(np.uint16)


def read(data: bytes, name: str = "depth") -> RawDepth:
    content = DepthContent(Source(data, name), (WIDTH * 4, HEIGHT * 4))
    form = form_of(DEPTH_FORMS, content)
    return form.read(content)


def archive(**arrays: np.ndarray) -> bytes:
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    return stream.getvalue()


def table(values: np.ndarray, number: str, separator: str) -> bytes:
    stream = io.BytesIO()
    np.savetxt(stream, values, number, separator)
    return stream.getvalue()


def point_map(*order: int) -> np.ndarray:
    x = (np.arange(WIDTH) + 0.5 - WIDTH / 2) / WIDTH / FOCAL
    y = (np.arange(HEIGHT) + 0.5 - HEIGHT / 2) / WIDTH / FOCAL
    points = np.stack([DEPTH * x, DEPTH * y[:, None], DEPTH], axis=-1)
    return np.ascontiguousarray(points[..., list(order)] if order else points)


@pytest.mark.parametrize(
    "data",
    [
        npy(DEPTH),
        npy(DEPTH[None, None]),
        npy(DEPTH[..., None].astype(np.float64)),
        archive(depth=DEPTH, focallength_px=np.float32(500)),
        archive(anything=DEPTH),
        archive(depth=DEPTH, rgb=np.zeros((*DEPTH.shape, 3), np.uint8)),
        encoded(Image.fromarray(DEPTH), "TIFF"),
        DEPTH.tobytes(),
        npy(point_map()),
        npy(-point_map() * [-1, 1, 1]),
        npy(np.moveaxis(point_map(), -1, 0)),
        npy(point_map(2, 0, 1)),
        archive(my_map=DEPTH, intrinsics=np.eye(3), conf=np.ones(DEPTH.shape)),
        archive(pts3d=point_map(), valid_mask=np.ones(DEPTH.shape, bool)),
        table(DEPTH, "%.8f", " "),
    ],
)
def test_floats(data: bytes) -> None:
    found = read(data)
    assert found.is_float
    np.testing.assert_allclose(found.values, DEPTH, rtol=1e-6)


@pytest.mark.parametrize(
    ("data", "name"),
    [
        (npy(MILLIMETRES), "d.npy"),
        (npy(MILLIMETRES.astype(np.int32)), "d.npy"),
        (archive(depth=MILLIMETRES), "d.npz"),
        (table(MILLIMETRES, "%d", ","), "d.csv"),
        (cv2.imencode(".png", np.repeat(MILLIMETRES[..., None], 3, axis=2))[1].tobytes(), "d.png"),
        (encoded(Image.fromarray(in_bytes(MILLIMETRES, 0, 1))), "d.png"),
        (encoded(Image.fromarray(MILLIMETRES)), "d.png"),
        (encoded(Image.fromarray(MILLIMETRES), "TIFF"), "d.tif"),
        (MILLIMETRES.tobytes(), "d.raw"),
        (MILLIMETRES.astype(">u2").tobytes(), "d.bin"),
    ],
)
def test_whole_numbers(data: bytes, name: str) -> None:
    found = read(data, name)
    assert not found.is_float
    np.testing.assert_array_equal(found.values, MILLIMETRES)


def test_a_mask_in_the_archive_is_kept_to_and_disparity_is_called_so() -> None:
    mask = np.ones(DEPTH.shape, bool)
    mask[:30] = False
    assert (read(archive(depth=DEPTH, mask=mask)).values[:30] == 0).all()
    assert read(archive(disparity=1 / DEPTH)).stated_kind == "inverse"


def test_what_does_not_say_which_is_depth_is_refused() -> None:
    with pytest.raises(InputError, match="which of its arrays"):
        read(archive(a=DEPTH, b=DEPTH))
    with pytest.raises(InputError, match="colours for the eye"):
        read(encoded(Image.fromarray(np.stack([MILLIMETRES % 255] * 2 + [MILLIMETRES % 7], axis=-1).astype(np.uint8))))
    with pytest.raises(InputError, match="two-dimensional"):
        one_channel(np.random.default_rng(0).random((HEIGHT, WIDTH, 3)), "d")
    assert form_of(DEPTH_FORMS, DepthContent(Source(b"hello", "d.raw"), (4, 3))) is None
