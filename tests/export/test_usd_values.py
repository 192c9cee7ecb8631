from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("pxr", reason="needs the extra 'usd'")

from pxr import Gf, Usd, UsdGeom

from diorama_core.export.usd_values import extent, integers, place, quaternion, vectors
from diorama_core.geometry.rotations import rotation_from_vector


@given(st.tuples(*[st.floats(-3, 3)] * 3).map(np.array), st.tuples(*[st.floats(-9, 9)] * 3).map(np.array))
def test_a_prim_is_placed_as_the_matrix_says(turn, position) -> None:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation_from_vector(turn), position
    stage = Usd.Stage.CreateInMemory()
    prim = UsdGeom.Xform.Define(stage, "/x")
    place(prim, T)
    # USD's matrices act on rows.
    np.testing.assert_allclose(np.array(prim.GetLocalTransformation()).T, T, atol=1e-6)
    q = quaternion(T[:3, :3])
    assert q.GetReal() >= -1e-12
    v = Gf.Rotation(q).TransformDir(Gf.Vec3d(1, 2, 3))
    np.testing.assert_allclose(v, T[:3, :3] @ [1, 2, 3], atol=1e-6)


def test_arrays_keep_their_numbers() -> None:
    points = np.array([[1.0, -2.0, 3.0], [0.5, 4.0, -1.0]])
    np.testing.assert_array_equal(np.array(vectors(points)), points)
    np.testing.assert_array_equal(np.array(extent(points)), [[0.5, -2, -1], [1, 4, 3]])
    assert list(integers(np.array([3, 1, 2], np.int64))) == [3, 1, 2]
    np.testing.assert_array_equal(np.array(vectors(points[:, ::-1])), points[:, ::-1])
