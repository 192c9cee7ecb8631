"""Reading depth, each rule by itself, then whole files as people hand them in."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.errors import InputError
from diorama_core.perception.inputs import read_inputs
from diorama_core.perception.inputs.depth.reading import FARTHEST_M, DepthOptions, apply_turn, find_turn, read_depth
from diorama_core.perception.inputs.depth.voids import SKY_M
from diorama_core.perception.inputs.source import Source
from tests.perception.inputs.depth.rooms import room
from tests.perception.inputs.files import HEIGHT, WIDTH, decoded, depth_png, encoded, npy, picture, refusal

FLAT = np.full((48, 64), 2.5, np.float32)
DEPTH, _ = room()
DEPTH = DEPTH[:, :140]  # not alike left and right
NOISE = np.random.default_rng(0).normal(0, 3, (*DEPTH.shape, 1))
PHOTO = np.clip(60 + 30 * DEPTH[..., None] + NOISE, 0, 255).repeat(3, axis=2).astype(np.uint8)


def test_depth_along_minus_z_is_turned_round() -> None:
    raw = np.repeat(np.linspace(1.0, 3.0, 48, dtype=np.float32)[:, None], 64, axis=1)
    found, notes = read_depth(Source(npy(-raw), "d.npy"), DepthOptions(1.0, kind="depth"), decoded(64, 48))
    assert found == pytest.approx(raw)
    assert "its sign was changed" in notes[0]


def test_depth_that_hardly_differs_is_remarked() -> None:
    raw = np.repeat(np.linspace(0.95, 0.99, 48, dtype=np.float32)[:, None], 64, axis=1)
    _, notes = read_depth(Source(npy(raw), "d.npy"), DepthOptions(1.0, kind="depth"), decoded(64, 48))
    assert "z-buffer" in notes[0]


def read(data: bytes, scale: float | None = None, encoding: str = "linear", size=(64, 48)):
    return read_depth(Source(data, "depth"), DepthOptions(scale, encoding), decoded(*size))


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
    expected = value / 1000.0 if value < 0xFFFF else 0.0  # the end of the type is no measurement
    assert found[0, 0] == pytest.approx(expected)


def test_whole_numbers_that_nothing_confirms_are_remarked() -> None:
    _, notes = read(depth_png(FLAT * 1000))
    assert "taken for millimetres" in notes[0]
    assert read(npy(FLAT))[1] == ()


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


class TestDepth:
    photo = encoded(picture())

    def read(self, data: bytes, **options: object) -> np.ndarray:
        depth = read_inputs(self.photo, depth=data, **options).inputs.depth_m
        assert depth.dtype == np.float32
        assert depth.shape == (HEIGHT, WIDTH)
        return depth

    @pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64])
    def test_float_sizes(self, dtype: type) -> None:
        assert self.read(npy(np.full((HEIGHT, WIDTH, 1), 1.5, dtype)))[0, 0] == 1.5

    def test_exr_in_metres(self) -> None:
        photo = encoded(picture(24 * 4, 20 * 4))
        depth = read_inputs(photo, depth=Path(__file__).parents[2] / "exr" / "zip.exr").inputs.depth_m
        assert (depth[2, 2], depth[-2, 2]) == (1.0, 2.0)

    def test_other_proportions_are_refused(self) -> None:
        square = depth_png(np.full((HEIGHT, HEIGHT), 1000))
        assert "64 x 64" in refusal(self.photo, depth=square)
        lying = depth_png(np.full((WIDTH, HEIGHT), 1000))
        assert "upright" in refusal(self.photo, depth=lying)

    @pytest.mark.parametrize(
        ("data", "word"),
        [
            (b"", "0 bytes"),
            (b"not depth", "not a picture"),
            (encoded(picture()), "16 bits"),
            (depth_png(np.zeros((HEIGHT, WIDTH))), "empty"),
            (npy(np.full((HEIGHT, WIDTH), np.nan)), "empty"),
            (npy(np.full((HEIGHT, WIDTH), 2500.0)), "metres"),
            (npy(np.full((HEIGHT, WIDTH, 3), 2.5) * [1, 2, 3]), "two-dimensional"),
            (npy(np.full((HEIGHT, WIDTH), 2.5))[:500], "truncated"),
            (npy(np.array([{"a": 1}], dtype=object)), "must be floats in metres"),
            (npy(np.ones(64, np.float32)), "two-dimensional"),
            (depth_png(np.full((HEIGHT, WIDTH), 20)), "--depth-scale"),
            (depth_png(np.full((HEIGHT, WIDTH), 1500))[:60], "damaged"),
            (b"\x76\x2f\x31\x01" + b"\0" * 64, "EXR"),
            (b"\x76\x2f\x31\x01\x02\x02\0\0", "damaged"),
            ((Path(__file__).parents[2] / "exr" / "piz.exr").read_bytes()[:200], "damaged"),
        ],
    )
    def test_refused_in_one_line(self, data: bytes, word: str) -> None:
        assert word in refusal(self.photo, depth=data)

    def test_a_header_that_promises_too_much_allocates_nothing(self) -> None:
        header = b"{'descr': '<f8', 'fortran_order': False, 'shape': (1000000, 1000000), }"
        data = b"\x93NUMPY\x01\x00" + len(header).to_bytes(2, "little") + header
        assert "1000000 megapixels" in refusal(self.photo, depth=data)
        data = data.replace(b"(1000000, 1000000), ", b"(1000000, 30), 0000 ".replace(b"0000", b"    "))
        assert "truncated" in refusal(self.photo, depth=data)


@pytest.mark.parametrize("how", ["mirrored", "upside down", "upside down and mirrored"])
@pytest.mark.parametrize("inverse", [True, False])
def test_turned_maps_are_told_and_turned(how: str, inverse: bool) -> None:
    values = 1 / DEPTH if inverse else DEPTH
    over = apply_turn(values, how)
    assert find_turn(over, PHOTO) == how
    np.testing.assert_array_equal(apply_turn(over, how), values)


def test_right_maps_and_plain_photos_say_nothing() -> None:
    assert find_turn(DEPTH, PHOTO) is None
    assert find_turn(DEPTH, np.full_like(PHOTO, 90)) is None
    holes = DEPTH * (np.random.default_rng(1).random(DEPTH.shape) > 0.9)
    assert find_turn(holes, PHOTO) is None
