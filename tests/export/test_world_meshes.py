from __future__ import annotations

import numpy as np
import pytest

from diorama_core.errors import Cancelled
from diorama_core.export.world_meshes import Y_UP, world_meshes
from diorama_core.progress import CancelToken, Progress
from tests.export.scenes import gathered, scene_of


@pytest.fixture(scope="module")
def export():
    return gathered("primitives")


@pytest.mark.parametrize("R", [None, Y_UP])
def test_everything_is_where_the_scene_has_it(export, R) -> None:
    scene, _ = scene_of("primitives")
    turn = np.eye(3) if R is None else R
    found = {m.id: m for m in world_meshes(export, R=R)}
    assert list(found)[: len(export.planes)] == [p.id for p in export.planes]
    for item in scene.objects:
        points = np.concatenate([s.vertices for s in found[item.id].surfaces]) @ turn
        corners = item.corners_world
        np.testing.assert_allclose(points.min(axis=0), corners.min(axis=0), atol=0.02)
        np.testing.assert_allclose(points.max(axis=0), corners.max(axis=0), atol=0.02)


def test_normals_stay_unit_and_square_to_their_faces(export) -> None:
    for mesh in world_meshes(export):
        for s in mesh.surfaces:
            np.testing.assert_allclose(np.linalg.norm(s.normals, axis=1), 1.0, atol=1e-4)
    flat = next(m for m in world_meshes(export) if m.id == export.planes[0].id).surfaces[0]
    a, b, c = (flat.vertices[flat.faces[:, k]] for k in range(3))
    across = np.cross(b - a, c - a)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    np.testing.assert_allclose((across * flat.normals[flat.faces[:, 0]]).sum(axis=1), 1.0, atol=1e-4)


def test_y_up_turns_up_and_nothing_over() -> None:
    np.testing.assert_array_equal(Y_UP @ [0, 0, 1], [0, 1, 0])
    assert np.linalg.det(Y_UP) == pytest.approx(1.0)


def test_writing_can_be_stopped(export) -> None:
    token = CancelToken()
    token.cancel()
    with pytest.raises(Cancelled):
        next(world_meshes(export, Progress(token=token)))
