from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.geometry.rotations import rotation_from_vector
from diorama_core.geometry.sat import place_bodies
from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.feasible.separate import build_program
from diorama_core.layout.feasible.structure import exact_structure
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.layout.problem.volumes import Volumes, contact_templates, may_meet
from diorama_core.library.catalogue import built_in_library
from diorama_core.progress import Progress
from diorama_core.scene.types import Pose
from tests.layout.small_rooms import Room


@pytest.fixture
def problem(room: Room) -> Problem:
    table = room.put("table_0", (0, 0, 0.37), yaw=0.3, scale=(1.1, 0.9, 1.2))
    room.put("cup_21", (0.2, 0.3, 0.85), on=table)
    shelf = room.put(room.library.in_category("bookshelf")[0].id, (-2, 0, 0.9))
    room.put("cup_21", (-2.0, 0.1, 0.5), on=shelf)
    return build_problem(room.scene(), room.library)


def test_batched_volumes_equal_the_surfaces_one_by_one(problem: Problem, rng: np.random.Generator) -> None:
    volumes = Volumes.of(problem)
    R = np.array([rotation_from_vector(v) for v in rng.normal(0, 1, (problem.count, 3))])
    p, scale = rng.normal(0, 1, (problem.count, 3)), rng.uniform(0.5, 2.0, (problem.count, 3))
    found = volumes.world_volumes(R, p, scale)
    assert volumes.supported.tolist() == [i for i, s in enumerate(problem.surface) if s is not None]
    assert (volumes.supporter >= 0).sum() == 2
    for row, i in enumerate(volumes.supported):
        j = int(problem.parent[i])
        surface = problem.surface[i]
        one = surface if j < 0 else surface.to_world(Pose(R[j], p[j], scale[j]))
        k = len(one.offset)
        np.testing.assert_allclose(found.outward[row, :k], one.outward, atol=1e-12)
        np.testing.assert_allclose(found.offset[row, :k], one.offset, atol=1e-12)
        assert not found.outward[row, k:].any()
        np.testing.assert_allclose(found.normal[row], one.normal, atol=1e-12)
        assert found.level[row] == pytest.approx(one.level)
        assert found.clearance[row] == pytest.approx(one.clearance_m)


def test_contact_templates_are_the_corners_of_the_touching_face(problem: Problem) -> None:
    every = np.arange(problem.count)
    corners, half = contact_templates(problem, every)
    np.testing.assert_allclose(half, problem.shape_size / 2)
    for i in every:
        np.testing.assert_allclose(corners[i] @ problem.contact[i], half[i] @ np.abs(problem.contact[i]))
        assert len({tuple(c) for c in corners[i].round(9)}) == 4
        np.testing.assert_allclose(np.abs(corners[i]), np.broadcast_to(half[i], (4, 3)))


def test_a_scene_without_supports_has_no_volumes(room: Room) -> None:
    empty = Volumes.of(build_problem(room.scene(), room.library))
    assert len(empty.supported) == 0
    assert len(empty.world_volumes(np.zeros((0, 3, 3)), np.zeros((0, 3)), np.zeros((0, 3))).level) == 0


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
    place = problem.surface[k].transform(problem.R[below], problem.p[below], problem.scale[below])
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
