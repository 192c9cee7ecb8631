"""Structure leaves the picture as it is where a photo alone gave distances."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.settings import LAYOUT
from diorama_core.progress import Progress
from diorama_core.scene.types import Architecture, Plane, Scene
from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.feasible.test_photo_observations import boxed, looking_north, outline
from tests.layout.small_rooms import Room

LIBRARY = box_library()


@pytest.mark.parametrize(("above_m", "farther"), [(0.12, True), (-0.15, False)])
def test_what_is_seen_off_its_table_changes_distance_and_size_and_looks_the_same(room: Room, above_m, farther):
    table = room.put("table_0", (0.0, 0.6, 0.37))
    vase = room.put("vase_20", (0.0, 0.5, 0.74 + above_m + 0.14), on=table)
    scene = room.scene(camera=looking_north())
    settled = FeasibleRecipe(LIBRARY, sizes_reasoned=True).optimise(scene, Progress())[0]
    before, after = scene.object(vase), settled.object(vase)
    assert after.corners_world[:, 2].min() == pytest.approx(0.74, abs=1e-3)
    np.testing.assert_allclose(outline(settled, vase), outline(scene, vase), atol=2.0)
    grown = after.pose.scale / before.pose.scale
    assert ((grown > 1.05) if farther else (grown < 0.95)).all()
    assert (grown < LAYOUT.max_growth).all()


def test_sizes_stay_within_limits_where_they_were_not_reasoned(room: Room):
    table = room.put("table_0", (0.0, 0.6, 0.37))
    vase = room.put("vase_20", (0.0, 0.5, 0.74 + 0.3 + 0.14), on=table)
    scene = room.scene(camera=looking_north())
    settled = FeasibleRecipe(LIBRARY).optimise(scene, Progress())[0]
    assert (settled.object(vase).pose.scale <= LAYOUT.max_stretch + 1e-9).all()


def through_the_wall(room: Room, *, x: float = 0.0, load_m: float | None = None) -> tuple[Scene, Scene, str]:
    """A bookshelf whose back was measured 6 cm behind a wall 2 m long, perhaps with books before its front; settled."""
    floor = np.array([[-3.0, -2.5, 0], [3.0, -2.5, 0], [3.0, 2.7, 0], [-3.0, 2.7, 0]])
    wall = np.array([[-1.0, 2.5, 0], [1.0, 2.5, 0], [1.0, 2.5, 2.5], [-1.0, 2.5, 2.5]])
    planes = Architecture((Plane("floor", "floor", floor), Plane("wall_1", "wall", wall)))
    depth = LIBRARY.shape("bookshelf_6").size_m[0]
    shelf = room.put("bookshelf_6", (x, 2.5 - depth / 2 + 0.06, 0.9), yaw=-np.pi / 2)
    if load_m is not None:
        front = 2.5 - depth + 0.06
        size = LIBRARY.shape("books_18").size_m
        room.put("books_18", (x, front + size[0] / 2 - load_m, 1.3), on=shelf, yaw=-np.pi / 2)
    scene = boxed(room.scene(camera=looking_north(5.0), architecture=planes))
    recipe = FeasibleRecipe(LIBRARY, depth_measured=True, depth_weight=1.0)
    return scene, recipe.optimise(scene, Progress())[0], shelf


@pytest.mark.parametrize("x", [0.0, 1.1], ids=["before the wall", "beyond its end"])
def test_what_reaches_through_a_wall_becomes_shorter_and_its_front_stays(room: Room, x: float) -> None:
    before, after, shelf = through_the_wall(room, x=x)
    front = float(before.object(shelf).corners_world[:, 1].min())
    corners = after.object(shelf).corners_world[:, 1]
    assert corners.max() <= 2.5 + 1e-6
    assert corners.min() == pytest.approx(front, abs=0.01)


def test_what_was_seen_before_its_front_brings_a_shelf_forward(room: Room) -> None:
    before, after, shelf = through_the_wall(room, load_m=0.06)
    assert after.object(shelf).corners_world[:, 1].max() <= 2.5 + 1e-6
    moved = after.object(shelf).corners_world[:, 1].min() - before.object(shelf).corners_world[:, 1].min()
    assert moved < -0.03
