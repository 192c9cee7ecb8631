"""Values of parsed JSON with the type that a reader needs."""

from __future__ import annotations

import pytest

from diorama_core.perception.inputs.json_values import objects_of, size_of, whole_numbers


def test_only_lists_of_objects_are_lists_of_objects() -> None:
    assert objects_of([{"a": 1}]) == [{"a": 1}]
    others: tuple[object, ...] = (None, {}, [], "text", [1], [{"a": 1}, None])
    for other in others:
        assert objects_of(other) == []


def test_sizes_are_two_sides_of_a_picture() -> None:
    assert size_of(640, 480.0) == (640, 480)
    for width, height in ((None, 480), ("640", 480), (1, 480), (True, 480), (1e9, 480), (float("nan"), 480)):
        assert size_of(width, height) is None


def test_only_lists_of_numbers_are_whole_numbers() -> None:
    assert whole_numbers([3, 4.0]) == [3, 4]
    for other in (None, "34", 3, [3, None], [float("nan")]):
        with pytest.raises(ValueError, match=r"."):
            whole_numbers(other)
