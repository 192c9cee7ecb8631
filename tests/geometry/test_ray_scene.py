"""What rays meet of triangles."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from diorama_core.geometry.ray_scene import RayScene

CUBE = trimesh.creation.box((2.0, 2.0, 2.0))
DOWN = np.array([[0.1, 0.2, 5.0, 0.0, 0.0, -2.0], [3.0, 0.0, 5.0, 0.0, 0.0, -1.0]], np.float32)


@pytest.fixture(params=[0, 1])
def cube(request: pytest.FixtureRequest) -> RayScene:
    return RayScene(np.asarray(CUBE.vertices), np.asarray(CUBE.faces), threads=request.param)


def test_the_first_hit_is_told_in_lengths_of_the_ray(cube: RayScene) -> None:
    hits = cube.first_hits(DOWN)
    assert hits.distance[0] == pytest.approx(2.0)
    assert hits.is_hit.tolist() == [True, False]
    assert hits.distance[1] == np.inf
    assert np.abs(hits.normal[0]) == pytest.approx([0.0, 0.0, 1.0])
    corners = CUBE.vertices[CUBE.faces[hits.triangle[0]]]
    u, v = hits.barycentric[0]
    assert np.array([1 - u - v, u, v]) @ corners == pytest.approx([0.1, 0.2, 1.0], abs=1e-5)
    assert hits.select(hits.is_hit).distance.shape == (1,)


def test_hits_have_the_shape_of_the_rays(cube: RayScene) -> None:
    assert cube.first_hits(np.stack([DOWN, DOWN])).normal.shape == (2, 2, 3)


@pytest.mark.parametrize(("near", "far", "blocked"), [(0.0, np.inf, True), (0.0, 1.9, False), (2.5, 2.9, False)])
def test_only_what_is_between_two_distances_blocks(cube: RayScene, near: float, far: float, blocked: bool) -> None:
    assert cube.is_occluded(DOWN, near, far).tolist() == [blocked, False]


def test_all_hits_are_those_of_both_sides(cube: RayScene) -> None:
    ray, distance, triangle = cube.all_hits(DOWN)
    assert ray.tolist() == [0, 0]
    assert sorted(distance) == pytest.approx([2.0, 3.0])
    assert sorted(CUBE.face_normals[triangle][:, 2]) == pytest.approx([-1.0, 1.0])


def test_distances_are_to_the_surface(cube: RayScene) -> None:
    assert cube.distances(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 3.0]])) == pytest.approx([1.0, 2.0])


def test_nothing_is_met_where_there_is_no_triangle() -> None:
    empty = RayScene(np.zeros((0, 3)), np.zeros((0, 3), int))
    assert not empty.first_hits(DOWN).is_hit.any()
    assert not empty.is_occluded(DOWN).any()
