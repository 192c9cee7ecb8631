"""Colliding objects are made a little smaller where moving them would take them farther from what the photo shows."""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.layout.feasible.recipe import FeasibleRecipe
from diorama_core.layout.settings import LAYOUT
from diorama_core.progress import Progress
from diorama_core.scene.types import Scene
from diorama_core.synthesis.layout_rooms import box_library
from tests.layout.feasible.test_photo_observations import looking_north
from tests.layout.small_rooms import Room

LIBRARY = box_library()
BOX_M = 0.45


def between_cabinets(room: Room, gap_m: float) -> str:
    """A box between two cabinets that cannot move; returns its id."""
    for side in (-1, 1):
        at = (side * (0.5 + gap_m / 2), 0.5, 0.4)
        room.put("cabinet_10", at, yaw=-np.pi / 2, locked=True)
    return room.put("box_24", (0.0, 0.5, 0.15), yaw=np.pi / 2)


def solved(scene: Scene, name: str) -> tuple[float, np.ndarray, tuple[str, ...]]:
    """How far an object was moved, its scale, and what was reported."""
    settled, report = FeasibleRecipe(LIBRARY).optimise(scene, Progress())
    assert report.after["part_overlap_m"] == 0.0
    moved = settled.object(name).pose.position - scene.object(name).pose.position
    return float(np.linalg.norm(moved)), settled.object(name).pose.scale, report.reasons


def test_what_is_a_little_too_wide_for_its_gap_is_made_smaller_and_stays(room: Room) -> None:
    box = between_cabinets(room, BOX_M - 0.02)
    moved, scale, reasons = solved(room.scene(camera=looking_north()), box)
    assert moved < 0.03
    assert LAYOUT.smallest_shrink <= scale.min() < 0.97
    assert any(f"{box} was made smaller" in reason for reason in reasons)


def test_what_is_much_too_wide_moves_out_and_keeps_its_size(room: Room) -> None:
    box = between_cabinets(room, 0.5 * BOX_M)
    moved, scale, _ = solved(room.scene(camera=looking_north()), box)
    assert moved > 0.2
    np.testing.assert_allclose(scale, 1.0)


def test_what_holds_something_up_keeps_its_size(room: Room) -> None:
    box = between_cabinets(room, BOX_M - 0.02)
    room.put("cup_21", (0.0, 0.5, 0.35), on=box)
    _, scale, _ = solved(room.scene(camera=looking_north()), box)
    assert scale.max() == pytest.approx(1.0, abs=0.02)


def test_without_a_photo_sizes_stay(room: Room) -> None:
    box = between_cabinets(room, BOX_M - 0.02)
    moved, scale, _ = solved(room.scene(), box)
    assert moved > 0.1
    np.testing.assert_allclose(scale, 1.0)
