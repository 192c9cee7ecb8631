from __future__ import annotations

import io

import numpy as np
import pytest
from PIL import Image

from diorama_core.export.pictures import (
    OncePerPicture,
    TexturePictures,
    encode_picture,
    picture_suffix,
    png_bytes,
    power_of_two,
    shrink,
    texture_file,
    tint,
)
from diorama_core.io.srgb import linear_to_srgb, srgb_to_linear

GRADIENT = np.arange(48, dtype=np.uint8).reshape(4, 4, 3)


def test_small_and_transparent_pictures_are_png_and_exact() -> None:
    np.testing.assert_array_equal(np.asarray(Image.open(io.BytesIO(encode_picture(GRADIENT)))), GRADIENT)
    clear = np.zeros((600, 600, 4), np.uint8)
    assert picture_suffix(clear) == ".png"
    assert Image.open(io.BytesIO(encode_picture(clear))).format == "PNG"
    assert Image.open(io.BytesIO(png_bytes(clear[..., :3]))).format == "PNG"


def test_large_opaque_pictures_are_jpeg() -> None:
    large = np.full((600, 600, 3), 90, np.uint8)
    assert picture_suffix(large) == ".jpg"
    back = Image.open(io.BytesIO(encode_picture(large)))
    assert back.format == "JPEG"
    assert abs(int(np.asarray(back).mean()) - 90) <= 1


@pytest.mark.parametrize(("limit", "shape"), [(None, (60, 100)), (50, (30, 50)), (200, (60, 100))])
def test_pictures_are_reduced_to_their_limit(limit: int | None, shape: tuple[int, int]) -> None:
    assert shrink(np.zeros((60, 100, 3), np.uint8), limit).shape == (*shape, 3)


def test_sides_become_powers_of_two() -> None:
    assert power_of_two(np.zeros((60, 130, 3), np.uint8)).shape == (64, 128, 3)
    assert power_of_two(GRADIENT) is GRADIENT


def test_tinting_multiplies_light_and_leaves_alpha() -> None:
    picture = np.concatenate([GRADIENT * 5, np.full((4, 4, 1), 77, np.uint8)], axis=2)
    colour = (0.5, 1.0, 0.0)
    expected = 255 * linear_to_srgb(srgb_to_linear(picture[..., :3] / 255) * np.asarray(colour))
    out = tint(picture, colour)
    np.testing.assert_allclose(out[..., :3], expected, atol=0.5)
    np.testing.assert_array_equal(out[..., 3], 77)
    assert tint(picture, (1.0, 1.0, 1.0)) is picture


def test_textures_are_files_whose_sides_are_powers_of_two() -> None:
    suffix, content = texture_file(np.full((100, 60, 3), 90, np.uint8))
    assert suffix == ".png"
    assert Image.open(io.BytesIO(content)).size == (64, 128)


def test_one_picture_is_made_once_and_equal_ones_are_told_apart() -> None:
    made: list[tuple[int, int]] = []

    def make(picture: np.ndarray, more: int) -> int:
        made.append((int(picture[0, 0, 0]), more))
        return len(made)

    once, other = OncePerPicture(make), GRADIENT.copy()
    assert [once(GRADIENT, 1), once(GRADIENT, 1), once(GRADIENT, 2), once(other, 1), once(GRADIENT, 1)] == [
        1,
        1,
        2,
        3,
        1,
    ]
    assert made == [(0, 1), (0, 2), (0, 1)]


def test_pictures_that_are_gone_leave_nothing_to_those_in_their_place() -> None:
    once = OncePerPicture(lambda picture: int(picture[0, 0, 0]))
    assert [once(np.full((1, 1, 3), k, np.uint8)) for k in range(50)] == list(range(50))


def test_tinted_pictures_of_an_export_are_shared() -> None:
    pictures, red = TexturePictures(), (1.0, 0.0, 0.0)
    first = pictures.tinted(GRADIENT, red)
    assert pictures.tinted(GRADIENT, red) is first
    assert pictures.encoded(first) is pictures.encoded(first)
    np.testing.assert_array_equal(np.asarray(Image.open(io.BytesIO(pictures.encoded(first)))), tint(GRADIENT, red))
