from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.architecture.room_extent import containing_room, without_floor_behind_walls
from diorama_core.evaluation.metrics.scene import out_of_bounds_share
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.progress import Progress
from diorama_core.scene.types import Architecture, Plane, Scene
from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.feasible.test_photo_observations import looking_north
from tests.layout.small_rooms import Room

LIBRARY = box_library()


def sliver(confidence: float = 0.95) -> Architecture:
    """A bedroom of which one wall and a strip of floor before it were found."""
    floor = np.array([[-1.0, 1.6, 0], [1.0, 1.6, 0], [1.0, 2.5, 0], [-1.0, 2.5, 0]], dtype=float)
    wall = np.array([[-1.0, 2.5, 0], [1.0, 2.5, 0], [1.0, 2.5, 2.5], [-1.0, 2.5, 2.5]])
    return Architecture((Plane("floor", "floor", floor), Plane("wall_1", "wall", wall, confidence=confidence)))


def test_a_bed_on_a_sliver_of_floor_stays_where_it_was_seen() -> None:
    room = Room(LIBRARY)
    bed = room.put("sofa_9", (-0.9, 0.2, 0.43))
    box = room.put("box_24", (2.0, -1.0, 0.15))
    scene = containing_room(room.scene(architecture=sliver(), camera=looking_north(5.0)))
    settled = FeasibleRecipe(LIBRARY).optimise(scene, Progress())[0]
    for name in (bed, box):
        assert np.linalg.norm(settled.object(name).pose.position - scene.object(name).pose.position) < 0.03
    assert out_of_bounds_share(settled) == 0.0


def test_an_assumed_wall_gives_way_and_a_seen_one_does_not() -> None:
    room = Room(LIBRARY)
    box = room.put("box_24", (0.0, 2.4, 0.15))
    for confidence, moves in ((0.15, False), (0.95, True)):
        scene = containing_room(room.scene(architecture=sliver(confidence), camera=looking_north(5.0)))
        settled = FeasibleRecipe(LIBRARY).optimise(scene, Progress())[0]
        moved = np.linalg.norm(settled.object(box).pose.position - scene.object(box).pose.position) > 0.03
        assert moved == moves
        behind = float((settled.object(box).corners_world @ scene.plane("wall_1").normal).min())
        assert behind >= scene.plane("wall_1").offset - 1e-6


def test_with_measured_depth_a_wall_that_has_something_behind_it_pushes_nothing() -> None:
    room = Room(LIBRARY)
    room.put("box_24", (0.0, 2.7, 0.15))
    room.put("box_24", (1.6, 2.7, 0.15))  # beside its end
    observed = room.scene(architecture=sliver(0.95), camera=looking_north(5.0))
    for reasoned in (False, True):
        scene = containing_room(observed, objects_measured=not reasoned)
        assert scene.plane("wall_1").is_seen == reasoned
    measured = containing_room(observed)
    settled = FeasibleRecipe(LIBRARY, depth_measured=True).optimise(measured, Progress())[0]
    for item in measured.objects:
        assert np.linalg.norm(settled.object(item.id).pose.position - item.pose.position) < 0.02
    beside = replace(observed, objects=observed.objects[1:], supports=observed.supports[1:])
    assert containing_room(beside).plane("wall_1").is_seen


def test_a_room_that_contains_everything_is_left_alone() -> None:
    room = Room(LIBRARY)
    room.put("box_24", (0.0, 2.0, 0.15))
    scene = room.scene(camera=looking_north(5.0))
    assert containing_room(scene) is scene
    assert containing_room(Scene()) == Scene()


@settings(max_examples=20)
@given(st.lists(st.tuples(st.floats(-3, 3), st.floats(-4, 2), st.floats(-3, 3)), min_size=1, max_size=6))
def test_the_floor_reaches_under_everything(places: list[tuple[float, float, float]]) -> None:
    room = Room(LIBRARY)
    for x, y, yaw in places:
        room.put("box_24", (x, y, 0.15), yaw=yaw)
    scene = room.scene(architecture=replace(sliver(), planes=sliver().planes[:1]))
    assert out_of_bounds_share(containing_room(scene)) == 0.0


def test_lamps_hang_from_a_ceiling_that_was_not_seen() -> None:
    room = Room(LIBRARY)
    lamp = room.put("lamp_16", (0.0, 0.5, 1.9), on="wall_1", relation="mounted on")
    room.objects[0] = replace(room.objects[0], category="ceiling lamp")
    scene = containing_room(room.scene(architecture=sliver(), camera=looking_north(5.0)))
    (ceiling,) = scene.architecture.by_role("ceiling")
    assert not ceiling.is_seen
    assert ceiling.normal[2] < -0.99
    assert scene.support_of(lamp).parent == ceiling.id
    level = float(ceiling.polygon[0, 2])
    assert scene.object(lamp).corners_world[:, 2].max() <= level <= scene.plane("wall_1").polygon[:, 2].max() + 1e-9
    settled = FeasibleRecipe(LIBRARY, depth_weight=1.0).optimise(scene, Progress())[0]
    moved = settled.object(lamp).pose.position - scene.object(lamp).pose.position
    assert np.linalg.norm(moved[:2]) < 0.1
    assert settled.object(lamp).corners_world[:, 2].max() == pytest.approx(level, abs=1e-6)


