"""Colliding objects end before one another where moving them would change more of the picture."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.layout.feasible.recipe import MEASURED_WEIGHT, FeasibleRecipe
from diorama_core.progress import Progress
from diorama_core.scene.types import Scene
from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.feasible.test_photo_observations import looking_north
from tests.layout.small_rooms import Room

LIBRARY = box_library()


def in_a_row(room: Room, overlap_m: float, load_x: float | None = None) -> tuple[Scene, Scene]:
    """Two cabinets a metre wide whose ends reach into one another, perhaps with a cup; before and after."""
    at = 0.5 - overlap_m / 2
    left = room.put("cabinet_10", (-at, 0.5, 0.4), yaw=-np.pi / 2, id="left")
    room.put("cabinet_10", (at, 0.5, 0.4), yaw=-np.pi / 2, id="right", confidence=0.9)
    top = room.objects[0].size_m[2]
    if load_x is not None:
        room.put("cup_21", (load_x, 0.5, top + 0.05), on=left, id="cup")
    scene = room.scene(camera=looking_north(3.5))
    recipe = FeasibleRecipe(LIBRARY, depth_measured=True, depth_weight=MEASURED_WEIGHT)
    settled, report = recipe.optimise(scene, Progress())
    assert report.after["part_overlap_m"] == 0.0
    return scene, settled


def ends(scene: Scene, name: str) -> tuple[float, float]:
    x = scene.object(name).corners_world[:, 0]
    return float(x.min()), float(x.max())


def test_one_of_two_in_a_row_becomes_shorter_and_outer_ends_stay(room: Room) -> None:
    before, after = in_a_row(room, 0.15)
    assert ends(after, "left")[0] == pytest.approx(ends(before, "left")[0], abs=0.01)
    assert ends(after, "right")[1] == pytest.approx(ends(before, "right")[1], abs=0.01)
    lengths = [ends(after, n)[1] - ends(after, n)[0] for n in ("left", "right")]
    assert min(lengths) < 0.9
    assert max(lengths) == pytest.approx(1.0, abs=0.02)


def test_what_stands_at_an_end_keeps_its_place(room: Room) -> None:
    before, after = in_a_row(room, 0.15, load_x=-0.05)
    moved = after.object("cup").pose.position - before.object("cup").pose.position
    assert np.linalg.norm(moved[:2]) < 0.02
    low, high = ends(after, "left")
    cup = ends(after, "cup")
    assert low <= cup[0]
    assert cup[1] <= high
    assert ends(after, "right")[1] - ends(after, "right")[0] < 0.9


def test_apart_nothing_becomes_shorter(room: Room) -> None:
    before, after = in_a_row(room, -0.02)
    for name in ("left", "right"):
        np.testing.assert_allclose(after.object(name).pose.scale, before.object(name).pose.scale)
