"""Outlines from above."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.export.footprints import footprints, outline, signed_area
from diorama_core.export.gathering import gather
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


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 10_000), st.floats(0, 6.28))
def test_turning_triangles_turns_the_outline(seed: int, angle: float) -> None:
    triangles = np.random.default_rng(seed).uniform(-1, 1, (6, 3, 2))
    R = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    area = sum(signed_area(p) for p in outline(triangles))
    assert sum(signed_area(p) for p in outline(triangles @ R.T)) == pytest.approx(area, abs=0.06)


def test_nothing_flat_is_left() -> None:
    upright = np.array([[[0, 0], [1, 0], [0.5, 0]]], float)
    assert outline(upright) == ()
