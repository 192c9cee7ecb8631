"""Boxes around what stands in a scanned room."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from shapely.geometry import box

from diorama_core.importing.scanned_boxes import ScannedRoom, apart_from_tops, boxes_in, find_rugs, rugs_in

ROOM = ScannedRoom(box(-2.0, -2.0, 2.0, 2.0), 2.5)


def block(low: tuple[float, float, float], high: tuple[float, float, float]) -> np.ndarray:
    """Points on the faces of a block."""
    rng = np.random.default_rng(3)
    points = rng.uniform(low, high, (4000, 3))
    face = rng.integers(0, 3, 4000)
    points[np.arange(4000), face] = np.where(rng.random(4000) < 0.5, np.array(low)[face], np.array(high)[face])
    return points


def test_a_block_at_a_wall_has_its_back_there() -> None:
    boxes, left_out = boxes_in(block((-1.98, -0.6, 0.0), (-1.5, 0.6, 1.8)), ROOM)
    assert left_out == 0
    (found,) = boxes
    assert np.allclose(found.centre, [-1.72, 0.0, 0.9], atol=0.06)
    assert found.size_m == pytest.approx([0.45, 1.2, 1.8], abs=0.08)
    assert found.R_world_box[:, 0] == pytest.approx([1.0, 0.0, 0.0], abs=1e-6)


def test_what_is_small_or_a_wall_is_none() -> None:
    assert boxes_in(block((0.0, 0.0, 0.5), (0.08, 0.08, 0.6)), ROOM) == ((), 0)
    assert boxes_in(block((0.0, -1.0, 0.0), (0.03, 1.0, 2.45)), ROOM) == ((), 0)
    assert rugs_in(block((0.0, 0.0, 0.0), (0.5, 0.5, 0.5)), ROOM) == ()


def test_what_stands_on_nothing_is_of_no_kind() -> None:
    (floating,), _ = boxes_in(block((0.0, 0.0, 1.1), (0.3, 0.3, 1.6)), ROOM)
    assert dict(floating.kinds) == {"object": 1.0}
    (hung,), _ = boxes_in(block((-1.95, 0.0, 1.3), (-1.7, 0.3, 1.75)), ROOM)
    assert len(hung.kinds) > 1
    (lamp,), _ = boxes_in(block((0.0, 0.0, 1.5), (0.3, 0.3, 1.75)), ROOM)
    assert "ceiling lamp" in lamp.kinds


def floor(noise_m: float = 0.002) -> np.ndarray:
    """Points of a floor of 4 x 4 m."""
    rng = np.random.default_rng(0)
    return np.column_stack([rng.uniform(-2, 2, (6000, 2)), rng.normal(0, noise_m, 6000)])


def with_rug(points: np.ndarray, half: tuple[float, float], height_m: float = 0.015) -> np.ndarray:
    """The floor, higher by the rug where that lies."""
    on_it = (np.abs(points[:, :2]) < half).all(axis=1)
    return points + np.where(on_it[:, None], [0.0, 0.0, height_m], 0.0)


def test_what_lies_level_and_a_little_higher_is_a_rug() -> None:
    (rug,) = find_rugs(with_rug(floor(), (0.7, 1.1)))
    assert np.ptp(rug[:, :2], axis=0).round(1).tolist() == [1.4, 2.2]


def test_furniture_on_it_hides_a_part_of_a_rug() -> None:
    points = with_rug(floor(), (0.7, 1.1))
    hidden = (points[:, 0] < 0.3) & (np.abs(points[:, 1]) < 0.7)
    (rug,) = find_rugs(points[~hidden])
    assert np.ptp(rug[:, :2], axis=0).round(1).tolist() == [1.4, 2.2]


def test_noise_slopes_borders_and_edges_are_no_rugs() -> None:
    assert not find_rugs(floor(0.01))
    assert not find_rugs(with_rug(floor(0.01), (0.7, 1.1)))  # lost in the noise
    points = floor()
    assert not find_rugs(points + points[:, :1] * [0.0, 0.0, 0.01])  # a floor that slopes
    frame = with_rug(points, (1.5, 1.5)) - with_rug(points, (1.2, 1.2)) * [0, 0, 1.0]
    assert not find_rugs(np.column_stack([points[:, :2], np.abs(frame[:, 2]) + points[:, 2]]))  # bare floor inside
    assert not find_rugs(with_rug(points, (0.1, 1.5)))  # a threshold


def test_without_a_floor_there_is_no_rug() -> None:
    assert find_rugs(np.empty((0, 3))) == []


def solid_block(low: tuple[float, float, float], high: tuple[float, float, float]) -> np.ndarray:
    """Points of a box's surface."""
    size, middle = np.subtract(high, low), np.add(low, high) / 2
    mesh = trimesh.creation.box(size, trimesh.transformations.translation_matrix(middle))
    return np.asarray(trimesh.sample.sample_surface(mesh, int(mesh.area * 3000) + 200, seed=2)[0])


CABINET = solid_block((0, 0, 0), (1.4, 0.45, 0.8))


def test_things_on_a_cabinet_are_things_of_their_own() -> None:
    vase, box = solid_block((0.2, 0.1, 0.8), (0.4, 0.3, 1.1)), solid_block((0.8, 0.1, 0.8), (1.2, 0.4, 1.0))
    cabinet, *tops = apart_from_tops(np.vstack([CABINET, vase, box]))
    assert np.ptp(cabinet[:, 2]) < 0.95
    assert len(tops) == 2
    assert sorted(round(float(t[:, 2].max()), 1) for t in tops) == [1.0, 1.1]


def test_backs_and_heads_belong_to_what_they_are_of() -> None:
    seat, back = solid_block((0, 0, 0), (0.9, 2.0, 0.45)), solid_block((0, 0, 0.45), (0.25, 2.0, 0.9))
    assert len(apart_from_tops(np.vstack([seat, back]))) == 1


def test_a_whole_thing_stays_whole() -> None:
    assert len(apart_from_tops(CABINET)) == 1
    shelves = np.vstack([solid_block((0, 0, z), (1.0, 0.3, z + 0.02)) for z in (0.0, 0.4, 0.8, 1.2, 1.6)])
    assert len(apart_from_tops(shelves)) == 1


def test_no_point_is_lost_or_doubled() -> None:
    whole = np.vstack([CABINET, solid_block((0.2, 0.1, 0.8), (0.5, 0.3, 1.2))])
    parts = apart_from_tops(whole)
    assert len(parts) == 2
    assert sum(map(len, parts)) == len(whole)
