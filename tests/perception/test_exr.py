"""Depth channels of EXR files that another program wrote."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.perception.exr import ExrError, read_depth_channels

FILES = Path(__file__).parent / "exr"
"""24 x 20 pixels, one channel Z, written by the OpenEXR library with each compression (zips: 32 bits, others 16)."""
COMPRESSIONS = ("none", "rle", "zips", "zip", "piz")


def expected() -> np.ndarray:
    y, x = np.mgrid[:20, :24]
    return (1 + x / 16 + (y > 9)).astype(np.float32)


def written(header: dict, channels: dict, tmp_path: Path) -> bytes:
    OpenEXR.File(header, channels).write(str(tmp_path / "made.exr"))
    return (tmp_path / "made.exr").read_bytes()


@pytest.mark.parametrize("compression", COMPRESSIONS)
def test_every_compression_gives_the_same_numbers(compression: str) -> None:
    np.testing.assert_array_equal(read_depth_channels((FILES / f"{compression}.exr").read_bytes()), expected())


def test_tiles_are_read(tmp_path: Path) -> None:
    tiles = OpenEXR.TileDescription()
    tiles.xSize = tiles.ySize = 16
    header = {"compression": OpenEXR.PIZ_COMPRESSION, "type": OpenEXR.tiledimage, "tiles": tiles}
    data = written(header, {"Z": expected()}, tmp_path)
    np.testing.assert_array_equal(read_depth_channels(data), expected())


def test_the_depth_among_colours_and_of_a_second_part(tmp_path: Path) -> None:
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    flat = np.zeros((20, 24), np.float32)
    data = written(header, {"R": flat, "G": flat, "B": flat, "depth.Z": expected()}, tmp_path)
    np.testing.assert_array_equal(read_depth_channels(data), expected())
    parts = [
        OpenEXR.Part({**header, "name": "colour"}, {"G": flat, "B": flat}, "colour"),
        OpenEXR.Part({**header, "name": "depth"}, {"Z": expected()}, "depth"),
    ]
    OpenEXR.File(parts).write(str(tmp_path / "parts.exr"))
    np.testing.assert_array_equal(read_depth_channels((tmp_path / "parts.exr").read_bytes()), expected())


def test_without_depth_it_says_what_there_is(tmp_path: Path) -> None:
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    flat = np.zeros((20, 24), np.float32)
    with pytest.raises(ExrError, match=r"none of its channels \(B, G\) is called Z"):
        read_depth_channels(written(header, {"G": flat, "B": flat}, tmp_path))


def test_a_stated_size_beyond_any_photo_is_refused_before_memory() -> None:
    data = bytearray((FILES / "zip.exr").read_bytes())
    at = data.index(b"dataWindow\0box2i\0") + len(b"dataWindow\0box2i\0") + 4
    data[at : at + 16] = np.array([0, 0, 19_999, 19_999], "<i4").tobytes()
    with pytest.raises(ExrError, match=r"20000 x 20000 pixels|damaged"):
        read_depth_channels(bytes(data))


def test_very_many_channels_are_refused_before_memory(tmp_path: Path) -> None:
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    flat = np.zeros((2, 20_000), np.float16)
    data = bytearray(written(header, {f"{i:03}": flat for i in range(200)} | {"Z": flat}, tmp_path))
    for name in (b"dataWindow", b"displayWindow"):
        at = data.index(name + b"\0box2i\0") + len(name + b"\0box2i\0") + 4
        data[at : at + 16] = np.array([0, 0, 19_999, 1_999], "<i4").tobytes()
    with pytest.raises(ExrError, match=r"too many|damaged"):
        read_depth_channels(bytes(data))


@given(st.sampled_from(COMPRESSIONS), st.data())
def test_damage_never_escapes_as_another_error(compression: str, data: st.DataObject) -> None:
    good = bytearray((FILES / f"{compression}.exr").read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        good[data.draw(st.integers(0, len(good) - 1))] = data.draw(st.integers(0, 255))
    cut = bytes(good[: data.draw(st.integers(4, len(good)))])
    try:
        values = read_depth_channels(cut)
    except ExrError:
        return
    assert values.dtype == np.float32


def test_something_else_is_said_to_be() -> None:
    with pytest.raises(ExrError, match="not an EXR file"):
        read_depth_channels(io.BytesIO(b"\x89PNG....").getvalue())