def test_without_hanging_lamps_no_ceiling_is_made() -> None:
    room = Room(LIBRARY)
    room.put("lamp_16", (0.0, 0.5, 0.25))
    scene = containing_room(room.scene(architecture=sliver(), camera=looking_north(5.0)))
    assert not scene.architecture.by_role("ceiling")


def test_a_wall_is_drawn_out_behind_what_hangs_on_it() -> None:
    room = Room(LIBRARY)
    picture = room.put("picture_13", (1.2, 2.48, 1.5), on="wall_1", relation="mounted on", yaw=-np.pi / 2)
    scene = containing_room(room.scene(architecture=sliver(), camera=looking_north(5.0)))
    wall = scene.plane("wall_1").polygon
    assert wall[:, 0].max() >= scene.object(picture).corners_world[:, 0].max()
    assert wall[:, 0].min() == -1.0
    settled = FeasibleRecipe(LIBRARY).optimise(scene, Progress())[0]
    assert np.linalg.norm(settled.object(picture).pose.position - scene.object(picture).pose.position) < 0.03


def test_a_wall_ends_at_the_corner_with_another_that_was_seen() -> None:
    room = Room(LIBRARY)
    room.put("picture_13", (1.2, 2.48, 1.5), on="wall_1", relation="mounted on", yaw=-np.pi / 2)
    corner = np.array([[1.0, 2.5, 0], [1.0, 0.0, 0], [1.0, 0.0, 2.5], [1.0, 2.5, 2.5]])
    planes = (*sliver().planes, Plane("wall_2", "wall", corner))
    scene = containing_room(room.scene(architecture=Architecture(planes), camera=looking_north(5.0)))
    assert scene.plane("wall_1").polygon[:, 0].max() == 1.0


@pytest.mark.parametrize("confidence", [0.15, 0.95])
def test_an_assumed_wall_is_where_the_back_of_what_hangs_on_it_was_seen(confidence: float) -> None:
    room = Room(LIBRARY)
    mirror = room.put("box_24", (0.0, 2.15, 1.5), on="wall_1", relation="mounted on")
    scene = room.scene(architecture=sliver(confidence), camera=looking_north(5.0))
    back = float(scene.object(mirror).corners_world[:, 1].max())
    found = containing_room(scene)
    assert found.plane("wall_1").offset == pytest.approx(-back if confidence < 0.5 else -2.5)
    assert found.object(mirror) == scene.object(mirror)


def test_what_stands_behind_a_hanging_thing_decides_where_an_assumed_wall_is() -> None:
    room = Room(LIBRARY)
    room.put("box_24", (0.0, 2.0, 1.5), on="wall_1", relation="mounted on")
    box = room.put("box_24", (0.5, 2.4, 0.15))
    found = containing_room(room.scene(architecture=sliver(0.15), camera=looking_north(5.0)))
    behind = float(found.object(box).corners_world[:, 1].max())
    assert -found.plane("wall_1").offset == pytest.approx(behind + 0.01)


def standing_against_the_wall(*gaps_m: float, before_m: float | None = None) -> tuple[Room, Scene]:
    """Boxes whose backs were seen so far before the wall that they stand against, and one that only stands there."""
    room = Room(LIBRARY)
    half = LIBRARY.shape("box_24").size_m[0] / 2
    for k, gap in enumerate(gaps_m):
        room.put("box_24", (-0.7 + 0.5 * k, 2.5 - half - gap, 0.15), yaw=-np.pi / 2, adheres_to=("wall_1",))
    if before_m is not None:
        room.put("box_24", (0.75, 2.5 - half - before_m, 0.15), yaw=-np.pi / 2)
    return room, room.scene(architecture=sliver(), camera=looking_north(5.0))


def by_photo(scene: Scene, feet_seen: Collection[str] | None = None) -> Scene:
    """The room around objects whose places a photo alone tells."""
    return containing_room(scene, objects_measured=False, walls_reasoned=True, feet_seen=feet_seen)


def wall_y(scene: Scene) -> float:
    return float(scene.plane("wall_1").polygon[:, 1].mean())


