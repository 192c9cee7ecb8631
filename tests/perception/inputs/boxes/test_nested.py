"""Annotations deep within a JSON value."""

from __future__ import annotations

import pytest

from diorama_core.perception.inputs.boxes.nested import class_names_in, lists_in, objects_of, pictures_in, size_of

ROWS = [{"bbox": [1, 2, 30, 40], "class": "chair"}]
BARE = [{"bbox": [1, 2, 30, 40]}]


def test_lists_are_found_with_what_holds_them() -> None:
    ((rows, holder),) = lists_in({"a": {"b": [{"c": ROWS}]}})
    assert rows == ROWS
    assert holder == {"c": ROWS}
    ((rows, _),) = lists_in({"kinds": [{"name": "sofa", "found": BARE}]})
    assert rows == [{**BARE[0], "class": "sofa"}]


@pytest.mark.parametrize(
    ("document", "count"),
    [
        ({"images": [{"file_name": "a.png", "objects": ROWS}, {"file_name": "b.png", "objects": ROWS}]}, 2),
        ({"a.png": ROWS, "b.jpg": ROWS}, 2),
        ({"kinds": [{"name": "sofa", "found": BARE}]}, 0),
        ({"image": {"width": 10}, "boxes": ROWS}, 0),
    ],
)
def test_pictures_are_told_from_kinds(document: object, count: int) -> None:
    assert len(pictures_in(document)) == count


@pytest.mark.parametrize(
    "names",
    [{"class-map": {"0": "sofa", "1": "chair"}}, {"names": ["sofa", "chair"]}, {"x": {"categories": [
        {"id": 0, "name": "sofa"}, {"id": 1, "name": "chair"}]}}],
)  # fmt: skip
def test_names_of_class_numbers(names: object) -> None:
    assert class_names_in(names) == {0: "sofa", 1: "chair"}


def test_only_lists_of_objects_are_lists_of_objects() -> None:
    assert objects_of([{"a": 1}]) == [{"a": 1}]
    others: tuple[object, ...] = (None, {}, [], "text", [1], [{"a": 1}, None])
    for other in others:
        assert objects_of(other) == []


def test_sizes_are_two_sides_of_a_picture() -> None:
    assert size_of(640, 480.0) == (640, 480)
    for width, height in ((None, 480), ("640", 480), (1, 480), (True, 480), (1e9, 480), (float("nan"), 480)):
        assert size_of(width, height) is None
