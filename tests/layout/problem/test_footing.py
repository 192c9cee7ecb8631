from __future__ import annotations

import numpy as np
import pytest
import trimesh

from diorama_core.geometry.convex import box_part, convex_parts
from diorama_core.layout.problem.footing import box_footing, footing_of, reach_of

DOWN = np.array([0.0, 0.0, -1.0])
TURNED = np.array([[np.sqrt(0.5), -np.sqrt(0.5), 0], [np.sqrt(0.5), np.sqrt(0.5), 0], [0, 0, 1]])
EAST = np.array([[1.0, 0.0, 0.0]])


def test_a_round_foot_reaches_its_radius_however_it_is_turned() -> None:
    disc = convex_parts(trimesh.creation.cylinder(radius=0.4, height=0.7, sections=48))
    for R in (np.eye(3), TURNED):
        # Convex parts contain the disc with a margin.
        assert 0.39 < reach_of(footing_of(disc, DOWN), R, np.ones(3), EAST)[0] < 0.46
    corners = box_footing(np.array([0.8, 0.8, 0.7]), DOWN)
    assert reach_of(corners, TURNED, np.ones(3), EAST)[0] == pytest.approx(0.4 * np.sqrt(2))


def test_a_shade_wider_than_its_foot_may_overhang() -> None:
    foot, shade = box_part((-0.1, -0.1, -0.3), (0.1, 0.1, 0.0)), box_part((-0.3, -0.3, 0.0), (0.3, 0.3, 0.3))
    lamp = (foot, shade)
    assert reach_of(footing_of(lamp, DOWN), np.eye(3), np.ones(3), EAST)[0] == pytest.approx(0.1)
    assert reach_of(footing_of(lamp, -DOWN), np.eye(3), np.ones(3), EAST)[0] == pytest.approx(0.3)


def test_scale_stretches_a_footing_along_its_own_axes() -> None:
    footing = box_footing(np.array([0.2, 0.4, 0.5]), DOWN)
    assert np.allclose(footing[:, 2], 0.0)
    reach = reach_of(footing, np.eye(3), np.array([2.0, 3.0, 9.0]), np.array([[1.0, 0, 0], [0, -1.0, 0]]))
    np.testing.assert_allclose(reach, [0.2, 0.6])
