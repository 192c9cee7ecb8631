"""One decision about the headings of all objects."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from diorama_core.arrangement.facing.evidence import HEADINGS, FacingRoom
from diorama_core.arrangement.facing.solve import Factors, solve
from diorama_core.arrangement.facing.terms import FacingWeights, facing_weights
from tests.arrangement.facing.rooms import heading_deg, room, thing

WEIGHTS = facing_weights()


def total(factors: Factors, weights: FacingWeights, headings: tuple[int, ...]) -> float:
    ones = sum(weights.weight_of(name) * float(values[headings[i]]) for name, i, values in factors.ones)
    return ones + sum(weights.weight_of(name) * float(t[headings[i], headings[j]]) for name, i, j, t in factors.pairs)


def unsure(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).normal(0.0, 1.0, HEADINGS)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_the_decision_is_the_likeliest_of_all(seed: int) -> None:
    stand = thing("night stand", 1.2, 3.0, picture=unsure(seed))
    bed = thing("bed", 0.0, 3.0, (2.0, 1.6, 0.6), picture=unsure(seed + 10))
    found, factors = solve(room(stand, bed), WEIGHTS), Factors.of(room(stand, bed))
    best = max(product(range(HEADINGS), repeat=2), key=lambda h: total(factors, WEIGHTS, h))
    assert tuple(found.headings) == best


def row_of_chairs() -> FacingRoom:
    """Behind a long table, seen from its other side: the pictures of two tell nothing, one seems turned away."""
    table = thing("table", 0.0, 3.0, (0.9, 3.0, 0.7), 90.0)
    away = np.full(HEADINGS, -5.0)
    away[[0, 12]] = 0.0, 1.0
    chairs = [thing("chair", x, 3.8, picture=away if x == 0.0 else np.zeros(HEADINGS)) for x in (-0.8, 0.0, 0.8)]
    return room(*chairs, table)


def test_a_row_of_chairs_faces_its_table() -> None:
    seen = row_of_chairs()
    found = solve(seen, WEIGHTS)
    assert {heading_deg(seen.objects[i], int(found.headings[i])) for i in range(3)} == {-90}


def test_a_chair_before_a_table_shows_its_back() -> None:
    table = thing("table", 0.0, 3.0, (0.9, 3.0, 0.7), 90.0)
    seen = room(thing("chair", 0.0, 2.2), table)
    assert heading_deg(seen.objects[0], int(solve(seen, WEIGHTS).headings[0])) == 90


def test_a_sure_picture_decides_by_itself() -> None:
    table = thing("table", 0.0, 3.0, (0.9, 3.0, 0.7), 90.0)
    sure = np.where(np.arange(HEADINGS) == 0, 0.0, -20.0)
    assert solve(room(thing("chair", 0.0, 2.2, picture=sure), table), WEIGHTS).headings[0] == 0


def test_costs_leave_out_an_object_s_own_picture() -> None:
    table = thing("table", 0.0, 3.0, (0.9, 3.0, 0.7), 90.0)
    blind, sure = (
        solve(room(thing("chair", 0.0, 2.2, picture=picture), table), WEIGHTS).costs_of("chair at 0.0 2.2")
        for picture in (np.zeros(HEADINGS), np.where(np.arange(HEADINGS) == 0, 0.0, -20.0))
    )
    np.testing.assert_allclose(blind.costs, sure.costs)
    assert blind.costs.min() == 0.0


def test_shares_say_which_terms_decided() -> None:
    seen = row_of_chairs()
    said = {s.term: s.amount for s in solve(seen, WEIGHTS).shares if s.object_id == seen.objects[1].object_id}
    assert said["at_table"] > 0.5
    assert said["picture"] < 0.0


def test_a_room_of_nothing_is_decided() -> None:
    assert solve(room(), WEIGHTS).headings.shape == (0,)
