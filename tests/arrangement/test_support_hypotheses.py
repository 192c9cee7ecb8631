"""What is seen below an object's lower rim."""

from __future__ import annotations

import numpy as np

from diorama_core.arrangement.support_hypotheses import visible_shares_below


def shares(**masks: tuple[slice, slice]) -> dict[str, dict[str, float]]:
    """Shares seen below rectangles of rows and columns."""
    drawn = {name: np.zeros((240, 320), dtype=bool) for name in masks}
    for name, at in masks.items():
        drawn[name][at] = True
    return visible_shares_below(drawn)


def test_a_cup_is_seen_above_the_table_that_it_stands_on() -> None:
    below = shares(table=np.s_[120:200, 40:280], cup=np.s_[100:130, 100:120])
    assert below == {"table": {}, "cup": {"table": 1.0}}


def test_what_stands_half_beside_a_box_is_half_above_it() -> None:
    assert shares(box=np.s_[150:200, 100:200], vase=np.s_[100:150, 180:220])["vase"] == {"box": 0.5}


def test_the_smaller_of_two_overlapping_masks_lies_in_front() -> None:
    assert shares(bed=np.s_[60:220, 20:300], pillow=np.s_[80:120, 60:120])["pillow"] == {"bed": 1.0}


def test_masks_at_the_lower_border_and_empty_masks_have_nothing_below() -> None:
    assert shares(rug=np.s_[200:240, 0:320], hidden=np.s_[0:0, 0:0]) == {"rug": {}, "hidden": {}}
    assert shares() == {}
