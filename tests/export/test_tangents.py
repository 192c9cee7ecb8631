from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.export.tangents import tangents
from diorama_core.geometry.rotations import rotation_from_vector
from tests.export.surfaces import ball, quad


@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0), (0.3, -1.0, 0.6)])
def test_tangents_follow_u_and_the_sign_gives_v_as_pictures_have_it(turn) -> None:
    R = rotation_from_vector(np.array(turn))
    found = tangents(quad(turn=R))
    np.testing.assert_allclose(found[:, :3], np.tile(R[:, 0], (4, 1)), atol=1e-6)
    # The bitangent normal x tangent x sign points along falling v of the file, whose v grows downward.
    np.testing.assert_array_equal(found[:, 3], -1.0)


def test_a_mirrored_picture_turns_the_sign() -> None:
    surface = quad()
    mirrored = replace(surface, uv=surface.uv * np.array([-1, 1], np.float32))
    found = tangents(mirrored)
    np.testing.assert_allclose(found[:, :3], np.tile([-1, 0, 0], (4, 1)), atol=1e-6)
    np.testing.assert_array_equal(found[:, 3], -tangents(surface)[:, 3])


def test_they_are_unit_and_square_to_the_normals_even_without_information() -> None:
    surface = ball()
    blank = replace(surface, uv=np.zeros((len(surface.vertices), 2), np.float32))
    found = tangents(blank)
    assert np.isfinite(found).all()
    np.testing.assert_allclose(np.linalg.norm(found[:, :3], axis=1), 1.0, atol=1e-5)
    np.testing.assert_allclose((found[:, :3] * surface.normals).sum(axis=1), 0.0, atol=1e-5)
    assert set(found[:, 3]) <= {-1.0, 1.0}


def test_without_coordinates_there_is_nothing_to_follow() -> None:
    with pytest.raises(ValueError, match="texture coordinates"):
        tangents(quad(uv=False))
