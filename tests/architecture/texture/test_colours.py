from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.architecture.texture.colours import colour_planes, visible_planes
from diorama_core.artefacts import DetectedObject
from tests.synthetic_rooms import box_room, look

CAMERA = look(0.0, 0.0, fov_deg=70.0, size=(320, 240))
ROOM = box_room(-2.0, 2.0, 4.0, 2.6)
GREY, GREEN = (150, 150, 155), (70, 90, 40)


def _door(mask_confidence: float) -> tuple[np.ndarray, DetectedObject]:
    """A photo of grey walls with a green door whose guessed outline leaves out its frame."""
    rgb = np.full((240, 320, 3), GREY, np.uint8)
    rgb[20:215, 60:260] = GREEN
    mask = np.zeros((240, 320), dtype=bool)
    mask[60:150, 130:190] = True
    door = DetectedObject("door", "door", "door", (60, 20, 260, 215), mask, 1, 1.0)
    return rgb, replace(door, mask_confidence=mask_confidence)


@pytest.mark.parametrize(("sure", "expected"), [(0.5, GREY), (1.0, GREEN)])
def test_walls_are_coloured_by_what_is_in_no_doubtful_box(sure: float, expected: tuple[int, int, int]) -> None:
    rgb, door = _door(sure)
    back = next(p for p in colour_planes(ROOM, rgb, CAMERA, (door,)) if p.role == "wall" and p.normal[1] < -0.9)
    np.testing.assert_allclose(back.colour, np.array(expected) / 255, atol=0.03)


def test_a_wall_that_is_only_seen_in_boxes_has_the_colour_seen_there() -> None:
    rgb, door = _door(0.5)
    everywhere = replace(door, box=(0, 0, 320, 240))
    back = next(p for p in colour_planes(ROOM, rgb, CAMERA, (everywhere,)) if p.role == "wall" and p.normal[1] < -0.9)
    np.testing.assert_allclose(back.colour, np.array(GREEN) / 255, atol=0.03)


@pytest.mark.parametrize(("covered", "expected"), [(0.95, GREY), (0.5, GREEN)])
def test_a_wall_behind_windows_and_shelves_has_the_colour_of_the_wall_that_is_seen_best(
    covered: float, expected: tuple[int, int, int]
) -> None:
    """The left wall is green where it is unhidden: a view out of a window's rest, or its paint."""
    left = next(k for k, p in enumerate(ROOM) if p.role == "wall" and p.normal[0] > 0.9)
    shown = visible_planes(ROOM, CAMERA, 1) == left
    rgb = np.full((240, 320, 3), GREY, np.uint8)
    rgb[shown] = GREEN
    mask = shown.copy()
    mask[int(covered * 240) :] = False
    shelf = DetectedObject("shelf", "bookshelf", "bookshelf", (0, 0, 90, 240), mask, 1, 1.0)
    walls = colour_planes(ROOM, rgb, CAMERA, (replace(shelf, mask_confidence=1.0),))
    np.testing.assert_allclose(walls[left].colour, np.array(expected) / 255, atol=0.03)
