"""Structure is exact whatever was observed, and only what may move is settled."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.layout.feasible.structure import exact_structure
from diorama_core.layout.problem.problem import Problem, build_problem
from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.small_rooms import Room

LIBRARY = box_library()


def floating(room: Room) -> Problem:
    """A table 5 cm above the floor and a vase above its edge."""
    table = room.put("table_0", (0.0, 0.6, 0.42))
    room.put("vase_20", (0.0, 0.3, 0.74 + 0.1 + 0.14), on=table)
    return build_problem(room.scene(), LIBRARY)


def test_contact_faces_are_on_their_supports_and_within_them(room: Room):
    problem = floating(room)
    found = exact_structure(problem)
    for i in range(problem.count):
        place, j = found.surface[i], int(problem.parent[i])
        assert place is not None
        world = place if j < 0 else place.transform(found.R[j], found.p[j], found.scale[j])
        foot = found.p[i] + found.R[i] @ (problem.contact[i] * problem.shape_size[i] * found.scale[i] / 2)
        assert float(world.normal @ foot) == pytest.approx(world.level, abs=1e-9)
        assert (world.outward @ foot <= world.offset).all()
    assert (found.bound_slack >= 0.0).all()


def test_what_is_not_to_be_settled_stays_and_cannot_move(room: Room):
    problem = floating(room)
    found = exact_structure(problem, only=(1,))
    assert problem.ids[0].startswith("table")
    np.testing.assert_array_equal(found.p[0], problem.p[0])
    assert not found.basis[0].any()
    assert found.basis[1].any()
