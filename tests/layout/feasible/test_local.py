from __future__ import annotations

import numpy as np
import pytest

from diorama_core.layout.feasible.local import DragSolver
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.problem.problem import build_problem
from diorama_core.layout.report import part_overlaps
from diorama_core.progress import Progress
from diorama_core.scene.support import check_scene, descendants
from diorama_core.scene.types import Pose, Scene
from diorama_core.synthesis.layout_rooms import box_library, generate_room
from tests.layout.small_rooms import Room

LIBRARY = box_library()


def dragged(scene: Scene, object_id: str, pose: Pose) -> Scene:
    return DragSolver.prepare(scene, LIBRARY, object_id).solve(pose)


def overlap_m(scene: Scene) -> float:
    problem = build_problem(scene, LIBRARY)
    return max(part_overlaps(problem).values(), default=0.0)


def test_follows_the_hand_and_drops_to_the_floor(room: Room) -> None:
    box = room.put("box_24", (0, 0, 0.15))
    after = dragged(room.scene(), box, room.objects[0].pose.move((1.0, -0.5, 0.3)))
    assert after.object(box).pose.position == pytest.approx([1.0, -0.5, 0.15])


def test_stops_at_walls_and_neighbours(room: Room) -> None:
    box = room.put("box_24", (0, 0, 0.15))
    wardrobe = room.put("wardrobe_12", (1.5, 0, 1.0))
    scene = room.scene()
    at_wall = dragged(scene, box, scene.object(box).pose.move((-9.0, 0, 0)))
    assert at_wall.object(box).corners_world[:, 0].min() == pytest.approx(-3.0, abs=1e-3)
    beside = dragged(scene, box, scene.object(box).pose.move((1.2, 0, 0)))
    assert overlap_m(beside) == 0.0
    assert beside.object(wardrobe).pose == scene.object(wardrobe).pose


def test_what_it_holds_rides_along(room: Room) -> None:
    table = room.put("table_0", (0, 0, 0.37))
    cup = room.put("cup_21", (0.2, 0.3, 0.79), on=table)
    scene = room.scene()
    after = dragged(scene, table, scene.object(table).pose.move((0.5, 0.4, 0)))
    shift = after.object(cup).pose.position - scene.object(cup).pose.position
    assert shift == pytest.approx([0.5, 0.4, 0.0], abs=1e-6)


def test_dragged_off_the_table_it_stands_on_the_floor_and_back(room: Room) -> None:
    table = room.put("table_0", (0, 0, 0.37))
    cup = room.put("cup_21", (0, 0, 0.79), on=table)
    scene = room.scene()
    off = dragged(scene, cup, scene.object(cup).pose.move((1.5, 0, 0)))
    assert off.support_of(cup).parent == "floor"
    assert off.object(cup).pose.position[2] == pytest.approx(0.05)
    check_scene(off)


def test_a_locked_object_stays(room: Room) -> None:
    box = room.put("box_24", (0, 0, 0.15), locked=True)
    scene = room.scene()
    assert dragged(scene, box, scene.object(box).pose.move((1, 0, 0))) is scene


def test_only_what_is_affected_moves_and_nothing_overlaps() -> None:
    scene, _ = FeasibleRecipe(LIBRARY).optimise(generate_room(1, 50).observed, Progress())
    rng = np.random.default_rng(0)
    for item in scene.objects[::9]:
        solver = DragSolver.prepare(scene, LIBRARY, item.id)
        mine = {item.id, *descendants(scene, item.id)}
        for _ in range(3):
            after = solver.solve(item.pose.move(rng.normal(0, 0.15, 3)))
            assert {o.id for o in after.objects if o != scene.object(o.id)} <= mine
            check_scene(after)
