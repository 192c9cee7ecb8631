"""Training pictures keep their boxes where the objects are."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.training.augment import MIN_SIDE_PX, photograph, training_picture
from diorama_core.training.pictures import LabelledPicture

SIZE = (96, 64)


def picture(seed: int) -> LabelledPicture:
    """A dark picture with one bright rectangle, labelled."""
    rng = np.random.default_rng(seed)
    rgb = np.full((60, 80, 3), 20, np.uint8)
    x, y = (int(v) for v in rng.integers(5, 30, 2))
    rgb[y : y + 20, x : x + 30] = 240
    box = np.array([[x, y, x + 30, y + 20]], np.float32)
    return LabelledPicture(rgb, box, np.array([3]), np.array([600]), np.full((1, 7), -1, np.int8))


@given(seed=st.integers(0, 10_000), mosaic=st.booleans())
def test_boxes_stay_in_the_picture_and_on_the_object(seed: int, mosaic: bool) -> None:
    made = training_picture([picture(seed + k) for k in range(4 if mosaic else 1)], SIZE, np.random.default_rng(seed))
    assert made.rgb.shape == (SIZE[1], SIZE[0], 3)
    assert len(made.boxes) == len(made.categories) == len(made.pixels)
    for x1, y1, x2, y2 in made.boxes:
        assert 0 <= x1 < x2 <= SIZE[0]
        assert 0 <= y1 < y2 <= SIZE[1]
        assert min(x2 - x1, y2 - y1) >= MIN_SIDE_PX
        inside = made.rgb[int(y1) + 2 : int(y2) - 1, int(x1) + 2 : int(x2) - 1]
        assert inside.mean() > made.rgb.min() + 20, "the bright rectangle is in its box"


def test_the_same_seed_gives_the_same_picture() -> None:
    first, again = (photograph(picture(0).rgb, np.random.default_rng(5)) for _ in range(2))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, photograph(picture(0).rgb, np.random.default_rng(6)))
