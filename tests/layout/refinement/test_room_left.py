from __future__ import annotations

import numpy as np

from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.refinement.room_left import RoomLeft
from diorama_core.layout.report import part_overlaps
from diorama_core.progress import Progress
from tests.layout.small_rooms import Room


def settled(room: Room) -> Problem:
    scene, _ = FeasibleRecipe(room.library).optimise(room.scene(), Progress())
    return build_problem(scene, room.library, adherence_m=0.004)


def allowed(problem: Problem, name: str, move: tuple[float, float, float], grown: float = 1.0) -> bool:
    i, p, scale = problem.ids.index(name), problem.p.copy(), problem.scale.copy()
    p[i] += move
    scale[i] *= grown
    return RoomLeft.of(problem).allows(i, problem.R, p, scale)


def test_a_settled_layout_is_allowed_and_so_is_a_move_into_free_space(room: Room) -> None:
    room.put("box_24", (0.0, 0.0, 0.15), id="a")
    room.put("box_24", (1.5, 0.0, 0.15), id="b")
    problem = settled(room)
    assert allowed(problem, "a", (0.0, 0.0, 0.0))
    assert allowed(problem, "a", (0.3, 0.2, 0.0))


def test_into_a_neighbour_through_a_wall_and_off_the_floor_nothing_moves(room: Room) -> None:
    room.put("box_24", (0.0, 0.0, 0.15), id="a")
    room.put("box_24", (1.5, 0.0, 0.15), id="b")
    room.put("box_24", (0.0, 2.2, 0.15), id="at wall")
    problem = settled(room)
    assert not allowed(problem, "a", (1.5, 0.1, 0.0))
    assert not allowed(problem, "a", (0.0, 0.0, 0.05))
    assert not allowed(problem, "at wall", (0.0, 0.4, 0.0))


def test_what_carries_something_does_not_leave_it_in_the_air(room: Room) -> None:
    low = room.put("box_24", (0.0, 0.0, 0.15), id="low")
    room.put("box_24", (0.0, 0.0, 0.45), on=low, id="on top", scale=(0.9, 0.9, 0.5))
    problem = settled(room)
    assert not allowed(problem, "low", (0.3, 0.0, 0.0))
    assert not allowed(problem, "on top", (0.3, 0.0, 0.0))
    assert np.isclose(problem.p[0, 2], problem.shape_size[0, 2] / 2)


def test_what_hangs_over_an_edge_does_not_leave_it_farther(room: Room) -> None:
    low = room.put("box_24", (0.0, 0.0, 0.15), id="low")
    room.put("box_24", (0.0, 0.0, 0.45), on=low, id="on top", scale=(2.0, 2.0, 0.5))
    problem = settled(room)
    assert allowed(problem, "on top", (0.0, 0.0, 0.0))
    assert not allowed(problem, "on top", (0.05, 0.0, 0.0), grown=1.0)


def test_what_is_on_a_lower_board_overlaps_the_sides_and_not_what_is_beside_it(room: Room) -> None:
    shelf = room.put("bookshelf_6", (0.0, 0.0, 0.9), id="shelf")
    place, half = room.library.shape("bookshelf_6").surfaces[1], room.library.shape("cup_21").size_m[2] / 2
    room.put("cup_21", (0.0, 0.0, 0.9 + place.height_m + half), on=shelf, id="cup")
    problem = settled(room)
    through, p = problem.ids.index("cup"), problem.p.copy()
    p[through, 1] += 0.5 * room.library.shape("bookshelf_6").size_m[1]
    poses = problem.R, p, problem.scale
    assert part_overlaps(problem, *poses, only=through, supporters=True)[0, 1] > 0.01
    assert not part_overlaps(problem, *poses, only=through)
    assert not part_overlaps(problem, problem.R, problem.p, problem.scale, supporters=True)
