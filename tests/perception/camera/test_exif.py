from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.perception.camera.exif import FULL_FRAME_DIAGONAL_MM, PLAUSIBLE_FOCAL, focal_from_exif

FOCAL, FOCAL_35, RESOLUTION, UNIT, X, Y = 0x920A, 0xA405, 0xA20E, 0xA210, 0xA002, 0xA003


def test_the_35_mm_equivalent_is_taken_by_the_diagonal() -> None:
    # A 3:2 picture has the proportions of full frame, so that width over 36 mm is the scale.
    assert focal_from_exif({FOCAL_35: 28}, 3000, 2000) == pytest.approx(28 / 36 * 3000)
    assert focal_from_exif({FOCAL_35: 28}, 2000, 3000) == pytest.approx(28 / 36 * 3000)
    assert focal_from_exif({FOCAL_35: Fraction(28)}, 640, 480) == pytest.approx(28 / FULL_FRAME_DIAGONAL_MM * 800)


def test_millimetres_and_pixel_pitch_do_without_it() -> None:
    tags = {FOCAL: 4.0, RESOLUTION: 1000.0, UNIT: 4, X: 4000, Y: 3000}  # a thousand pixels per millimetre
    assert focal_from_exif(tags, 4000, 3000) == pytest.approx(4000.0)
    assert focal_from_exif(tags, 1000, 750) == pytest.approx(1000.0)
    inches = tags | {UNIT: 2, RESOLUTION: 25400.0}
    assert focal_from_exif(inches, 4000, 3000) == pytest.approx(4000.0)


def test_cropped_pictures_are_not_trusted_and_turned_ones_are() -> None:
    tags = {FOCAL_35: 28, X: 4000, Y: 3000}
    assert focal_from_exif(tags, 3000, 4000) is not None
    assert focal_from_exif(tags, 3000, 3000) is None


@pytest.mark.parametrize("value", [0, -28, "wide", None, float("nan"), float("inf"), b"28"])
def test_what_is_no_number_is_no_focal_length(value) -> None:
    assert focal_from_exif({FOCAL_35: value}, 3000, 2000) in (None, pytest.approx(28 / 36 * 3000))
    assert value == b"28" or focal_from_exif({FOCAL_35: value}, 3000, 2000) is None


junk = st.one_of(st.none(), st.integers(), st.floats(), st.text(max_size=5), st.binary(max_size=5))


@given(st.dictionaries(st.sampled_from([FOCAL, FOCAL_35, RESOLUTION, UNIT, X, Y]), junk))
def test_any_header_gives_a_plausible_focal_length_or_none(tags) -> None:
    found = focal_from_exif(tags, 3000, 2000)
    assert found is None or PLAUSIBLE_FOCAL[0] <= found / 3000 <= PLAUSIBLE_FOCAL[1]
