"""Which walls an object stands against."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.arrangement.noise import MEASURED, REASONED, ObservationNoise
from diorama_core.arrangement.standing import STANDING_TERMS, standing_walls, wall_relation
from diorama_core.arrangement.support_terms import fitted_weights
from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.feasible.test_photo_observations import looking_north
from tests.layout.small_rooms import Room

DEPTH, _, HEIGHT = box_library().shape("cabinet_10").size_m


def walls_of_cabinet(room: Room, gap_m: float, yaw: float, noise: ObservationNoise) -> tuple[str, ...]:
    """Those of a cabinet before the far wall of a room of 6 x 5 m, at x = 0."""
    cabinet = room.put("cabinet_10", (0.0, 2.5 - DEPTH / 2 - gap_m, HEIGHT / 2), yaw=yaw)
    scene = room.scene(camera=looking_north())
    return standing_walls(scene, scene.object(cabinet), noise, fitted_weights().walls)


@pytest.mark.parametrize("noise", [MEASURED, REASONED])
def test_a_cabinet_with_its_back_at_a_wall_stands_against_it(room: Room, noise: ObservationNoise) -> None:
    assert walls_of_cabinet(room, 0.0, -np.pi / 2, noise) == ("wall_2",)


@pytest.mark.parametrize(("gap_m", "yaw"), [(1.0, -np.pi / 2), (0.15, np.deg2rad(-60.0))])
def test_a_cabinet_away_from_a_wall_or_aslant_to_it_stands_free(room: Room, gap_m: float, yaw: float) -> None:
    assert walls_of_cabinet(room, gap_m, yaw, MEASURED) == ()


def test_weights_name_every_term() -> None:
    assert all(set(weights) == set(STANDING_TERMS) for weights in fitted_weights().walls.values())


def test_a_wall_that_ends_before_an_object_has_no_relation_to_it(room: Room) -> None:
    cabinet = room.put("cabinet_10", (7.0, 2.0, HEIGHT / 2), yaw=-np.pi / 2)
    scene = room.scene(camera=looking_north())
    assert wall_relation(scene, scene.object(cabinet), scene.plane("wall_2"), MEASURED) is None
