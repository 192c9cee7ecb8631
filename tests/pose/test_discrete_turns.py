from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.pose.correspondence.solvers import CorrespondencePose
from diorama_core.pose.discrete_turns import TURNS, DiscreteTurns, object_points
from diorama_core.progress import Progress
from diorama_core.render.templates import TemplateGrid
from tests.pose.rooms import LIBRARY, Room, camera_at, standing, yaw_error_deg

STAGE = DiscreteTurns(CorrespondencePose(LIBRARY, grid=TemplateGrid(azimuths=18, size_px=96)))
ROOM = Room(camera_at(), (standing("chair", 0.0, 3.0, -65.0),), (0,))


def posed():
    return STAGE.pose(ROOM.inputs, ROOM.objects, ROOM.geometry, ROOM.depth(True), ROOM.ranked(), Progress())


def test_the_heading_is_one_of_a_few_and_nothing_leans() -> None:
    best = posed()[0].candidates[0]
    assert best.pose.R_world_object[2, 2] == pytest.approx(1.0)
    looking = ROOM.camera.T_world_camera[:3, 2]
    turns = (best.pose.yaw_rad - np.arctan2(looking[1], looking[0])) / (2 * np.pi / TURNS)
    assert turns == pytest.approx(round(turns), abs=1e-6)
    assert yaw_error_deg(best.pose, ROOM.placed[0].pose, 1) < 30


def test_the_box_is_that_of_the_points_seen() -> None:
    best = posed()[0].candidates[0]
    points = object_points(ROOM.objects[0], ROOM.depth(True), ROOM.camera)
    local = (points - best.pose.position) @ best.pose.R_world_object
    size = np.asarray(best.shape_size_m) * best.pose.scale
    inside = (np.abs(local) <= size / 2 + 1e-9).all(axis=1)
    assert 0.85 < inside.mean() < 1.0
    assert posed() == posed()


def test_without_depth_there_is_no_pose() -> None:
    nothing = ROOM.depth(True)
    blank = replace(nothing, depth_m=np.zeros_like(nothing.depth_m))
    assert STAGE.pose(ROOM.inputs, ROOM.objects, ROOM.geometry, blank, ROOM.ranked(), Progress()) == ()
