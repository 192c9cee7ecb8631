"""Furniture whose back is about at a wall stands against it; what turns away or is far from it does not."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.layout.backs_to_walls import with_backs_to_walls
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.arrangement.noise import REASONED
from diorama_core.progress import Progress
from diorama_core.scene.types import Scene
from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.feasible.test_photo_observations import looking_north
from tests.layout.small_rooms import Room

LIBRARY = box_library()
WARDROBE = LIBRARY.in_category("wardrobe")[0]
FACING_SOUTH = -0.5 * np.pi
NORTH_WALL = "wall_2"
"""At y = 2.5 m; the camera looks at it."""


def standing(gap_m: float, turned_deg: float = 0.0, category: str = "wardrobe", **more: object) -> tuple[str, Scene]:
    """Something before the north wall, its back so far from it."""
    room = Room(LIBRARY)
    shape = LIBRARY.in_category(category)[0]
    y = 2.5 - gap_m - 0.5 * shape.size_m[0]
    yaw = FACING_SOUTH + np.deg2rad(turned_deg)
    name = room.put(shape.id, (0.3, y, 0.5 * shape.size_m[2]), yaw=yaw, **more)
    return name, room.scene(camera=looking_north(5.0))


def against(name: str, scene: Scene) -> tuple[str, ...]:
    edge = with_backs_to_walls(scene, REASONED).support_of(name)
    assert edge is not None
    return edge.adheres_to


@pytest.mark.parametrize("gap_m", [-0.15, 0.0, 0.3])
@pytest.mark.parametrize("turned_deg", [-12.0, 0.0, 20.0])
def test_a_back_about_at_a_wall_is_against_it(gap_m: float, turned_deg: float) -> None:
    assert against(*standing(gap_m, turned_deg)) == (NORTH_WALL,)


def test_what_would_stand_behind_a_wall_that_was_seen_is_against_it() -> None:
    assert against(*standing(-1.5)) == (NORTH_WALL,)


@pytest.mark.parametrize(
    ("gap_m", "turned_deg", "category"),
    [(1.5, 0.0, "wardrobe"), (0.1, 60.0, "wardrobe"), (0.1, 180.0, "wardrobe"), (0.1, 0.0, "chair")],
)
def test_what_is_far_or_turns_away_or_may_stand_free_is_left_alone(
    gap_m: float, turned_deg: float, category: str
) -> None:
    _, scene = standing(gap_m, turned_deg, category)
    assert with_backs_to_walls(scene, REASONED) == scene


def test_what_stands_against_a_wall_already_stays_as_it_is() -> None:
    _, scene = standing(0.1, adheres_to=("wall_1",))
    assert with_backs_to_walls(scene, REASONED) is scene
    assert with_backs_to_walls(Scene(), REASONED) == Scene()


def test_the_layout_turns_it_along_the_wall_and_closes_the_gap() -> None:
    name, scene = standing(0.25, 8.0)
    settled = FeasibleRecipe(LIBRARY).optimise(with_backs_to_walls(scene, REASONED), Progress())[0].object(name)
    assert settled.pose.R_world_object[1, 0] == pytest.approx(-1.0, abs=1e-3)
    assert settled.corners_world[:, 1].max() == pytest.approx(2.5, abs=0.01)
