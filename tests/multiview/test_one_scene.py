from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.geometry.openings import STANDS_OUT_M
from diorama_core.multiview.one_scene import acyclic, fuse_proportions, move_to_room, set_into_wall
from diorama_core.scene.types import Pose, Support, rigid, yaw_rotation
from tests.app.small_room import furnished_scene

EXTENT = st.floats(0.1, 3.0)


def test_an_edge_that_would_close_a_circle_is_left_out() -> None:
    lamp, table, back = Support("lamp", "table"), Support("table", "floor"), Support("floor", "lamp")
    assert acyclic((lamp, table, back)) == (lamp, table)
    assert acyclic((Support("a", "b"), Support("b", "a"))) == (Support("a", "b"),)


@given(st.tuples(EXTENT, EXTENT, EXTENT), st.floats(0.5, 2.0))
def test_what_has_the_proportions_of_its_shape_keeps_its_size(shape, scale) -> None:
    size = scale * np.array(shape)
    found = fuse_proportions(size, np.array([0.05, 0.3, 0.1]), np.array(shape))
    np.testing.assert_allclose(found, size, rtol=1e-9)


def test_extents_that_boxes_hardly_tell_follow_the_shape() -> None:
    shape, measured = np.array([0.5, 1.0, 2.0]), np.array([2.0, 1.0, 2.0])
    depth, width, height = fuse_proportions(measured, np.array([2.0, 0.02, 0.02]), shape)
    assert depth == pytest.approx(0.5, rel=0.05)
    assert (width, height) == pytest.approx((1.0, 2.0), rel=0.02)


def test_a_scene_moves_as_a_whole_and_back() -> None:
    scene = furnished_scene()
    T = rigid(yaw_rotation(0.7), np.array([1.0, -2.0, 0.3]))
    there = move_to_room(scene, T)
    back = move_to_room(there, np.linalg.inv(T))
    for before, moved, after in zip(scene.objects, there.objects, back.objects, strict=True):
        np.testing.assert_allclose(moved.pose.position, T[:3, :3] @ before.pose.position + T[:3, 3])
        np.testing.assert_allclose(after.pose.position, before.pose.position, atol=1e-9)
        np.testing.assert_allclose(after.pose.R_world_object, before.pose.R_world_object, atol=1e-9)


def test_a_windows_frame_is_in_the_wall_and_its_back_stays() -> None:
    scene = furnished_scene()
    item = replace(scene.objects[0], shape_size_m=(0.14, 1.0, 1.2))
    thick = replace(item, pose=Pose(yaw_rotation(0.4), np.array([1.0, 2.0, 1.5]), np.ones(3)), candidates=())
    thin = set_into_wall(thick)
    front = thick.pose.R_world_object[:, 0]
    np.testing.assert_allclose(thin.size_m, (STANDS_OUT_M, 1.0, 1.2))
    back = [o.pose.position - front * o.size_m[0] / 2 for o in (thick, thin)]
    np.testing.assert_allclose(*back, atol=1e-9)
    assert set_into_wall(thin).pose.position == pytest.approx(thin.pose.position)
