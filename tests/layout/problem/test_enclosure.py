from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.geometry.sat import place_bodies
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.feasible.separate import build_program
from diorama_core.layout.feasible.structure import exact_structure
from diorama_core.layout.problem.enclosure import may_meet
from diorama_core.layout.problem.problem import build_problem
from diorama_core.library.catalogue import built_in_library
from diorama_core.progress import Progress
from tests.layout.small_rooms import Room


def allowed(room: Room, first: str, second: str) -> np.ndarray:
    """Which parts of two objects may not overlap."""
    problem = build_problem(room.scene(), room.library)
    program = build_program(problem, exact_structure(problem), np.tile(np.eye(2), (problem.count, 1, 1)))
    owner = program.bodies.owner
    a, b = (owner == problem.ids.index(name) for name in (first, second))
    return program.may_meet[np.ix_(a, b)]


def test_books_meet_the_sides_of_a_bookshelf_but_not_its_boards(room: Room) -> None:
    shelf = room.put("bookshelf_6", (0.0, 1.0, 0.9))
    books = room.put("books_18", (0.0, 1.0, 0.6), on=shelf)
    met = allowed(room, books, shelf)
    assert met.any()
    assert not met.all()


def test_a_cup_on_a_table_meets_nothing_of_it(room: Room) -> None:
    table = room.put("table_0", (0.0, 0.0, 0.37))
    cup = room.put("cup_21", (0.0, 0.0, 0.8), on=table)
    assert not allowed(room, cup, table).any()


def test_a_part_that_covers_the_middle_of_a_place_encloses_nothing(room: Room) -> None:
    table = room.put("table_0", (0.0, 0.0, 0.37))
    cup = room.put("cup_21", (0.0, 0.0, 0.8), on=table)
    problem = build_problem(room.scene(), room.library)
    bodies = place_bodies(problem.packed, problem.R, problem.p, problem.scale)
    k, below = problem.ids.index(cup), problem.ids.index(table)
    place = problem.surface[k].at(problem.R[below], problem.p[below], problem.scale[below])
    lower = replace(place, level=place.level - 0.02, polygon=place.polygon - 0.02 * place.normal)
    surfaces = [lower if i == k else s for i, s in enumerate(problem.surface)]
    assert not may_meet(problem, bodies, surfaces)[np.ix_(bodies.owner == k, bodies.owner == below)].any()


def test_strangers_meet_with_all_parts(room: Room) -> None:
    first, second = room.put("table_0", (0.0, 0.0, 0.37)), room.put("table_0", (0.2, 0.0, 0.37))
    assert allowed(room, first, second).all()


def test_a_layout_takes_books_out_of_the_back_of_their_shelf(room: Room) -> None:
    shelf = room.put("bookshelf_6", (0.0, 1.0, 0.9))
    depth = room.objects[0].size_m[0]
    books = room.put("books_18", (-depth / 2, 1.0, 0.6), on=shelf)
    settled, _ = FeasibleRecipe(room.library).optimise(room.scene(), Progress())
    back = float(settled.object(shelf).corners_world[:, 0].min())
    assert float(settled.object(books).corners_world[:, 0].min()) > back


def test_a_pillow_sinks_into_the_bedding_of_its_bed_but_not_into_the_headboard() -> None:
    room = Room(built_in_library())
    bed = room.put("bed-channel-green", (0.0, 0.0, 0.58))
    pillow = room.put("pillow-tweed", (0.3, -0.2, 0.7), on=bed)
    tray = room.put("tray-round-oak", (0.3, 0.4, 0.65), on=bed)
    of_pillow, of_tray = allowed(room, pillow, bed).any(axis=0), allowed(room, tray, bed).any(axis=0)
    assert of_pillow.any()
    assert of_tray[of_pillow].all()
    assert of_pillow.sum() < of_tray.sum()
