"""What of an object goes on outside its box is not left in the wall's picture."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.architecture.texture.continued_objects import (
    cut_patches,
    find_continued_objects,
    object_colours,
)
from diorama_core.artefacts import DetectedObject

SIZE, PIXEL_M = 200, 0.01
WALL, SHADED, GREEN, RED = (225, 220, 210), (150, 146, 139), (40, 90, 35), (190, 40, 40)
BOX = (80.0, 120.0, 140.0, 199.0)
"""The lower half of a plant; the wall's texels are the photo's pixels."""


def wall_with(piece: tuple[slice, slice], colour: tuple[int, int, int]) -> np.ndarray:
    picture = np.full((SIZE, SIZE, 3), WALL, np.uint8)
    picture[120:200, 85:135] = GREEN
    picture[piece] = colour
    return picture


def continued(picture: np.ndarray, objects: tuple[DetectedObject, ...] | None = None) -> np.ndarray:
    mask = np.zeros((SIZE, SIZE), dtype=bool)
    mask[120:200, 85:135] = True
    item = DetectedObject("plant_1", "plant", "plant", BOX, mask, 1, 0.8)
    hidden = np.zeros((SIZE, SIZE), dtype=bool)
    hidden[118:, 78:142] = True
    own = (np.abs(picture.astype(int) - WALL).sum(axis=-1) < 20) & ~hidden
    foreign = ~own & ~hidden
    rows, columns = np.nonzero(foreign)
    known = object_colours(picture, (item,) if objects is None else objects)
    where = np.stack([columns, rows], axis=1) + 0.5
    return find_continued_objects(picture.astype(np.float32), own, foreign, where, known, PIXEL_M, SIZE)


UPPER_HALF = (slice(50, 120), slice(90, 130))


def test_the_upper_half_of_a_plant_is_not_wall() -> None:
    found = continued(wall_with(UPPER_HALF, GREEN))
    assert found[50:118, 90:130].all()
    assert not found[:40].any()


@pytest.mark.parametrize("colour", [RED, SHADED], ids=["a poster", "a shadow"])
def test_what_has_no_colour_of_the_object_stays(colour) -> None:
    assert not continued(wall_with(UPPER_HALF, colour)).any()


@pytest.mark.parametrize(
    "piece", [(slice(10, 60), slice(90, 130)), (slice(0, 118), slice(0, 200))], ids=["apart", "a green wall"]
)
def test_what_is_not_joined_or_much_larger_stays(piece) -> None:
    assert not continued(wall_with(piece, GREEN)).any()


def test_without_objects_nothing_is_theirs() -> None:
    assert not continued(wall_with(UPPER_HALF, GREEN), ()).any()


def duvet(*, shown: slice) -> tuple[np.ndarray, DetectedObject]:
    """A white duvet on a brown floor, of which a mask holds some columns."""
    picture = np.full((SIZE, SIZE, 3), (120, 90, 60), np.uint8)
    picture[60:140, 40:160] = (245, 245, 245)
    mask = np.zeros((SIZE, SIZE), dtype=bool)
    mask[60:140, shown] = True
    return picture, DetectedObject("bed_1", "bed", "bed", (30.0, 50.0, 170.0, 150.0), mask, 1, 0.7)


def test_an_even_patch_that_a_mask_cuts_in_two_is_the_objects() -> None:
    picture, bed = duvet(shown=slice(40, 110))
    found = cut_patches(picture, (bed,))
    assert found[61:139, 111:159].all()
    assert not found[:, :110].any()
    assert not found[145:].any()
    assert not found[:55].any()


def test_a_patch_that_a_mask_hardly_touches_is_not() -> None:
    picture, bed = duvet(shown=slice(40, 60))
    assert not cut_patches(picture, (bed,)).any()
