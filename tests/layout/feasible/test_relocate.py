from __future__ import annotations

import numpy as np

from diorama_core.layout.feasible.relocate import relocate
from diorama_core.layout.feasible.separate import Separation, overlaps
from tests.layout.feasible.test_separate import BOX, program
from tests.layout.small_rooms import Room


def unparted(room: Room):
    """A program, and where it stands before anything moved."""
    p = program(room)
    y = np.zeros(p.J.shape[2])
    return p, Separation(y, *overlaps(p, y))


def test_the_lighter_of_two_goes_to_a_free_spot_nearby(room: Room) -> None:
    box = room.put(BOX, (0, 0, 0.15))
    cup = room.put("cup_21", (0.05, 0, 0.05))
    p, before = unparted(room)
    assert before.stuck == ((0, 1),)
    after = relocate(p, before)
    moves = dict(zip(p.problem.ids, p.moves(after.y), strict=True))
    assert (after.stuck, after.depth_m) == ((), 0.0)
    assert not moves[box].any()
    # Out through the nearer face takes 0.17 m; the rings of tried spots are at most 0.07 m apart.
    assert 0.16 < np.linalg.norm(moves[cup]) < 0.27


def test_a_spot_that_is_taken_is_left_out(room: Room) -> None:
    room.put(BOX, (0, 0, 0.15))
    cup = room.put("cup_21", (0.05, 0, 0.05))
    for k, y in enumerate((-0.4, 0.0, 0.4)):
        room.put(BOX, (0.36, y * 1.2, 0.15), id=f"x_{k}", locked=True)
    p, before = unparted(room)
    after = relocate(p, before)
    assert not any(p.problem.ids.index(cup) in pair for pair in after.stuck)


def test_what_stands_on_the_moved_thing_goes_along(room: Room) -> None:
    room.put("wardrobe_12", (0, 0, 1.0), locked=True)
    stand = room.put(BOX, (0.3, 0, 0.15))
    cup = room.put("cup_21", (0.35, 0.0, 0.35), on=stand)
    p, before = unparted(room)
    after = relocate(p, before)
    moves = dict(zip(p.problem.ids, p.moves(after.y), strict=True))
    assert after.stuck == ()
    assert np.linalg.norm(moves[stand]) > 0.1
    np.testing.assert_allclose(moves[cup], moves[stand], atol=1e-9)


def test_where_no_spot_is_free_everything_stays(room: Room) -> None:
    room.put(BOX, (0, 0, 0.15), locked=True)
    room.put(BOX, (0.1, 0, 0.15), locked=True)
    p, before = unparted(room)
    after = relocate(p, before)
    assert after.stuck == before.stuck
    np.testing.assert_array_equal(after.y, before.y)
