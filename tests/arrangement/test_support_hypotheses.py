"""What is seen below an object's lower rim."""

from __future__ import annotations

import numpy as np

from diorama_core.arrangement.support_hypotheses import visible_shares_below


def _mask(rows: slice, columns: slice) -> np.ndarray:
    mask = np.zeros((240, 320), dtype=bool)
    mask[rows, columns] = True
    return mask


def test_a_cup_is_seen_above_the_table_that_it_stands_on() -> None:
    below = visible_shares_below(
        {"table": _mask(slice(120, 200), slice(40, 280)), "cup": _mask(slice(100, 130), slice(100, 120))}
    )
    assert below["cup"] == {"table": 1.0}
    assert below["table"] == {}


def test_what_stands_half_beside_a_box_is_half_above_it() -> None:
    below = visible_shares_below(
        {"box": _mask(slice(150, 200), slice(100, 200)), "vase": _mask(slice(100, 150), slice(180, 220))}
    )
    assert below["vase"] == {"box": 0.5}


def test_the_smaller_of_two_overlapping_masks_lies_in_front() -> None:
    below = visible_shares_below(
        {"bed": _mask(slice(60, 220), slice(20, 300)), "pillow": _mask(slice(80, 120), slice(60, 120))}
    )
    assert below["pillow"] == {"bed": 1.0}


def test_masks_at_the_lower_border_and_empty_masks_have_nothing_below() -> None:
    below = visible_shares_below(
        {"rug": _mask(slice(200, 240), slice(0, 320)), "hidden": _mask(slice(0, 0), slice(0, 0))}
    )
    assert below == {"rug": {}, "hidden": {}}
    assert visible_shares_below({}) == {}
