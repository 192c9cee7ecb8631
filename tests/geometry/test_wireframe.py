"""Edges of boxes and planes in a picture."""

from __future__ import annotations

import numpy as np

from diorama_core.geometry.wireframe import box_edges, plane_edges, seen_segments
from diorama_core.scene.types import Camera, Intrinsics, Plane, box_corners


def _camera() -> Camera:
    """At the origin, looking along +X, with x of the picture along -Y."""
    T = np.eye(4)
    T[:3, :3] = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    return Camera(Intrinsics.from_fov(200, 100, np.pi / 2), T)


def test_a_box_has_twelve_edges_each_along_one_axis() -> None:
    edges = box_edges(box_corners((1.0, 2.0, 3.0)))
    lengths = np.abs(edges[:, 1] - edges[:, 0])
    assert edges.shape == (12, 2, 3)
    assert sorted(lengths.max(axis=1)) == [1.0] * 4 + [2.0] * 4 + [3.0] * 4
    assert np.allclose(lengths.sum(axis=1), lengths.max(axis=1))


def test_a_square_before_the_camera_lands_where_it_is_projected() -> None:
    square = Plane("wall_1", "wall", np.array([[2.0, 1, 0], [2.0, -1, 0], [2.0, -1, 1], [2.0, 1, 1]]))
    seen = seen_segments(_camera(), [plane_edges(square)])
    assert seen.shape == (4, 2, 2)
    assert np.allclose(seen[0], [[50.0, 50.0], [150.0, 50.0]])


def test_lines_are_cut_near_the_camera_and_left_out_behind_it() -> None:
    through = np.array([[[-3.0, 1.0, 0.0], [3.0, 1.0, 0.0]]])
    behind = np.array([[[-3.0, 1.0, 0.0], [-1.0, 1.0, 0.0]]])
    seen = seen_segments(_camera(), [through, behind])
    assert seen.shape == (1, 2, 2)
    far = seen[0][np.abs(seen[0, :, 0] - 100 + 100 / 3) < 1e-6]
    near = seen[0][np.abs(seen[0, :, 0] - 100 + 100 / 0.05) < 1e-3]
    assert len(far) == len(near) == 1


def test_nothing_is_seen_of_nothing() -> None:
    assert seen_segments(_camera(), []).shape == (0, 2, 2)
