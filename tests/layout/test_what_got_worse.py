from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import LayoutReport
from diorama_core.layout.what_got_worse import (
    MAX_RESIZE,
    describe_worse,
    find_excessive_resizes,
    new_problems,
    resizes_in_words,
    with_believed_sizes,
)
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.app.small_room import furnished_scene

LABELS = {"vase_1": "vase", "bowl_1": "bowl"}


def report(before: dict[str, float], after: dict[str, float]) -> LayoutReport:
    return LayoutReport("paper", before, after, 1.0)


def test_only_what_is_new_got_worse() -> None:
    before = {"a": ("collides",), "b": ("floats",)}
    after = {"a": ("collides", "floats"), "b": ("floats",), "c": ("outside",)}
    assert new_problems(before, after) == {"a": ("floats",), "c": ("outside",)}


def test_objects_in_the_air_are_named() -> None:
    worse = {"vase_1": ("floats",), "bowl_1": ("floats",)}
    assert describe_worse(report({}, {}), worse, LABELS) == ("2 objects float: vase, bowl.",)


def test_figures_that_got_worse_are_told() -> None:
    lines = describe_worse(
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
    assert describe_worse(report({"overlapping_pairs": 1.0, "part_overlap_m": 0.05}, after), {}, LABELS) == ()


def _sized(factor: float) -> Scene:
    scene = furnished_scene()
    return edits.resize(scene, "table_1", factor * scene.object("table_1").size_m)


@pytest.mark.parametrize("factor", [0.35, 3.0])
def test_sizes_that_left_what_is_believed_are_a_problem_and_said_in_words(factor: float) -> None:
    scene = furnished_scene()
    assert find_excessive_resizes(scene, _sized(factor)) == {"table_1": ("was resized",)}
    size = 100 * factor * np.array([140.0, 80.0, 74.0]) / 100
    said = f"resized: dining table, 140 x 80 x 74 to {size[0]:.0f} x {size[1]:.0f} x {size[2]:.0f} cm"
    assert resizes_in_words(scene, _sized(factor)) == (said,)


def test_small_changes_of_size_are_no_problem() -> None:
    assert find_excessive_resizes(furnished_scene(), _sized(1.1)) == {}
    assert len(resizes_in_words(furnished_scene(), _sized(1.1))) == 1
    assert resizes_in_words(furnished_scene(), _sized(1.01)) == ()


@pytest.mark.parametrize("factor", [0.35, 3.0])
def test_sizes_are_brought_back_to_what_is_believed_on_the_same_base(factor: float) -> None:
    scene = furnished_scene()
    believed = with_believed_sizes(scene, _sized(factor))
    table, lamp = believed.object("table_1"), believed.object("lamp_1")
    expected = np.clip(factor, 1 / MAX_RESIZE, MAX_RESIZE) * scene.object("table_1").size_m
    np.testing.assert_allclose(table.size_m, expected)
    assert table.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-9)
    assert lamp.corners_world[:, 2].min() == pytest.approx(table.size_m[2], abs=1e-6)
    assert with_believed_sizes(scene, scene) == scene
