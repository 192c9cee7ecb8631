from __future__ import annotations

import pytest

from diorama_core.scene.belief import Belief

DOUBTFUL = Belief(0.8, (("chair", 0.5), ("table", 0.5)), (0.7, 0.1, 0.2, 0.0), (("floor", 0.9), ("wall_1", 0.1)))


def test_right_is_everything_right_together() -> None:
    assert DOUBTFUL.right == pytest.approx(0.8 * 0.5 * 0.7 * 0.9)
    assert Belief().right == 1.0


def test_what_a_person_says_is_certain_and_so_is_that_there_is_something() -> None:
    said = DOUBTFUL.with_kind("stool").with_front().with_supporter("wall_1")
    assert said.right == 1.0
    assert said.kinds == (("stool", 1.0),)
    assert DOUBTFUL.with_front().kinds == DOUBTFUL.kinds
