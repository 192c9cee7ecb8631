from __future__ import annotations

from dataclasses import replace

import pytest

from diorama_core.architecture.acdc import AcdcRoom
from diorama_core.evaluation.metrics.architecture import architecture_scores, match_planes
from diorama_core.progress import Progress
from diorama_core.provenance import RoomMethod
from tests.synthetic_rooms import box_room, cuboid, look, shoot


def test_walls_and_floor_are_planes_of_what_is_seen_of_them():
    furniture = (cuboid("cabinet", (-1.0, 2.5, 0), (0.6, 1.0, 0.8)),)
    shot = shoot(look(15, 5, fov_deg=75), box_room(-1.8, 2.2, 4.0, 2.6), furniture)
    estimate = AcdcRoom().reconstruct(shot.inputs, shot.objects, shot.geometry, Progress())
    matches = match_planes(estimate.architecture.planes, shot.planes, shot.camera, angle_deg=3, offset_m=0.05)
    assert {m.true_id for m in matches.matches} >= {"floor", "back", "left"}
    assert estimate.source.method == RoomMethod.ACDC
    assert not estimate.architecture.by_role("ceiling")
    walls = estimate.architecture.by_role("wall")
    assert all(abs(w.normal[2]) < 1e-3 for w in walls)
    # The picture's lower edge cuts the floor: nothing is carried on beyond what is seen.
    assert architecture_scores(estimate.architecture.planes, shot.planes, shot.camera).cdb_m > 0.2


def test_needs_depth():
    shot = shoot(look(), box_room(-2.0, 2.0, 3.5, 2.6))
    with pytest.raises(ValueError, match="measured depth"):
        AcdcRoom().reconstruct(replace(shot.inputs, depth_m=None), (), shot.geometry, Progress())
