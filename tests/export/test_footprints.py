"""Outlines from above."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.export.footprints import GRID_M, _is_closed, footprints, outline
from diorama_core.export.gathering import gather
from diorama_core.geometry.planes import signed_area
from diorama_core.scene.types import Pose, Scene
from tests.primitives import PrimitiveLibrary, furnished_room, place

LIBRARY = PrimitiveLibrary()


def test_outlines_cover_what_the_mesh_covers() -> None:
    scene = furnished_room(LIBRARY)
    found = footprints(gather(scene, LIBRARY))
    for item in scene.objects:
        points = item.pose.apply(LIBRARY.mesh(item.shape_id).vertices)[:, :2]
        mine = np.concatenate(found[item.id])
        np.testing.assert_allclose(mine.min(axis=0), points.min(axis=0), atol=0.005)
        np.testing.assert_allclose(mine.max(axis=0), points.max(axis=0), atol=0.005)


def test_a_table_is_its_top() -> None:
    scene = Scene(objects=(place(LIBRARY, "t", "table", (0, 0, 0.36)),))
    (polygon,) = footprints(gather(scene, LIBRARY))["t"]
    assert signed_area(polygon) == pytest.approx(0.8 * 1.4, rel=0.01)


def test_a_tilted_object_is_seen_as_it_lies() -> None:
    table = place(LIBRARY, "t", "table", (0, 0, 0.4))
    R = np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]], float)  # on its side: its height lies along x
    lying = replace(table, pose=Pose(R, np.array([0.0, 0.0, 0.4]), np.ones(3)))
    points = np.concatenate(footprints(gather(Scene(objects=(lying,)), LIBRARY))["t"])
    np.testing.assert_allclose(np.ptp(points, axis=0), [0.72, 1.4], atol=0.005)


@settings(max_examples=25)
@given(st.integers(0, 10_000), st.floats(0, 6.28))
def test_turning_triangles_turns_the_outline(seed: int, angle: float) -> None:
    triangles = np.random.default_rng(seed).uniform(-1, 1, (6, 3, 2))
    R = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    area = sum(signed_area(p) for p in outline(triangles))
    assert sum(signed_area(p) for p in outline(triangles @ R.T)) == pytest.approx(area, abs=0.06)


def test_nothing_flat_is_left() -> None:
    upright = np.array([[[0, 0], [1, 0], [0.5, 0]]], float)
    assert outline(upright) == ()


def covered(triangles: np.ndarray) -> float:
    return sum(signed_area(p) for p in outline(triangles))


@settings(max_examples=25)
@given(st.integers(0, 10_000))
def test_closed_bodies_cover_what_all_their_triangles_cover(seed: int) -> None:
    """Half the triangles are enough there; without one triangle the body is open, and all of them are needed."""
    rng = np.random.default_rng(seed)
    turns = [trimesh.transformations.random_rotation_matrix(rng.random(3)) for _ in range(3)]
    bodies = [trimesh.creation.box(rng.uniform(0.1, 1, 3), turn) for turn in turns]
    corners = [np.asarray(body.triangles)[:, :, :2] + rng.uniform(-0.5, 0.5, 2) for body in bodies]
    closed = np.concatenate(corners)
    cells = np.round(closed / GRID_M).astype(np.int64)
    assert _is_closed(cells)
    assert not _is_closed(cells[1:])
    tiny = np.array([[[9.0, 9.0], [9.1, 9.0], [9.0, 9.1]]])  # opens the set, elsewhere
    assert covered(closed) == pytest.approx(covered(np.concatenate([closed, tiny])) - covered(tiny), abs=1e-4)


def test_a_sheet_that_faces_down_covers_the_floor_too() -> None:
    sheet = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)
    assert covered(sheet) == pytest.approx(1.0)
    assert covered(sheet[:, ::-1]) == pytest.approx(1.0)
