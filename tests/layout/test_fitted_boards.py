from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.layout.fitted_boards import fitted_boards, is_adjustable
from diorama_core.library.boards import BOARD_SHARE, base_id, levels_m
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Pose, Scene, SceneObject, Support
from diorama_core.synthesis.layout_rooms import box_library, room_box
from tests.layout.feasible.test_photo_observations import looking_north

LIBRARY = built_in_library()
SHELF = LIBRARY.shape("bookshelf-oak-four")
BOOKS = next(s for s in LIBRARY.in_category("books") if s.size_m[2] < 0.3)


def shelf_with_books(*feet_m: float, nearer: float = 1.0, **more) -> Scene:
    """The shelf two metres ahead, its front to the camera, and books whose feet were seen at heights."""
    height = SHELF.size_m[2]
    shelf = SceneObject(
        "shelf", "shelf", "bookshelf", SHELF.id, SHELF.size_m,
        Pose.upright((0.0, 2.0, height / 2), -np.pi / 2), **more,
    )  # fmt: skip
    camera = looking_north()
    eye, objects, edges = camera.position, [shelf], [Support("shelf", "floor")]
    for k, foot in enumerate(feet_m):
        seen = eye + nearer * (np.array([0.0, 2.0, foot + BOOKS.size_m[2] / 2]) - eye)
        pose = Pose.upright(tuple(seen), 0.0, (nearer,) * 3)
        objects.append(SceneObject(f"books_{k}", f"books {k}", "books", BOOKS.id, BOOKS.size_m, pose))
        edges.append(Support(f"books_{k}", "shelf"))
    return Scene(architecture=room_box(6.0, 8.0), objects=tuple(objects), supports=tuple(edges), camera=camera)


def boards_m(scene: Scene) -> np.ndarray:
    shape = LIBRARY.shape(scene.object("shelf").shape_id)
    return np.array(levels_m(shape)) + shape.size_m[2] / 2


def test_boards_come_to_the_feet_of_their_loads() -> None:
    scene = shelf_with_books(0.55, 0.99)
    changed, reasons = fitted_boards(scene, LIBRARY, reasoned=False)
    for foot in (0.55, 0.99):
        assert np.abs(boards_m(changed) - foot).min() < 0.01
    assert base_id(changed.object("shelf").shape_id) == SHELF.id
    assert changed.object("shelf").pose == scene.object("shelf").pose
    assert len(reasons) == 1
    assert fitted_boards(changed, LIBRARY, reasoned=False) == (changed, ())


@pytest.mark.parametrize("feet_m", [(), (0.469,), (0.475, 1.223), (1.62,)])
def test_boards_that_agree_stay(feet_m: tuple[float, ...]) -> None:
    scene = shelf_with_books(*feet_m)
    assert fitted_boards(scene, LIBRARY, reasoned=False) == (scene, ())


def test_a_photo_alone_tells_heights_along_the_line_of_sight() -> None:
    scene = shelf_with_books(0.55, nearer=0.8)
    changed, _ = fitted_boards(scene, LIBRARY, reasoned=True)
    assert np.abs(boards_m(changed) - 0.55).min() < 0.01


def test_what_is_locked_or_soft_or_no_bookcase_changes_nothing() -> None:
    scene = shelf_with_books(0.55, locked=True)
    assert fitted_boards(scene, LIBRARY, reasoned=False) == (scene, ())
    table = next(s for s in LIBRARY.in_category("table"))
    assert not is_adjustable(replace(scene.objects[0], category="table"), LIBRARY.shape(table.id))
    boxes = box_library()
    assert not is_adjustable(scene.objects[0], boxes.shape("bookshelf_6"))


def test_a_desk_below_its_hutch_is_as_high_as_its_loads_say() -> None:
    hutch = next(s for r in LIBRARY.in_category("desk") if len(levels_m(s := LIBRARY.shape(r.id))) > 2)
    desk = replace(shelf_with_books().objects[0], category="desk", shape_id=hutch.id, shape_size_m=hutch.size_m)
    assert is_adjustable(desk, hutch)
    single = next(s for r in LIBRARY.in_category("desk") if len(levels_m(s := LIBRARY.shape(r.id))) == 1)
    assert not is_adjustable(replace(desk, shape_id=single.id, shape_size_m=single.size_m), single)
    assert not is_adjustable(replace(desk, category="sofa"), hutch)


def test_boards_that_lie_on_one_another_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    low, *higher = SHELF.surfaces
    twice = replace(low, polygon=low.polygon + np.array([0.0, 0.0, 0.5 * BOARD_SHARE * SHELF.size_m[2]]))
    crowded = replace(SHELF, surfaces=(low, twice, *higher))
    assert len(levels_m(crowded)) == len(levels_m(SHELF)) + 1
    monkeypatch.setattr(type(LIBRARY), "shape", lambda library, shape_id: crowded)
    scene = shelf_with_books(0.55)
    assert fitted_boards(scene, LIBRARY, reasoned=False) == (scene, ())
