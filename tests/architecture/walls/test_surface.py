from __future__ import annotations

import numpy as np
import pytest

from diorama_core.architecture.walls.surface import calm_planes, downsample_depth, measure_surface
from diorama_core.scene.types import Intrinsics
from tests.architecture.walls.measured_room import plain_shot, surface_of
from tests.synthetic_rooms import look


def plane_distances(surface) -> np.ndarray:
    """To the nearest plane of the room or side of the wardrobe."""
    x, y, z = surface.points.T
    room = np.min([np.abs(x + 2), np.abs(x - 2), np.abs(y - 4), np.abs(z), np.abs(z - 2.6)], axis=0)
    wardrobe = np.min([np.abs(y - 3.3), np.abs(x + 1.3), np.abs(x + 0.3)], axis=0)
    return np.where(surface.is_object, np.minimum(room, wardrobe), room)


def test_points_lie_on_the_room_and_normals_look_to_the_camera() -> None:
    surface = surface_of(plain_shot())
    assert np.quantile(plane_distances(surface), 0.98) < 0.01
    known = (surface.normals != 0).any(axis=1)
    assert known.mean() > 0.95
    np.testing.assert_allclose(np.linalg.norm(surface.normals[known], axis=1), 1.0, atol=1e-9)
    toward = ((surface.camera_position - surface.points) * surface.normals)[known].sum(axis=1)
    assert (toward > 0).mean() > 0.99
    floor = known & (surface.points[:, 2] < 0.01)
    assert np.median(surface.normals[floor, 2]) > 0.999
    assert surface.noise < 1e-3


def test_the_far_walls_area_is_its_own() -> None:
    surface = surface_of(plain_shot())
    far = (np.abs(surface.points[:, 1] - 4.0) < 0.01) & ~surface.is_object
    # 4 x 2.6 m less the wardrobe's silhouette and what is cut off by the picture's sides.
    shown = surface.points[far]
    expected = np.ptp(shown[:, 0]) * np.ptp(shown[:, 2]) - 1.2 * 2.12
    assert surface.area_m2[far].sum() == pytest.approx(expected, rel=0.1)


def test_noise_is_measured_and_calmed() -> None:
    noisy = surface_of(plain_shot(0.01))
    assert noisy.noise == pytest.approx(0.01, rel=0.25)
    raw = plain_shot(0.01).inputs.depth_m
    true = plain_shot().inputs.depth_m
    calm, _, _ = calm_planes(raw.astype(float), plain_shot().camera.intrinsics)
    valid = true > 0
    assert np.median(np.abs(calm - true)[valid]) < 0.4 * np.median(np.abs(raw - true)[valid])


def test_a_plane_through_members_is_the_wall() -> None:
    surface = surface_of(plain_shot(0.01))
    far = (np.abs(surface.points[:, 1] - 4.0) < 0.15) & ~surface.is_object
    normal, offset = surface.world_plane(far)
    np.testing.assert_allclose(normal, [0, -1, 0], atol=0.02)
    assert offset == pytest.approx(-4.0, abs=0.02)


def test_blocks_average_one_surface_and_never_between_two() -> None:
    depth = np.full((6, 9), 2.0, np.float32)
    depth[:3, 3:6] = np.array([[1.0, 3.0, 1.0], [1.0, 3.0, 1.0], [1.0, 3.0, 1.0]])
    depth[3:, :3] = [[0, 2.0, 0], [2.05, 1.95, 2.0], [0, 2.0, 2.0]]
    depth[3:, 3:6] = 0.0
    small, k = downsample_depth(depth, Intrinsics(9, 6, 9.0, 9.0, 4.5, 3.0), 3)
    assert small.shape == (2, 3)
    assert (k.width, k.height, k.fx, k.cx) == (3, 2, 3.0, 1.5)
    assert small[0, 1] == 3.0, "the middle sample"
    assert small[1, 0] == pytest.approx(6 / (4 / 2.0 + 1 / 2.05 + 1 / 1.95))
    assert small[1, 1] == 0.0
    same, unchanged = downsample_depth(depth, Intrinsics(9, 6, 9.0, 9.0, 4.5, 3.0), 9)
    np.testing.assert_array_equal(same, depth)
    assert unchanged.width == 9


def test_nothing_measured_gives_nothing() -> None:
    empty = measure_surface(np.zeros((120, 160), np.float32), look(size=(160, 120)), np.zeros((120, 160), dtype=bool))
    assert len(empty.points) == 0
    assert (empty.grid_rows, empty.grid_columns, empty.noise) == (120, 160, 0.0)
