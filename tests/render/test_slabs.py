from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from diorama_core.io.srgb import srgb_to_linear
from diorama_core.render.slabs import plane_surfaces
from diorama_core.scene.types import Plane, SurfaceFinish

L_SHAPE = np.array([[0, 0, 0], [3, 0, 0], [3, 1, 0], [1, 1, 0], [1, 2, 0], [0, 2, 0]], dtype=float)
FLOOR = Plane("f", "floor", L_SHAPE, thickness=0.1, colour=(0.5, 0.25, 1.0))


def mesh(*surfaces) -> trimesh.Trimesh:
    return trimesh.util.concatenate([trimesh.Trimesh(s.vertices, s.faces, process=False) for s in surfaces])


@pytest.mark.parametrize("turn", [np.eye(3), np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])])
def test_face_and_rest_close_a_slab_behind_the_polygon(turn: np.ndarray) -> None:
    plane = replace(FLOOR, polygon=L_SHAPE @ turn.T + [1.0, 2.0, 3.0])
    front, rest = plane_surfaces(plane)
    whole = mesh(front, rest)
    whole.merge_vertices()
    assert whole.is_watertight
    assert whole.volume == pytest.approx(4.0 * 0.1, rel=1e-5)
    np.testing.assert_allclose(front.vertices @ plane.normal, plane.offset, atol=1e-5)
    assert (rest.vertices @ plane.normal).min() == pytest.approx(plane.offset - 0.1, abs=1e-5)
    np.testing.assert_allclose(mesh(front).area, 4.0, rtol=1e-5)
    np.testing.assert_allclose(mesh(front).face_normals, np.tile(plane.normal, (len(front.faces), 1)), atol=1e-5)


def test_normals_look_out_of_the_slab() -> None:
    front, rest = plane_surfaces(FLOOR)
    np.testing.assert_allclose(front.normals, np.tile([0, 0, 1], (6, 1)))
    faces = mesh(rest).face_normals
    np.testing.assert_allclose(rest.normals[rest.faces[:, 0]], faces, atol=1e-5)


def test_a_picture_lies_on_the_face_only() -> None:
    picture = np.zeros((8, 12, 3), np.uint8)
    front, rest = plane_surfaces(FLOOR, picture, photographed=False)
    assert front.material.texture is picture
    assert not front.material.photographed
    assert front.uv.shape == (6, 2)
    assert front.uv.min() == pytest.approx(0.0)
    assert front.uv.max() == pytest.approx(1.0)
    assert rest.material.texture is None
    assert rest.uv is None


def test_without_a_picture_the_planes_colour_is_linear() -> None:
    front, _ = plane_surfaces(FLOOR)
    np.testing.assert_allclose(front.material.colour, srgb_to_linear(np.array(FLOOR.colour)))
    assert front.uv is None
    assert plane_surfaces(replace(FLOOR, role="wall"))[0].material.roughness > front.material.roughness


def test_a_plain_colour_is_photographed_where_that_is_said_and_nobody_painted_it() -> None:
    front, rest = plane_surfaces(FLOOR, plain_photographed=True)
    assert front.material.photographed
    assert not rest.material.photographed
    painted = replace(FLOOR, finish=SurfaceFinish("paint", (0.5, 0.5, 0.5)))
    assert not plane_surfaces(painted, plain_photographed=True)[0].material.photographed
