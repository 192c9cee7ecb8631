"""The truth in place of one input leaves the others alone; all of it gives the truth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.arrangement.support_hypotheses import MEASURED, REASONED, ObservationNoise
from diorama_core.artefacts import Cuboid, ObjectGeometry
from diorama_core.errors import InputError
from diorama_core.evaluation.benchmarks.substitution import (
    enlarge,
    geometry_with,
    heading_change,
    parse_substitutes,
    size_along_axes,
)
from diorama_core.pipeline.scene_steps import position_noise
from diorama_core.provenance import ScaleSource
from diorama_core.scene.types import Camera, Intrinsics, Pose, Scene, SceneObject, Support, yaw_rotation
from diorama_core.synthesis.layout_rooms import room_box
from diorama_core.synthesis.truth import TruthView
from tests.evaluation.truth import blank_view

K = Intrinsics(640, 480, 540.0, 540.0, 320.0, 240.0)
FACING = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
TRUE = SceneObject("t", "table", "table", "table_0", (0.9, 1.4, 0.74), Pose.upright([0.3, 3.0, 0.37], 0.2))


def camera(height_m: float, yaw: float = 0.0) -> Camera:
    T = np.eye(4)
    T[:3, :3], T[2, 3] = yaw_rotation(yaw) @ FACING, height_m
    return Camera(K, T)


def view(height_m: float = 1.5) -> TruthView:
    item = replace(TRUE, mask_id=1, box_px=(1.0, 1.0, 50.0, 50.0))
    return blank_view(Scene(camera(height_m), room_box(8.0, 8.0), (item,), (Support("t", "floor"),)))


def estimate(height_m: float = 1.8, yaw: float = 0.0) -> ObjectGeometry:
    cuboid = Cuboid("a", yaw_rotation(1.7 + yaw), yaw_rotation(yaw) @ [0.5, 4.0, 0.5], np.array([1.6, 1.0, 1.0]), 0.5)
    return ObjectGeometry(
        camera(height_m, yaw), (cuboid,), (Support("a", "wall", "mounted on"),), ScaleSource.OBJECT_SIZES
    )


def changed(*names: str, found: ObjectGeometry | None = None) -> ObjectGeometry:
    return geometry_with(found or estimate(), {"a": TRUE}, view(), frozenset(names))


def test_true_distance_moves_along_the_ray_and_keeps_the_picture() -> None:
    before, after = estimate(), changed("distance")
    eye = before.camera.position
    old, new = before.cuboids[0].centre - eye, after.cuboids[0].centre - eye
    assert np.allclose(np.cross(old, new), 0)
    assert np.linalg.norm(new) == pytest.approx(np.linalg.norm(TRUE.pose.position - view().camera.position))
    assert np.allclose(after.cuboids[0].size_m / before.cuboids[0].size_m, np.linalg.norm(new) / np.linalg.norm(old))
    assert after.supports == before.supports


@settings(max_examples=20)
@given(st.floats(0.4, 2.5))
def test_another_scale_keeps_the_picture(factor: float) -> None:
    before, after = estimate(), enlarge(estimate(), factor)
    assert after.camera.position[2] == pytest.approx(factor * 1.8)
    old, new = (g.camera.project(g.cuboids[0].corners_world) for g in (before, after))
    assert np.allclose(old, new)


def test_true_height_and_best_scale() -> None:
    assert changed("height").camera.position[2] == pytest.approx(1.5)
    after = changed("scale")
    reach = np.linalg.norm(after.cuboids[0].centre - after.camera.position)
    assert reach == pytest.approx(np.linalg.norm(TRUE.pose.position - view().camera.position))


def test_true_rotation_keeps_extents_where_they_are() -> None:
    after = changed("rotation").cuboids[0]
    assert np.allclose(after.R_world_object, TRUE.pose.R_world_object)
    assert np.allclose(after.size_m, [1.0, 1.6, 1.0])  # the estimate was a quarter off


def test_true_size_keeps_the_base() -> None:
    before, after = estimate().cuboids[0], changed("size").cuboids[0]
    assert np.allclose(after.size_m, [1.4, 0.9, 0.74])
    assert after.corners_world[:, 2].min() == pytest.approx(before.corners_world[:, 2].min())


@settings(max_examples=20)
@given(st.floats(-3.0, 3.0))
def test_truth_is_turned_into_the_estimated_heading(yaw: float) -> None:
    found = estimate(1.5, yaw)
    assert np.allclose(heading_change(found, view()), yaw_rotation(yaw))
    after = changed("rotation", found=found).cuboids[0]
    assert np.allclose(after.R_world_object, yaw_rotation(yaw) @ TRUE.pose.R_world_object)


def test_true_supports_and_cuboids() -> None:
    assert changed("supports").supports == (Support("a", "floor"),)
    after = changed("cuboids")
    assert np.allclose(after.cuboids[0].centre, TRUE.pose.position)
    assert np.allclose(after.camera.T_world_camera, view().camera.T_world_camera)


@pytest.mark.parametrize(
    ("name", "noise"), [("cuboids", MEASURED), ("distance", MEASURED), ("rotation", REASONED), ("height", REASONED)]
)
def test_true_places_count_as_measured_in_later_stages(name: str, noise: ObservationNoise) -> None:
    assert position_noise(changed(name)) == noise


def test_extents_follow_the_nearest_axes() -> None:
    size = np.array([1.0, 2.0, 3.0])
    assert np.allclose(size_along_axes(size, np.eye(3), yaw_rotation(0.3)), size)
    assert np.allclose(size_along_axes(size, np.eye(3), yaw_rotation(1.3)), [2.0, 1.0, 3.0])


def test_rows_are_read_and_wrong_names_are_said() -> None:
    assert parse_substitutes("room, height+room") == (frozenset({"room"}), frozenset({"room", "height"}))
    assert parse_substitutes("") == ()
    with pytest.raises(InputError, match="colour"):
        parse_substitutes("room,colour")
