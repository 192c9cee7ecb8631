from __future__ import annotations

import numpy as np
import pytest

from diorama_core.layout.feasible.relocate import relocate
from diorama_core.layout.feasible.separate import Program, overlaps
from diorama_core.layout.settings import LAYOUT
from tests.layout.feasible.test_separate import BOX, program
from tests.layout.small_rooms import Room

CUP_M = 0.09
"""Width of the cup, measured across any of its sides."""


def unmoved(p: Program) -> np.ndarray:
    return np.zeros(p.J.shape[2])


def moves_of(p: Program, y: np.ndarray) -> dict[str, np.ndarray]:
    return dict(zip(p.problem.ids, p.moves(y), strict=True))


@pytest.mark.parametrize("cup_goes", [True, False])
def test_the_one_of_two_for_which_that_costs_less_goes_the_nearest_way_out(room: Room, cup_goes: bool) -> None:
    box = room.put(BOX, (0, 0, 0.15))
    cup = room.put("cup_21", (0.05, 0, 0.05))
    p = program(room, (9.0, 1.0) if cup_goes else (1.0, 9.0))
    assert overlaps(p, unmoved(p))[1] == ((0, 1),)
    after = relocate(p, unmoved(p))
    moves = moves_of(p, after.y)
    goes, stays = (cup, box) if cup_goes else (box, cup)
    assert (after.stuck, after.depth_m) == ((), 0.0)
    assert not moves[stays].any()
    # Out through the nearer face.
    out = (0.35 + CUP_M) / 2 - 0.05 + LAYOUT.apart_m
    np.testing.assert_allclose(moves[goes], [out if cup_goes else -out, 0.0, 0.0], atol=1e-3)


def test_a_spot_that_is_taken_is_left_out(room: Room) -> None:
    room.put(BOX, (0, 0, 0.15), locked=True)
    cup = room.put("cup_21", (0.05, 0, 0.05))
    for k, y in enumerate((-0.48, 0.0, 0.48)):
        room.put(BOX, (0.36, y, 0.15), id=f"x_{k}", locked=True)
    p = program(room)
    after = relocate(p, unmoved(p))
    assert after.stuck == ()
    # The nearest way out, 0.17 m, ends in the row of boxes; to the other sides it is the next nearest.
    assert np.linalg.norm(moves_of(p, after.y)[cup]) == pytest.approx((0.45 + CUP_M) / 2 + LAYOUT.apart_m, abs=1e-3)


def test_a_spot_behind_a_wall_is_left_out(room: Room) -> None:
    room.put(BOX, (-2.75, 0, 0.15), locked=True)
    cup = room.put("cup_21", (-2.82, 0.02, 0.05))
    p = program(room)
    after = relocate(p, unmoved(p))
    assert after.stuck == ()
    # Toward the wall, 3 m off, it is 0.15 m, but only 75 mm are free there.
    np.testing.assert_allclose(
        moves_of(p, after.y)[cup], [0.0, (0.45 + CUP_M) / 2 - 0.02 + LAYOUT.apart_m, 0.0], atol=1e-3
    )


def test_what_stands_on_the_moved_object_goes_along(room: Room) -> None:
    room.put("wardrobe_12", (0, 0, 1.0), locked=True)
    stand = room.put(BOX, (0.3, 0, 0.15))
    cup = room.put("cup_21", (0.35, 0.0, 0.35), on=stand)
    p = program(room)
    after = relocate(p, unmoved(p))
    moves = moves_of(p, after.y)
    assert after.stuck == ()
    assert np.linalg.norm(moves[stand]) > 0.1
    np.testing.assert_allclose(moves[cup], moves[stand], atol=1e-9)


def test_where_no_spot_is_free_everything_stays(room: Room) -> None:
    stand = room.put("night_stand_11", (0, 0, 0.25), locked=True)
    room.put("cup_21", (0, 0, 0.55), on=stand, locked=True)
    # The stand's top leaves it 25 mm to either side; the cup is 90 mm wide.
    room.put(BOX, (0.01, 0, 0.65), on=stand)
    p = program(room)
    depth, stuck = overlaps(p, unmoved(p))
    assert len(stuck) == 1
    after = relocate(p, unmoved(p))
    assert (after.depth_m, after.stuck) == (depth, stuck)
    np.testing.assert_array_equal(after.y, unmoved(p))
