from __future__ import annotations

from dataclasses import replace

import pytest

from diorama_core.layout.holding_shapes import holding_shapes
from diorama_core.arrangement.noise import MEASURED, REASONED
from diorama_core.scene.types import Candidate, Pose, Scene
from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.feasible.test_photo_observations import looking_north
from tests.layout.small_rooms import Room

LIBRARY = box_library()
TALL, LOW = "bookshelf_6", "bookshelf_7"
"""Boards at 0.02, 0.47, 0.91, 1.35 and 1.8 m; those of the other, equally high, at 0.03, 0.62, 1.22 and 1.8 m."""


def candidate(shape_id: str, score: float) -> Candidate:
    size = LIBRARY.shape(shape_id).size_m
    return Candidate(shape_id, size, score, Pose.upright((0.0, 1.0, 0.9), 0.0, (1.0, 0.9 / size[1], 1.8 / size[2])))


def shelf_with_books(room: Room, board_m: float, scores: tuple[float, float] = (0.4, 0.3), **more) -> Scene:
    """A shelf retrieved as the tall one, and books whose feet were seen at a height."""
    candidates = (candidate(TALL, scores[0]), candidate(LOW, scores[1]))
    shelf = room.put(TALL, (0.0, 1.0, 0.9), candidates=candidates, **more)
    room.put("books_18", (0.0, 0.9, board_m + 0.12), on=shelf)
    return room.scene(camera=looking_north())


def test_a_shelf_takes_the_shape_that_has_a_board_under_its_books(room: Room) -> None:
    scene = shelf_with_books(room, 0.62)
    shelf, books = scene.objects
    changed, reasons = holding_shapes(scene, LIBRARY, MEASURED)
    assert changed.object(shelf.id).shape_id == LOW
    assert changed.object(shelf.id).pose == shelf.candidates[1].pose
    assert changed.object(books.id) == books
    assert len(reasons) == 1
    assert books.label in reasons[0]


@pytest.mark.parametrize("board_m", [0.47, 0.5])
def test_a_shelf_that_agrees_within_the_noise_stays(room: Room, board_m: float) -> None:
    scene = shelf_with_books(room, board_m)
    assert holding_shapes(scene, LIBRARY, MEASURED) == (scene, ())


def test_what_the_picture_says_plainly_outweighs_one_load(room: Room) -> None:
    scene = shelf_with_books(room, 0.62, scores=(0.9, 0.001))
    assert holding_shapes(scene, LIBRARY, REASONED) == (scene, ())


def test_a_locked_shelf_stays(room: Room) -> None:
    scene = shelf_with_books(room, 0.62, locked=True)
    assert holding_shapes(scene, LIBRARY, MEASURED) == (scene, ())


def test_shelves_of_one_shape_stay_of_one_shape(room: Room) -> None:
    scene = shelf_with_books(room, 0.62)
    twin = replace(scene.objects[0], id="twin", label="twin", pose=Pose.upright((2.0, 1.0, 0.9)))
    changed, _ = holding_shapes(replace(scene, objects=(*scene.objects, twin)), LIBRARY, MEASURED)
    assert {changed.object(twin.id).shape_id, changed.objects[0].shape_id} == {LOW}
