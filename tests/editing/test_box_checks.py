from __future__ import annotations

from diorama_core.artefacts import LabelledBox
from diorama_core.editing.box_checks import merge_boxes, too_tall


def _box(kind: str, x: float, y: float, width: float, height: float) -> LabelledBox:
    return LabelledBox((x, y, x + width, y + height), kind, kind)


def test_proposals_of_one_object_are_one() -> None:
    shelf, piece = _box("bookshelf", 100, 50, 200, 400), _box("shelves", 100, 60, 195, 180)
    again = _box("wardrobe", 104, 48, 204, 398)
    assert merge_boxes([shelf, piece, again]) == (shelf,)


def test_what_stands_before_another_thing_is_kept() -> None:
    sofa, pillow = _box("sofa", 100, 200, 400, 150), _box("pillow", 150, 210, 60, 50)
    near, far = _box("chair", 50, 200, 150, 250), _box("chair", 90, 210, 60, 90)
    assert merge_boxes([sofa, pillow]) == (sofa, pillow)
    assert merge_boxes([near, far]) == (near, far)


def test_a_chair_taller_than_a_door_that_stands_nearer_is_told() -> None:
    door, sofa = _box("door", 20, 100, 90, 210), _box("sofa", 300, 230, 200, 90)
    chair = _box("chair", 200, 10, 100, 290)
    (found,) = too_tall([door, sofa, chair])
    assert found[0] == 2
    assert found[1] > 1.6


def test_what_is_large_because_it_is_near_is_not_told() -> None:
    door, chair = _box("door", 20, 100, 90, 210), _box("chair", 200, 150, 200, 290)
    assert too_tall([door, chair]) == ()
    assert too_tall([chair]) == ()
