"""What nothing reaches where it was seen stays there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.arrangement.out_of_reach import detach_out_of_reach
from diorama_core.arrangement.support_hypotheses import MEASURED, REASONED, ObservationNoise
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.progress import Progress
from diorama_core.scene.types import Scene
from tests.layout.feasible.test_photo_observations import LIBRARY, looking_north
from tests.layout.small_rooms import Room

BOX_PX = (300.0, 200.0, 320.0, 225.0)


def cup_by_the_wall(room: Room, gap_m: float, **more) -> tuple[Scene, str]:
    """A cup in the air before a wall on which the graph hangs it."""
    half = room.library.shape("cup_21").size_m[0] / 2
    at = (0.0, 2.5 - half - gap_m, 0.8)
    cup = room.put("cup_21", at, on="wall_2", relation="mounted on", yaw=-np.pi / 2, box_px=BOX_PX, **more)
    return room.scene(camera=looking_north()), cup


def stays_held(room: Room, name: str, noise: ObservationNoise = MEASURED) -> bool:
    """Whether an object keeps what holds it."""
    return detach_out_of_reach(room.scene(camera=looking_north()), LIBRARY, noise)[0].support_of(name) is not None


def test_a_cup_in_the_air_stays_where_it_was_measured(room: Room) -> None:
    scene, cup = cup_by_the_wall(room, 0.3)
    left, reasons = detach_out_of_reach(scene, LIBRARY, MEASURED)
    assert left.support_of(cup) is None
    assert "please check" in reasons[0]
    settled, report = FeasibleRecipe(LIBRARY, depth_measured=True).optimise(left, Progress())
    assert np.allclose(settled.object(cup).pose.position, scene.object(cup).pose.position, atol=1e-6)
    assert report.after["structure"] == 1.0


@pytest.mark.parametrize(("gap_m", "locked"), [(0.05, False), (0.3, True)])
def test_what_is_near_its_wall_or_locked_keeps_it(room: Room, gap_m: float, locked: bool) -> None:
    scene, _ = cup_by_the_wall(room, gap_m, locked=locked)
    assert detach_out_of_reach(scene, LIBRARY, MEASURED) == (scene, ())


def test_a_photo_alone_does_not_tell_how_far_from_a_wall_it_is(room: Room) -> None:
    scene, _ = cup_by_the_wall(room, 0.3)
    assert detach_out_of_reach(scene, LIBRARY, REASONED) == (scene, ())


@pytest.mark.parametrize(
    ("gap_m", "measured", "reasoned"), [(0.08, True, True), (0.2, False, True), (0.5, False, False)]
)
def test_heights_over_a_table_tell_more_where_they_were_measured(
    room: Room, gap_m: float, measured: bool, reasoned: bool
) -> None:
    table = room.put("table_0", (0.0, 1.0, 0.37))
    height = room.library.shape("cup_21").size_m[2]
    cup = room.put("cup_21", (0.0, 1.0, room.objects[0].size_m[2] + gap_m + height / 2), on=table)
    assert stays_held(room, cup) == measured
    assert stays_held(room, cup, REASONED) == reasoned


def test_what_was_measured_beside_a_table_is_not_on_it(room: Room) -> None:
    table = room.put("table_0", (0.0, 1.0, 0.37))
    depth, _, top = room.objects[0].size_m
    height = room.library.shape("cup_21").size_m[2]
    cup = room.put("cup_21", (depth / 2 + 0.1, 1.0, top + height / 2), on=table)
    assert not stays_held(room, cup)


def test_half_of_what_is_long_may_be_beside_a_table(room: Room) -> None:
    table = room.put("table_0", (0.0, 1.0, 0.37))
    depth, _, top = room.objects[0].size_m
    size = room.library.shape("books_18").size_m
    long = 0.6 / size[0]
    row = room.put("books_18", (depth / 2 + 0.1, 1.0, top + size[2] / 2), on=table, scale=(long, 1.0, 1.0))
    assert stays_held(room, row)


def test_a_plant_in_the_air_over_a_table_stays_there_and_one_over_the_floor_comes_down(room: Room) -> None:
    table = room.put("table_0", (0.0, 1.0, 0.37))
    above = room.put("cup_21", (0.0, 1.0, 1.6), on=table, box_px=BOX_PX)
    low = room.put("cup_21", (1.5, 1.0, 0.8), on="floor", box_px=BOX_PX)
    scene = room.scene(camera=looking_north())
    potted = tuple(replace(o, category="plant") if o.id in (above, low) else o for o in scene.objects)
    left, _ = detach_out_of_reach(replace(scene, objects=potted), LIBRARY, MEASURED)
    assert left.support_of(above) is None
    assert left.support_of(low) is not None
    settled, _ = FeasibleRecipe(LIBRARY, depth_measured=True).optimise(left, Progress())
    assert np.allclose(settled.object(above).pose.position, left.object(above).pose.position, atol=1e-6)
    assert settled.object(low).corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)


def test_furniture_keeps_its_floor(room: Room) -> None:
    room.put("table_0", (0.0, 1.0, 0.9))
    scene = room.scene(camera=looking_north())
    assert detach_out_of_reach(scene, LIBRARY, MEASURED) == (scene, ())


def test_a_wall_lamp_that_was_measured_beside_a_table_is_not_on_it(room: Room) -> None:
    table = room.put("table_0", (0.0, 1.0, 0.37))
    depth, _, top = room.objects[0].size_m
    lamp = room.put("cup_21", (depth / 2 + 0.6, 1.0, top + 0.1), on=table, box_px=BOX_PX)
    room.objects[1] = replace(room.objects[1], category="wall lamp")
    assert not stays_held(room, lamp)


@pytest.mark.parametrize(
    ("gap_m", "yaw", "stays"),
    [(0.1, -np.pi / 2, True), (0.1, -np.pi / 2 + 0.5, True), (0.1, np.pi, False), (1.0, -np.pi / 2, False)],
)
def test_a_picture_that_was_measured_turned_from_its_wall_or_far_from_it_hangs_on_another_one(
    room: Room, gap_m: float, yaw: float, stays: bool
) -> None:
    picture = room.put("picture_13", (0.5, 2.5 - gap_m, 1.5), on="wall_2", relation="mounted on", yaw=yaw)
    assert stays_held(room, picture) == stays
    scene = room.scene(camera=looking_north())
    assert detach_out_of_reach(scene, LIBRARY, REASONED) == (scene, ())


@pytest.mark.parametrize(("beside_m", "gap_m", "reached"), [(0.05, 0.0, True), (0.0, 0.1, True), (0.05, 0.1, False)])
def test_what_is_measured_both_beside_and_above_a_place_is_farther_from_it(
    room: Room, beside_m: float, gap_m: float, reached: bool
) -> None:
    table = room.put("table_0", (0.0, 1.0, 0.37))
    size, height = room.objects[0].size_m, room.library.shape("cup_21").size_m[2]
    at = (size[0] / 2 + beside_m, 1.0, size[2] + gap_m + height / 2)
    cup = room.put("cup_21", at, on=table)
    scene = room.scene(camera=looking_north())
    assert (detach_out_of_reach(scene, LIBRARY, MEASURED)[0].support_of(cup) is not None) == reached
