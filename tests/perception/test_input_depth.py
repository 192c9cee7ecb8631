"""Reading depth, each rule by itself; the whole of it is in `test_inputs`."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.errors import InputError
from diorama_core.perception.input_depth import FARTHEST_M, SKY_M, check_same_proportions, read_depth
from diorama_core.perception.input_photo import Source
from tests.perception.test_inputs import depth_png, encoded, npy, picture

FLAT = np.full((48, 64), 2.5, np.float32)


def read(data: bytes, scale: float = 1000.0, encoding: str = "linear", size=(64, 48)):
    return read_depth(Source(data, "depth"), scale, encoding, size)


@pytest.mark.parametrize("scale", [1000.0, 5000.0, 256.0])
def test_units_are_divided_out(scale: float) -> None:
    found, notes = read(depth_png(FLAT * scale), scale)
    np.testing.assert_allclose(found, 2.5, atol=1 / scale)
    assert notes == ()


@given(st.integers(0, 0xFFFF))
def test_rotated_bits_are_turned_back(value: int) -> None:
    stored = ((value << 3) | (value >> 13)) & 0xFFFF
    values = np.full((48, 64), 2500, np.uint16)
    rotated = (((values.astype(np.uint32) << 3) | (values.astype(np.uint32) >> 13)) & 0xFFFF).astype(np.uint16)
    rotated[0, 0] = stored
    found, _ = read(depth_png(rotated), encoding="sunrgbd")
    expected = value / 1000.0 if value / 1000.0 <= FARTHEST_M else 0.0
    assert found[0, 0] == pytest.approx(expected)


def test_every_way_of_saying_nothing_seen_is_zero() -> None:
    depth = FLAT.copy()
    depth[0, :7] = [np.nan, np.inf, -np.inf, -1.0, 0.0, 2 * SKY_M, FARTHEST_M + 1]
    found, _ = read(npy(depth))
    assert (found[0, :7] == 0).all()
    assert (found[1:] == 2.5).all()
    assert not found.flags.writeable


def test_a_wrong_unit_is_named_with_the_way_out() -> None:
    with pytest.raises(InputError, match="set --depth-scale"):
        read(depth_png(FLAT * 1000), 1.0)
    with pytest.raises(InputError, match="must be metres"):
        read(npy(FLAT * 1000))
    values = (FLAT * 1600).astype(np.uint32)
    with pytest.raises(InputError, match="--depth-encoding sunrgbd"):
        read(depth_png(((values << 3) | (values >> 13)) & 0xFFFF))
    for scale in (0.0, -1.0, np.nan):
        with pytest.raises(InputError, match="positive number"):
            read(depth_png(FLAT * 1000), scale)


def test_empty_depth_is_refused_and_sparse_depth_remarked() -> None:
    with pytest.raises(InputError, match="empty or nearly so"):
        read(npy(np.zeros((48, 64), np.float32)))
    sparse = np.where(np.arange(64) < 8, FLAT, 0.0).astype(np.float32)
    _, notes = read(npy(sparse))
    assert notes == ("only 12 % of the depth is measured",)


def test_other_sizes_are_sampled_without_inventing_depth() -> None:
    stripes = np.where(np.arange(32) % 2, 2.0, 3.0).astype(np.float32) * np.ones((24, 1), np.float32)
    found, notes = read(npy(stripes))
    assert found.shape == (48, 64)
    assert set(np.unique(found)) == {2.0, 3.0}
    assert notes == ()
    _, coarse = read(npy(stripes[::2, ::2]), size=(640, 480))
    assert "much coarser" in coarse[0]


@pytest.mark.parametrize(
    ("array", "reason"),
    [
        (np.ones((48, 64), np.int32), "must be floats"),
        (np.ones((48, 64, 3), np.float32), "two-dimensional"),
        (np.ones(64, np.float32), "two-dimensional"),
    ],
)
def test_arrays_that_are_no_depth(array, reason) -> None:
    with pytest.raises(InputError, match=reason):
        read(npy(array))


def test_damaged_and_colourful_files() -> None:
    with pytest.raises(InputError, match="truncated or damaged"):
        read(npy(FLAT)[:-100])
    with pytest.raises(InputError, match="one channel of 16 bits"):
        read(encoded(picture()))
    np.testing.assert_array_equal(read(npy(FLAT[None]))[0], FLAT)


def test_proportions_must_be_the_photos() -> None:
    check_same_proportions("d", "depth", (320, 240), (1285, 960))
    with pytest.raises(InputError, match="turn it upright"):
        check_same_proportions("d", "depth", (240, 320), (640, 480))
    with pytest.raises(InputError, match="of this very photo"):
        check_same_proportions("d", "depth", (320, 320), (640, 480))
