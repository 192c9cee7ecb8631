from __future__ import annotations

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull

from diorama_core.geometry.convex import (
    MAX_PARTS,
    box_part,
    convex_parts,
    hull_part,
    outer_polygon,
    prism_part,
    simplest_part,
)


def volume(part) -> float:
    return float(ConvexHull(part.vertices).volume)


def contains(parts, points: np.ndarray) -> np.ndarray:
    inside = np.zeros(len(points), dtype=bool)
    for part in parts:
        planes = ConvexHull(part.vertices).equations
        inside |= (points @ planes[:, :3].T + planes[:, 3] <= 1e-6).all(axis=1)
    return inside


def table() -> trimesh.Trimesh:
    boxes = [trimesh.creation.box(bounds=[[-0.5, -0.8, 0.7], [0.5, 0.8, 0.74]])]
    for x in (-0.5, 0.45):
        for y in (-0.8, 0.75):
            boxes.append(trimesh.creation.box(bounds=[[x, y, 0.0], [x + 0.05, y + 0.05, 0.7]]))
    return trimesh.util.concatenate(boxes)


def test_a_table_of_boxes_is_its_boxes() -> None:
    parts = convex_parts(table())
    assert len(parts) == 5
    assert all(len(p.vertices) == 8 and len(p.normals) == 3 for p in parts)
    assert sum(volume(p) for p in parts) == pytest.approx(1.0 * 1.6 * 0.04 + 4 * 0.05 * 0.05 * 0.7)


@pytest.mark.parametrize(
    "mesh",
    [
        table(),
        trimesh.creation.icosphere(3, 0.4),
        trimesh.creation.cylinder(0.2, 0.9, sections=40),
        trimesh.creation.cone(0.3, 0.8, sections=32),
        trimesh.creation.torus(0.5, 0.1),
        trimesh.creation.annulus(0.3, 0.35, 0.5),
    ],
)
def test_parts_contain_the_mesh(mesh: trimesh.Trimesh) -> None:
    parts = convex_parts(mesh)
    assert 1 <= len(parts) <= MAX_PARTS
    points, _ = trimesh.sample.sample_surface(mesh, 500, seed=1)
    assert contains(parts, np.asarray(points)).all()


@pytest.mark.parametrize("axis", [(1.0, 0.0, 0.0), (0.3, 1.0, 0.0), (1.0, 1.0, 0.0)])
def test_parts_of_lying_and_tilted_things_are_level_with_them(axis: tuple[float, float, float]) -> None:
    for degrees in (90.0, 75.0, 40.0):
        mesh = trimesh.creation.cylinder(0.2, 0.9, sections=36)
        mesh.apply_transform(trimesh.transformations.rotation_matrix(np.deg2rad(degrees), axis))
        parts = convex_parts(mesh)
        heights = np.concatenate([p.vertices[:, 2] for p in parts])
        assert (heights.min(), heights.max()) == pytest.approx((mesh.bounds[0, 2], mesh.bounds[1, 2]), abs=2e-5)
        assert contains(parts, np.asarray(mesh.vertices)).all()


def test_a_ring_keeps_its_hole() -> None:
    parts = convex_parts(trimesh.creation.torus(0.5, 0.06))
    assert not contains(parts, np.zeros((1, 3))).any()


def test_bodies_that_share_an_edge_stay_apart() -> None:
    left = trimesh.creation.box(bounds=[[0, 0, 0], [1, 1, 0.02]])
    back = trimesh.creation.box(bounds=[[-0.02, 0, 0], [0, 1, 1]])
    assert len(convex_parts(trimesh.util.concatenate([left, back]))) == 2


def test_a_bevelled_box_becomes_a_box() -> None:
    bevelled = trimesh.creation.box(extents=[1, 2, 0.5])
    points = np.vstack(
        [bevelled.vertices * [1, 1, 0.96], bevelled.vertices * [1, 0.98, 1], bevelled.vertices * [0.96, 1, 1]]
    )
    part = simplest_part(points)
    assert len(part.vertices) == 8
    assert np.allclose(np.abs(part.vertices).max(axis=0), [0.5, 1, 0.25])


def test_flat_objects_get_a_thickness() -> None:
    part = hull_part(np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]))
    assert np.ptp(part.vertices[:, 2]) > 0


def test_prism_and_box_agree() -> None:
    ring = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    prism, box = prism_part(ring, np.array([0, 0, 2.0])), box_part([-1, -1, 0], [1, 1, 2])
    assert len(prism.normals) == len(box.normals) == 3
    assert volume(prism) == pytest.approx(volume(box))


def test_outer_polygon_contains_the_circle() -> None:
    angles = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    eight = outer_polygon(circle, 8)
    assert len(eight) == 8
    sides = np.roll(eight, -1, axis=0) - eight
    for corner, side in zip(eight, sides):
        offset = circle - corner
        assert (side[0] * offset[:, 1] - side[1] * offset[:, 0] > -1e-9).all()


def test_no_faces_is_an_error() -> None:
    with pytest.raises(ValueError, match="without faces"):
        convex_parts(trimesh.Trimesh())
