from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.library.furniture import solids
from diorama_core.library.furniture.solids import Solid

LENGTH = st.floats(0.02, 2.5)


def welded(solid: Solid) -> trimesh.Trimesh:
    mesh = trimesh.Trimesh(solid.vertices, solid.faces, process=False)
    mesh.merge_vertices(merge_tex=True, merge_norm=True, digits_vertex=6)
    mesh.update_faces(mesh.nondegenerate_faces())
    return mesh


SOLIDS = {
    "box": solids.box((0.4, 0.6, 0.2), 0.02, 2),
    "cushion": solids.cushion((0.5, 0.6, 0.15)),
    "pillow": solids.pillow((0.45, 0.45, 0.15)),
    "cylinder": solids.cylinder(0.1, 0.5),
    "lathe": solids.lathe([(0.1, 0), (0.2, 0.3), (0.05, 0.5)]),
    "ring": solids.lathe([(0.1, 0), (0.12, 0.2), (0.11, 0.2), (0.1, 0)]),
    "tube": solids.tube([(0, 0, 0), (0, 0, 1), (0, 1, 1)], 0.05),
    "beam": solids.beam((0, 0, 0), (1, 1, 1), 0.1, 0.05),
    "taper": solids.taper((0, 0, 0), (0.1, 0, 1), 0.03, 0.06),
    "prism": solids.prism(solids.rounded_rectangle(0.6, 1.0, 0.1), 0.03),
    "slab": solids.slab(np.array([[(x, y, 0.1 * x * y) for y in np.linspace(0, 1, 5)] for x in (0, 0.4, 1)]), 0.05),
}  # fmt: skip


@pytest.mark.parametrize("name", SOLIDS)
def test_closed_and_outward(name: str) -> None:
    mesh = welded(SOLIDS[name])
    assert mesh.is_watertight
    assert mesh.volume > 0


@pytest.mark.parametrize("name", SOLIDS)
def test_normals_agree_with_faces(name: str) -> None:
    solid = SOLIDS[name]
    corners = solid.vertices[solid.faces]
    face_normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    means = solid.normals[solid.faces].mean(axis=1)
    assert np.allclose(np.linalg.norm(solid.normals, axis=1), 1.0, atol=1e-6)
    assert ((face_normals * means).sum(axis=1) > 0).mean() > 0.99


@given(LENGTH, LENGTH, LENGTH, st.floats(0.001, 0.1), st.integers(1, 3))
def test_box_has_the_size_asked_for(x: float, y: float, z: float, radius: float, segments: int) -> None:
    solid = solids.box((x, y, z), radius, segments)
    assert np.allclose(np.ptp(solid.vertices, axis=0), (x, y, z), atol=1e-9)
    assert abs(solid.vertices[:, 2].min()) < 1e-9


@given(LENGTH, LENGTH, st.floats(0.02, 0.5), st.floats(2, 9), st.floats(2, 5))
def test_cushion_stays_inside_its_box_and_fills_it(x: float, y: float, z: float, square: float, puff: float) -> None:
    solid = solids.cushion((x, y, z), square, puff)
    assert (np.abs(solid.vertices[:, :2]) <= np.array([x, y]) / 2 + 1e-9).all()
    assert np.isclose(np.ptp(solid.vertices[:, 2]), z)


@given(st.sampled_from(sorted(SOLIDS)), st.sampled_from("xyz"), st.floats(-180, 180))
def test_turning_keeps_volume(name: str, axis: str, angle: float) -> None:
    before, after = SOLIDS[name], SOLIDS[name].turned(axis, angle)
    assert np.isclose(welded(after).volume, welded(before).volume, rtol=1e-6)


def test_mirroring_twice_is_identity_and_keeps_faces_outward() -> None:
    bent = solids.tube([(0, 0, 0), (0.2, 0.1, 0.3), (0.3, 0.4, 0.5)], 0.03)
    assert welded(bent.mirrored()).volume > 0
    assert np.allclose(bent.mirrored().mirrored().vertices, bent.vertices)


def test_bevels_keep_large_faces_flat() -> None:
    solid = solids.box((1.0, 1.0, 1.0), 0.01)
    top = solid.vertices[:, 2] > 1.0 - 1e-6
    assert (solid.normals[top][:, 2] > 0.95).all()


def test_smooth_profile_never_bulges_past_its_points() -> None:
    profile = ((0.4, 0.0), (0.1, 0.2), (0.1, 0.8), (0.3, 1.0))
    radii = [r for r, _ in solids.smooth_profile(profile, 6)]
    assert min(radii) >= 0.1 - 1e-9
    assert max(radii) <= 0.4 + 1e-9


VECTORS = st.lists(st.tuples(*[st.floats(-9, 9)] * 3), min_size=1, max_size=30).map(np.array)


@given(VECTORS)
def test_lengths_and_products_are_numpys(vectors: np.ndarray) -> None:
    other = np.roll(vectors, 1, axis=0)
    np.testing.assert_array_equal(solids.length(vectors), np.linalg.norm(vectors, axis=-1))
    np.testing.assert_array_equal(solids.cross(vectors, other), np.cross(vectors, other))
    np.testing.assert_array_equal(solids.cross(vectors, other[0]), np.cross(vectors, other[0]))
    # Of a single vector numpy multiplies and adds in one step where the processor can.
    np.testing.assert_allclose(solids.unit(vectors[0]), vectors[0] / max(np.linalg.norm(vectors[0]), 1e-12), rtol=1e-15)


@given(VECTORS, st.sampled_from([1.0, 1e7]))
def test_places_are_rows_in_order_also_where_one_number_cannot_tell_them(points: np.ndarray, spread: float) -> None:
    vertices = np.round(np.concatenate([points, points[::-1]]) * spread, 4)
    first, number = solids.places(vertices)
    keys = np.round(vertices * 1e5).astype(np.int64)
    np.testing.assert_array_equal(keys[first], np.unique(keys, axis=0))
    np.testing.assert_array_equal(keys[first][number], keys)


def normals_by_definition(faces: np.ndarray, doubled: np.ndarray, crease_rad: float) -> np.ndarray:
    """For every corner the sum over all faces at its vertex that meet its own face within the angle."""
    n = solids.unit(doubled)
    near = n @ n.T > np.cos(crease_rad)
    corners = [(f, vertex) for f in range(len(faces)) for vertex in faces[f]]
    return solids.unit(
        np.array([doubled[near[f] & (faces == vertex).any(axis=1)].sum(axis=0) for f, vertex in corners])
    )


@pytest.mark.parametrize("crease_deg", [20.0, 38.0, 70.0, 180.0])
@pytest.mark.parametrize("name", ["box", "taper", "beam", "ball"])
def test_corner_normals_are_means_within_the_crease(name: str, crease_deg: float) -> None:
    mesh = welded(SOLIDS[name] if name != "ball" else solids.ball(0.3, 3))
    mesh = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    doubled, crease = np.cross(b - a, c - a), np.deg2rad(crease_deg)
    found = solids._corner_normals(mesh.faces, doubled, crease, len(mesh.vertices))
    np.testing.assert_allclose(found, normals_by_definition(mesh.faces, doubled, crease), atol=1e-9)
