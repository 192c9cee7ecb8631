from __future__ import annotations

import pytest

from diorama_core.artefacts import LayoutReport
from diorama_core.layout.what_got_worse import in_words, new_problems

LABELS = {"vase_1": "vase", "bowl_1": "bowl"}


def report(before: dict[str, float], after: dict[str, float]) -> LayoutReport:
    return LayoutReport("paper", before, after, 1.0)


def test_only_what_is_new_got_worse() -> None:
    before = {"a": ("collides",), "b": ("floats",)}
    after = {"a": ("collides", "floats"), "b": ("floats",), "c": ("outside",)}
    assert new_problems(before, after) == {"a": ("floats",), "c": ("outside",)}


def test_objects_in_the_air_are_named() -> None:
    worse = {"vase_1": ("floats",), "bowl_1": ("floats",)}
    assert in_words(report({}, {}), worse, LABELS) == ("2 objects float: vase, bowl.",)


def test_figures_that_got_worse_are_told() -> None:
    lines = in_words(
        report(
            {"overlapping_pairs": 1.0, "part_overlap_m": 0.02},
            {"overlapping_pairs": 2.0, "part_overlap_m": 0.02, "moved_m": 0.73},
        ),
        {},
        LABELS,
    )
    assert lines[0] == "Overlapping pairs went from 1 to 2."
    assert "73 cm" in lines[1]


@pytest.mark.parametrize("after", [{"overlapping_pairs": 0.0, "part_overlap_m": 0.0, "moved_m": 0.1}, {}])
def test_nothing_is_said_where_nothing_got_worse(after: dict[str, float]) -> None:
    assert in_words(report({"overlapping_pairs": 1.0, "part_overlap_m": 0.05}, after), {}, LABELS) == ()
