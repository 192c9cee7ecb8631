"""Convex bodies of simulators' files: closed, outward, and the same at any scale; those of the room's planes."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull

from diorama_core.export.bodies import (
    CLEAR_M,
    GROUND_BEYOND_M,
    MIN_SLAB_M,
    barriers,
    ground_piece,
    hull_faces,
    hull_volume,
    slab_pieces,
)
from diorama_core.scene.types import Architecture, Plane
from tests.primitives import box_room

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


def test_a_wall_is_one_prism_and_one_around_a_hole_leaves_it_open() -> None:
    wall = next(p for p in box_room().planes if p.role == "wall")
    (piece,) = slab_pieces(wall)
    size = np.ptp(wall.polygon, axis=0)
    area = float(np.linalg.norm(size[:2]) * size[2])
    assert hull_volume(piece) == pytest.approx(area * max(wall.thickness, MIN_SLAB_M), rel=1e-6)
    door = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 2], [2, 0, 2], [2, 0, 0], [4, 0, 0], [4, 0, 3], [0, 0, 3]], float)
    pieces = slab_pieces(Plane("w", "wall", door))
    assert sum(map(hull_volume, pieces)) == pytest.approx((12 - 2) * MIN_SLAB_M, rel=1e-6)


def test_the_floor_reaches_beyond_the_room() -> None:
    floor = next(p for p in box_room().planes if p.role == "floor")
    (ground,) = ground_piece(floor)
    assert np.ptp(ground[:, 0]) == pytest.approx(np.ptp(floor.polygon[:, 0]) + 2 * GROUND_BEYOND_M)


def test_where_a_wall_is_missing_a_barrier_stands_beyond_what_reaches_out_there() -> None:
    room = box_room()
    assert barriers(room, ()) == ()
    wall = next(p for p in room.planes if p.role == "wall")
    open_room = Architecture(tuple(p for p in room.planes if p is not wall))
    (near,) = barriers(open_room, ())
    assert float((near.plane.centre - wall.centre) @ wall.normal) == pytest.approx(-CLEAR_M)
    foot = wall.centre + np.array([0.0, 0.0, wall.polygon[:, 2].min() - wall.centre[2]])
    cube = np.array(list(itertools.product((-0.3, 0.3), repeat=3)))
    (far,) = barriers(open_room, [cube + foot, cube + foot - 0.5 * wall.normal, cube + foot + 2.0 * wall.normal])
    assert float((far.plane.centre - wall.centre) @ wall.normal) == pytest.approx(-0.8 - CLEAR_M)
    assert far.plane.normal @ wall.normal == pytest.approx(1.0)
