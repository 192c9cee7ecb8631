from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import DetectedObject
from diorama_core.library.taxonomy import category
from diorama_core.perception.measured.boxes import TurnedExtent
from diorama_core.perception.measured.supports import resting_heights, rim_occlusion, supports_of_boxes
from diorama_core.scene.types import Camera, Intrinsics, Support
from tests.perception.measured.test_stage import CATEGORIES, EDGES, EXTENTS, at
from tests.synthetic_rooms import look

CAMERA = Camera(Intrinsics(320, 240, 260.0, 260.0, 160.0, 120.0), look(0, 10, 1.5, 60, (320, 240)).T_world_camera)


def detected(extents: dict[str, TurnedExtent], camera: Camera = CAMERA) -> tuple[DetectedObject, ...]:
    """Each object with the box in the picture that its measured box fills."""
    objects = []
    for n, (key, extent) in enumerate(extents.items(), start=1):
        corners = np.array([[x, y, z] for x in _ends(extent, 0) for y in _ends(extent, 1) for z in _ends(extent, 2)])
        pixels = camera.project(corners)
        x1, y1, x2, y2 = (float(v) for v in (*pixels.min(axis=0), *pixels.max(axis=0)))
        mask = np.zeros((240, 320), dtype=bool)
        mask[max(int(y1), 0) : max(int(y2), 0), max(int(x1), 0) : max(int(x2), 0)] = True
        objects.append(DetectedObject(key, key, key, (x1, y1, x2, y2), mask, n, 1.0))
    return tuple(objects)


def _ends(extent: TurnedExtent, axis: int) -> tuple[float, float]:
    return float(extent.low[axis]), float(extent.high[axis])


def found(**changed: TurnedExtent) -> dict[str, Support]:
    extents = EXTENTS | changed
    names = CATEGORIES | {key: category(key) for key in changed if key not in CATEGORIES}
    return {s.child: s for s in supports_of_boxes(detected(extents), extents, names, np.zeros((240, 320)))}


def test_every_object_is_held_by_what_it_touches() -> None:
    assert set(found().values()) == set(EDGES)


def test_far_beside_a_table_nothing_rests_on_it() -> None:
    assert found(lamp=at(1.6, 0.8, (0.3, 0.3, 0.5)))["lamp"].parent != "table"


def test_what_stands_within_shelves_is_theirs() -> None:
    shelf, books = at(1.0, 0.0, (0.8, 0.8, 1.8)), at(1.0, 0.95, (0.2, 0.4, 0.25))
    assert found(bookshelf=shelf, books=books)["books"].parent == "bookshelf"


def test_what_people_put_on_furniture_that_nobody_marked_hangs_on_no_wall() -> None:
    assert found(cup=at(5.0, 0.9, (0.1, 0.1, 0.1)))["cup"].parent == "floor"


def test_a_lower_end_that_is_seen_in_the_air_does_not_stand_on_the_floor() -> None:
    assert found(chair=at(-1.0, 1.2, (0.5, 0.5, 0.9)))["chair"].parent == "wall"


def test_what_is_nearer_below_an_object_hides_its_end() -> None:
    mask = np.zeros((100, 100), dtype=bool)
    mask[20:60, 30:70] = True
    depth = np.where(mask, 3.0, 5.0)
    assert rim_occlusion(mask, depth) == 0.0
    depth[60:, :50] = 2.0
    assert rim_occlusion(mask, depth) == pytest.approx(0.5)
    mask[60:] = mask[59]
    assert rim_occlusion(mask, depth) == 1.0, "the picture ends there"


def test_however_boxes_lie_nothing_holds_itself_up() -> None:
    edges = found(table=at(0.2, 0.9, (0.9, 1.6, 0.75)))
    for key in edges:
        trail = [key]
        while trail[-1] in edges:
            trail.append(edges[trail[-1]].parent)
            assert len(trail) <= len(edges) + 1, trail


def test_a_picture_that_stands_on_the_floor_is_still_the_walls() -> None:
    assert found(picture=at(-2.0, 0.0, (0.05, 0.6, 0.5)))["picture"].parent == "wall"


def test_objects_lie_on_tops_seats_and_boards() -> None:
    sofa = CATEGORIES["sofa"]
    assert resting_heights(EXTENTS["sofa"], sofa, 0.0) == pytest.approx([0.9, sofa.seat_height_m])
    assert resting_heights(at(0, 0, (0.9, 2, 0.3)), sofa, 0.0) == pytest.approx([0.3])
    assert resting_heights(at(0, 0, (0.3, 1, 1.8)), category("bookshelf"), 0.7) == pytest.approx([1.8, 0.7])
