"""Depth channels of EXR files that another program wrote."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.perception.exr import ExrError, read_depth_channel

FILES = Path(__file__).parent / "exr"
"""24 x 20 pixels, one channel Z, written by the OpenEXR library with each compression (zips: 32 bits, others 16)."""


def expected() -> np.ndarray:
    y, x = np.mgrid[:20, :24]
    return (1 + x / 16 + (y > 9)).astype(np.float32)


@pytest.mark.parametrize("compression", ["none", "rle", "zips", "zip"])
def test_every_compression_gives_the_same_numbers(compression: str) -> None:
    np.testing.assert_array_equal(read_depth_channel((FILES / f"{compression}.exr").read_bytes()), expected())


def test_other_compressions_are_named() -> None:
    with pytest.raises(ExrError, match="PIZ"):
        read_depth_channel((FILES / "piz.exr").read_bytes())


@settings(max_examples=150, deadline=None)
@given(st.sampled_from(["none", "rle", "zips", "zip"]), st.data())
def test_damage_never_escapes_as_another_error(compression: str, data: st.DataObject) -> None:
    good = bytearray((FILES / f"{compression}.exr").read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        good[data.draw(st.integers(0, len(good) - 1))] = data.draw(st.integers(0, 255))
    cut = bytes(good[: data.draw(st.integers(4, len(good)))])
    try:
        values = read_depth_channel(cut)
    except ExrError:
        return
    assert values.dtype == np.float32
