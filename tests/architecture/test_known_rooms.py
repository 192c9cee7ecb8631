"""Rooms of known geometry behind twenty things: every plane found, none made up, to the asked accuracy.

A wider run over more rooms of each kind is `python scripts/eval_rooms.py`.
"""

from __future__ import annotations

import numpy as np
import pytest

from diorama_core.architecture.from_depth import PlanarRoom
from diorama_core.architecture.walls.closed_room import is_simple
from diorama_core.evaluation.metrics.architecture import architecture_scores, match_planes
from diorama_core.progress import Progress
from tests.architecture.known_rooms import KINDS, all_rays_hit, known_room, photographed, visible_feet


def reconstructed(kind, seed, noise):
    shot = photographed(kind, seed, items=20, noise=noise)
    estimate = PlanarRoom().reconstruct(shot.inputs, shot.objects, shot.geometry, Progress())
    return shot, estimate.architecture.planes


@pytest.mark.parametrize(("noise", "angle", "offset"), [(0.0, 1.0, 0.03), (0.02, 3.0, 0.08)])
def test_planes_of_rooms_of_every_kind(noise, angle, offset):
    found = missed = spurious = 0
    for number, kind in enumerate(KINDS):
        shot, planes = reconstructed(kind, number % 3, noise)
        matches = match_planes(planes, shot.planes, shot.camera, angle_deg=angle, offset_m=offset)
        found, missed = found + len(matches.matches), missed + len(matches.missed)
        spurious += len(matches.spurious)
    assert found / (found + missed) >= 0.95
    assert found / (found + spurious) >= 0.95


def test_the_picture_of_the_empty_room_is_right_too():
    shot, planes = reconstructed("l_shape", 1, 0.02)
    scores = architecture_scores(planes, shot.planes, shot.camera)
    assert scores.iou > 0.95
    assert scores.pixel_error < 0.02
    assert scores.edge_error_px < 4.0
    assert scores.depth_rmse_m < 0.15


@pytest.mark.parametrize("kind", KINDS)
def test_the_known_rooms_are_what_they_claim(kind):
    planes, camera = known_room(kind, 0)
    assert all_rays_hit(planes, camera)
    assert all(p.normal @ camera.position > p.offset for p in planes if p.role != "wall")
    assert len(visible_feet(planes, camera)) > 0 or kind == "gable"


def test_furniture_hides_up_to_the_asked_share_of_the_feet():
    planes, camera = known_room("box", 0)
    shot = photographed("box", 0, items=20)
    feet = visible_feet(planes, camera)[:, :3]
    columns, rows = camera.project(feet).astype(int).T
    hidden = np.any([o.mask[rows, columns] for o in shot.objects], axis=0).mean()
    assert 0.3 < hidden <= 0.62


@pytest.mark.parametrize("kind", ["l_shape", "alcove"])
def test_the_floor_follows_the_walls(kind):
    _, planes = reconstructed(kind, 1, 0.0)
    floor = next(p for p in planes if p.role == "floor")
    assert is_simple(floor.polygon[:, :2])
    for wall in (p for p in planes if p.role == "wall"):
        for foot in wall.polygon[:2]:
            assert np.linalg.norm(floor.polygon - foot, axis=1).min() < 1e-6