def test_from_a_photo_alone_a_wall_comes_to_what_stands_against_it() -> None:
    _, scene = standing_against_the_wall(0.3, 0.3)
    near = by_photo(scene)
    assert wall_y(near) == pytest.approx(2.5 - 0.3, abs=0.02)
    assert wall_y(containing_room(scene)) == pytest.approx(2.5)
    assert near.objects == scene.objects
    settled = FeasibleRecipe(LIBRARY, sizes_reasoned=True).optimise(near, Progress())[0]
    for item in scene.objects:
        assert np.linalg.norm(settled.object(item.id).pose.position - item.pose.position) < 0.03


def test_a_wall_goes_outward_too_and_follows_most_of_what_stands_against_it() -> None:
    assert wall_y(by_photo(standing_against_the_wall(-0.2, -0.2)[1])) > 2.6
    assert wall_y(by_photo(standing_against_the_wall(0.1, 0.1, 0.4)[1])) == pytest.approx(2.4, abs=0.02)


def test_a_wall_does_not_come_past_what_stands_before_it() -> None:
    _, scene = standing_against_the_wall(0.3, before_m=0.1)
    assert wall_y(by_photo(scene)) > 2.5 - 0.3 + 0.1


def test_a_wall_without_anything_against_it_stays() -> None:
    _, scene = standing_against_the_wall(before_m=0.1)
    assert wall_y(by_photo(scene)) == pytest.approx(2.5)


def test_from_a_photo_alone_a_wall_is_at_the_foot_of_its_door() -> None:
    room = Room(LIBRARY)
    half = LIBRARY.shape("wardrobe_12").size_m[0] / 2
    room.put("wardrobe_12", (0.0, 2.2 - half, 1.1), yaw=-np.pi / 2, on="wall_1", relation="mounted on")
    scene = room.scene(architecture=sliver(), camera=looking_north(5.0))
    assert wall_y(by_photo(scene)) == pytest.approx(2.5)
    scene = replace(scene, objects=(replace(scene.objects[0], category="door"),))
    assert wall_y(by_photo(scene)) == pytest.approx(2.2, abs=0.02)


def test_what_shows_its_foot_says_more_of_a_wall_than_what_does_not() -> None:
    _, scene = standing_against_the_wall(0.3, before_m=-0.1)
    against, before = scene.objects
    assert wall_y(by_photo(scene)) == pytest.approx(2.5)
    assert wall_y(by_photo(scene, feet_seen={against.id})) == pytest.approx(2.2, abs=0.02)
    assert wall_y(by_photo(scene, feet_seen={before.id})) == pytest.approx(2.5)


def test_a_wall_of_the_photo_yields_to_what_was_measured_and_pulls_nothing_to_it() -> None:
    _, behind = standing_against_the_wall(before_m=-0.1)
    assert wall_y(containing_room(behind, walls_reasoned=True)) == pytest.approx(2.6, abs=0.02)
    assert wall_y(by_photo(behind)) == pytest.approx(2.5)
    _, away = standing_against_the_wall(0.0, 0.0, 0.3)
    kept = containing_room(away, walls_reasoned=True)
    assert [kept.support_of(o.id).adheres_to for o in kept.objects] == [("wall_1",), ("wall_1",), ()]
    assert all(by_photo(away).support_of(o.id).adheres_to for o in away.objects)


def test_an_assumed_wall_goes_back_to_what_was_measured_against_it() -> None:
    room = Room(LIBRARY)
    half = LIBRARY.shape("cabinet_10").size_m[0] / 2
    room.put("cabinet_10", (0.0, 2.6, 0.4), yaw=-np.pi / 2, adheres_to=("wall_1",))
    observed = room.scene(architecture=sliver(0.15), camera=looking_north(5.0))
    assert wall_y(containing_room(observed)) == pytest.approx(2.6 + half, abs=0.02)
    assert wall_y(containing_room(observed, objects_measured=False)) == pytest.approx(2.5)


def test_floor_drawn_out_behind_a_wall_goes_when_nothing_stands_on_it_any_more() -> None:
    room = Room(LIBRARY)
    behind = room.put("box_24", (0.2, 3.2, 0.15))
    known = sliver(0.95).floor
    assert known is not None
    drawn = by_photo(room.scene(architecture=sliver(0.95), camera=looking_north(5.0)))
    assert drawn.architecture.floor.polygon[:, 1].max() > 3.0
    assert without_floor_behind_walls(drawn, known) is drawn  # it still stands there

    before = drawn.object(behind)
    inside = replace(before, pose=replace(before.pose, position=np.array([0.0, 1.0, 0.15])))
    settled = replace(drawn, objects=tuple(inside if o.id == behind else o for o in drawn.objects))
    trimmed = without_floor_behind_walls(settled, known)
    floor = trimmed.architecture.floor
    assert floor.polygon[:, 1].max() == pytest.approx(2.5, abs=0.02)
    assert trimmed.objects == settled.objects
    assert without_floor_behind_walls(trimmed, known) is trimmed
