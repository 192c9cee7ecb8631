"""Views of shapes by rays in the shape's frame."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.geometry.projection import edges_of_cuboid
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster, clip_bounds, is_circle
from diorama_core.geometry.window import Window, soft_iou
from diorama_core.render.raycast import MeshCaster
from diorama_core.scene.types import Camera, Intrinsics, Pose, box_corners

CAMERA = Camera(Intrinsics.from_fov(64, 48, 1.0), np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 1.2], [0, 0, 0, 1]]))
MESH = trimesh.util.concatenate(
    [trimesh.creation.box((0.8, 0.6, 1.0)), trimesh.creation.icosphere(2, 0.4).apply_translation((0, 0, 0.3))]
)


def batch(pose: Pose) -> PoseBatch:
    return PoseBatch(pose.R_world_object[None], pose.position[None], pose.scale[None])


@settings(max_examples=25)
@given(st.floats(-3, 3), st.floats(-0.5, 0.5), st.floats(2.0, 4.0), st.floats(0.6, 1.6), st.floats(0.6, 1.6))
def test_rays_in_the_shape_s_frame_see_what_a_renderer_sees(yaw, x, y, sx, sz) -> None:
    pose = Pose.upright((x, y, 1.0), yaw, (sx, 1.0, sz))
    rows, columns = np.mgrid[0:48, 0:64]
    directions = CAMERA.rays(np.stack([columns.ravel() + 0.5, rows.ravel() + 0.5], axis=1))
    caster = ShapeCaster(MESH)
    hits = caster.cast(CAMERA.position, directions, batch(pose))
    assert (caster.covers(CAMERA.position, directions, batch(pose)) == hits.is_hit).all()
    truth = MeshCaster([(MESH, pose.matrix)]).buffers(CAMERA)
    both = hits.is_hit[0] & truth.silhouette.ravel()
    assert (hits.is_hit[0] != truth.silhouette.ravel()).mean() < 0.003
    assert np.abs(hits.depth_m[0] - truth.depth_m.ravel())[both].max() < 1e-2
    agreement = (hits.normals_world[0] * truth.normals_world.reshape(-1, 3)).sum(axis=1)[both]
    assert np.mean(agreement > 0.99) > 0.97
    others = np.random.default_rng(0).normal(size=(len(directions), 3))
    along = (hits.normals_world[0] * others).sum(axis=1)
    assert hits.normals_along(others)[0] == pytest.approx(along, abs=1e-5)


def test_bounds_of_the_hull_are_those_of_the_vertices() -> None:
    pose = Pose.upright((0.2, 3.0, 1.0), 0.4, (1.0, 1.3, 0.9))
    bounds = ShapeCaster(MESH).bounds_px(CAMERA, batch(pose))[0]
    pixels = CAMERA.project(pose.apply(np.asarray(MESH.vertices)))
    assert bounds == pytest.approx(np.concatenate([pixels.min(axis=0), pixels.max(axis=0)]), abs=0.7)


def test_bounds_are_clipped_to_the_photo_and_missing_out_of_sight() -> None:
    wide, behind = box_corners((9.0, 1.0, 1.0)) + np.eye(3)[2] * 2, box_corners((1.0, 1.0, 1.0)) - np.eye(3)[2] * 5
    bounds = clip_bounds(CAMERA, np.stack([wide.T, behind.T], axis=1), edges_of_cuboid())
    assert (bounds[0, 0], bounds[0, 2]) == pytest.approx((0.0, 64.0))
    assert np.isnan(bounds[1]).all()


@pytest.mark.parametrize(
    "mesh",
    [
        trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]),
        trimesh.Trimesh([[0, 0, 0]] * 3, [[0, 1, 2]], process=False),
        trimesh.Trimesh(),
    ],
)
def test_flat_and_empty_meshes_are_survived(mesh) -> None:
    caster = ShapeCaster(mesh)
    pose = batch(Pose.upright((0, 3, 1)))
    assert not np.isnan(caster.cast(CAMERA.position, CAMERA.rays(np.array([[32.0, 24.0]])), pose).depth_m).any()
    assert caster.bounds_px(CAMERA, pose).shape == (1, 4)


@given(st.integers(0, 20), st.integers(0, 20), st.integers(3, 30), st.integers(3, 30))
def test_coverage_conserves_the_mask_s_area(top, left, height, width) -> None:
    mask = np.zeros((60, 60), bool)
    mask[top : top + height, left : left + width] = True
    window = Window((-5.0, -3.0, 66.0, 62.0), 17)
    assert window.coverage(mask).sum() * (71 * 65 / 17**2) == pytest.approx(mask.sum(), rel=1e-6)


def test_overlap_is_one_for_the_same_and_zero_for_nothing() -> None:
    seen, weight = np.array([1.0, 0.5, 0.0]), np.ones(3)
    assert soft_iou(seen, seen[None], weight)[0] == 1.0
    assert soft_iou(np.zeros(3), np.zeros((1, 3)), weight)[0] == 0.0


ANGLES = np.linspace(0.0, 2 * np.pi, 48, endpoint=False)
CIRCLE = np.column_stack([np.cos(ANGLES), np.sin(ANGLES)])


@given(st.floats(0.01, 5.0), st.floats(0.0, np.pi), st.floats(-3.0, 3.0))
def test_a_circle_is_one_of_any_size_turn_and_place(radius: float, turn: float, x: float) -> None:
    c, s = np.cos(turn), np.sin(turn)
    assert is_circle(radius * CIRCLE @ np.array([[c, s], [-s, c]]) + [x, 1.0])


@given(st.floats(1.06, 4.0))
def test_an_ellipse_is_none(longer: float) -> None:
    assert not is_circle(CIRCLE * [longer, 1.0])


def test_squares_lines_and_few_points_are_none() -> None:
    side = np.linspace(-1.0, 1.0, 9)
    square = np.array([(x, y) for x in side for y in side])
    assert not is_circle(square)
    assert not is_circle(np.column_stack([side, side]))
    assert not is_circle(CIRCLE[::12])


@pytest.mark.parametrize("inside", [0, 40])
def test_only_the_outline_counts(inside: int) -> None:
    rng = np.random.default_rng(0)
    assert is_circle(np.concatenate([CIRCLE, rng.uniform(-0.6, 0.6, (inside, 2))]))
