"""Smooth normals: as the plain definition, face by face."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from diorama_core.render.appearance import CREASE_RAD, smooth_corner_normals


def by_definition(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """For every corner the sum of the area vectors at its place that meet its face within the crease angle."""
    a, b, c = (vertices[faces[:, k]].astype(float) for k in range(3))
    areas = np.cross(b - a, c - a)
    units = areas / np.linalg.norm(areas, axis=1, keepdims=True)
    places = np.round(vertices, 5)
    found = []
    for face, corners in enumerate(faces):
        for corner in corners:
            there = (places[faces] == places[corner]).all(axis=2).any(axis=1)
            near = there & (units @ units[face] > np.cos(CREASE_RAD))
            found.append(areas[near].sum(axis=0))
    return np.array(found) / np.linalg.norm(found, axis=1, keepdims=True)


@pytest.mark.parametrize(
    "mesh",
    [
        trimesh.creation.icosphere(subdivisions=2),
        trimesh.creation.box(),
        trimesh.creation.cylinder(0.4, 1.0, sections=24),
        trimesh.creation.cylinder(0.4, 1.0, sections=8),
        trimesh.creation.cone(0.4, 0.5, sections=16),
    ],
    ids=["smooth", "creased", "both", "near the angle", "a tip"],
)
def test_normals_join_the_faces_within_the_crease_angle(mesh: trimesh.Trimesh) -> None:
    vertices, faces = mesh.vertices.astype(np.float32), mesh.faces.astype(np.int32)
    np.testing.assert_allclose(smooth_corner_normals(vertices, faces), by_definition(vertices, faces), atol=1e-6)


def test_seams_of_the_mesh_are_no_creases() -> None:
    mesh = trimesh.creation.icosphere(subdivisions=1)
    apart = mesh.vertices[mesh.faces.reshape(-1)].astype(np.float32)
    own = np.arange(len(apart), dtype=np.int32).reshape(-1, 3)
    whole = smooth_corner_normals(mesh.vertices.astype(np.float32), mesh.faces.astype(np.int32))
    np.testing.assert_allclose(smooth_corner_normals(apart, own), whole, atol=1e-6)


def test_a_face_without_area_has_no_normal_of_its_own() -> None:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]], dtype=np.float32)
    normals = smooth_corner_normals(vertices, np.array([[0, 1, 2], [0, 1, 3]], dtype=np.int32))
    np.testing.assert_allclose(normals[:3], [[0, 0, 1]] * 3)
    np.testing.assert_allclose(normals[3:], np.zeros((3, 3)))


def test_no_faces_give_no_normals() -> None:
    assert smooth_corner_normals(np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int32)).shape == (0, 3)
