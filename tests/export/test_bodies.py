"""Convex bodies of simulators' files: closed, outward, and the same at any scale."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull

from diorama_core.export.bodies import hull_faces

CUBE = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])


def body(points: np.ndarray) -> trimesh.Trimesh:
    return trimesh.Trimesh(*hull_faces(points), process=False)


@pytest.mark.parametrize("scale", [(1.0, 1.0, 1.0), (0.3, 2.0, 1e-3), (40.0, 0.01, 5.0)])
@pytest.mark.parametrize("points", ["box", "cloud", "turned"])
def test_hulls_are_closed_and_face_outward_at_any_scale(rng, points: str, scale: tuple[float, float, float]) -> None:
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    form = {"box": CUBE, "cloud": rng.normal(size=(20, 3)), "turned": CUBE @ turn.T}[points]
    placed = form * scale + rng.normal(size=3)
    found = body(placed)
    assert found.is_watertight
    assert found.is_winding_consistent
    assert found.volume == pytest.approx(ConvexHull(placed).volume, rel=1e-6)


def test_what_lies_inside_is_left_out() -> None:
    assert len(body(np.vstack([CUBE, [[0.5, 0.5, 0.5]]])).vertices) == 8


def test_bodies_that_are_mirrored_still_face_outward(rng) -> None:
    cloud = rng.normal(size=(12, 3))
    assert body(cloud).volume == pytest.approx(body(cloud * [-1.0, 1.0, 1.0]).volume)


def test_flat_sets_are_one_triangle() -> None:
    vertices, faces = hull_faces(CUBE[[0, 1, 2, 3]])
    assert (len(vertices), len(faces)) == (4, 1)
