from __future__ import annotations

import numpy as np
import pytest

from diorama_core.geometry.observed import Observed, observe
from diorama_core.geometry.projection import box_iou
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.pose.hypotheses import Anchor
from diorama_core.pose.limits import SizeLimits
from diorama_core.pose.refine import BoxFit
from diorama_core.scene.types import yaw_rotation
from tests.pose.rooms import LIBRARY, Room, camera_at, standing

ROOM = Room(camera_at(1.2, 18.0, (240, 180)), (standing("desk", 0.1, 2.6, 20.0),), (0,))
TRUE, ITEM = ROOM.placed[0].pose, ROOM.objects[0]
CASTER = ShapeCaster(LIBRARY.mesh("desk"))
FLOOR = Anchor(np.array([0.0, 0.0, 1.0]), np.zeros(3))
LIMITS = SizeLimits.of(LIBRARY.shape("desk").size_m, "desk", ROOM.placed[0].size_m)


def seen(*nearer: np.ndarray) -> Observed:
    return observe(ROOM.camera, ITEM.box, ITEM.mask, 1.0, nearer, 48)


def fit(observed: Observed | None = None, **more) -> BoxFit:
    return BoxFit(ROOM.camera, observed or seen(), FLOOR, LIMITS, np.deg2rad(4.0), **more)


def batch(*starts: tuple[float, float, float, float]) -> PoseBatch:
    """The true pose with (x, y) offsets, a factor of size and a turn in degrees, standing on the floor."""
    R = np.array([yaw_rotation(TRUE.yaw_rad + np.deg2rad(turn)) for *_, turn in starts])
    scale = np.array([np.full(3, factor) for *_, factor, _ in starts])
    offsets = np.array([[x, y, 0.0] for x, y, *_ in starts])
    sizes = scale * LIBRARY.shape("desk").size_m
    return PoseBatch(R, FLOOR.place_centres(TRUE.position + offsets, R, sizes), scale)


def ious(poses: PoseBatch) -> np.ndarray:
    return box_iou(CASTER.bounds_px(ROOM.camera, poses), np.array(ITEM.box))


def test_poses_are_corrected_toward_the_box_and_stay_on_the_floor() -> None:
    start = batch((0.15, 0.1, 1.0, 3.0), (-0.1, 0.3, 0.9, 0.0), (0.0, 0.0, 1.15, -5.0))
    found = fit().refine(CASTER, start)
    assert (ious(found) > ious(start)).all()
    assert ious(found).min() > 0.93
    low = [CASTER.mesh.vertices if hasattr(CASTER, "mesh") else LIBRARY.mesh("desk").vertices][0]
    for R, position, scale in zip(found.R, found.position, found.scale, strict=True):
        assert ((low * scale) @ R.T + position)[:, 2].min() == pytest.approx(0.0, abs=1e-6)
        np.testing.assert_allclose(R @ [0, 0, 1], [0, 0, 1], atol=1e-9)


def test_a_pose_that_fits_stays_where_it_is() -> None:
    found = fit().refine(CASTER, batch((0.0, 0.0, 1.0, 0.0)))
    np.testing.assert_allclose(found.position[0], TRUE.position, atol=0.03)
    np.testing.assert_allclose(found.scale[0], 1.0, atol=0.03)


def test_without_iterations_nothing_changes() -> None:
    start = batch((0.15, 0.1, 1.0, 3.0))
    found = fit(iterations=0).refine(CASTER, start)
    np.testing.assert_allclose(found.position, start.position)
    np.testing.assert_allclose(found.R, start.R)


def test_sizes_stay_within_what_the_category_allows() -> None:
    small = batch((0.0, -1.2, 1.0, 0.0))
    found = fit(iterations=8).refine(CASTER, small)
    sizes = found.scale[0] * LIMITS.shape_size_m
    assert (sizes >= LIMITS.min_m - 1e-9).all()
    assert (sizes <= LIMITS.max_m + 1e-9).all()


def test_a_hidden_side_pulls_less() -> None:
    x1, _, x2, _ = ITEM.box
    curtain = np.zeros_like(ITEM.mask)
    curtain[:, : int(x1 + 0.3 * (x2 - x1))] = True
    start = batch((-0.25, 0.0, 1.0, 0.0))
    free = fit().refine(CASTER, start)
    hidden = fit(seen(curtain)).refine(CASTER, start)

    def left(poses: PoseBatch) -> float:
        return float(CASTER.bounds_px(ROOM.camera, poses)[0, 0])

    assert left(start) < x1
    assert left(free) == pytest.approx(x1, abs=4.0)
    assert left(hidden) < left(free) - 1.0


def test_things_on_walls_are_corrected_along_the_wall() -> None:
    onto_wall = Anchor(np.array([0.0, -1.0, 0.0]), np.array([0.0, 3.0, 0.0]))
    start = batch((0.1, 0.0, 1.0, 0.0))
    made = BoxFit(ROOM.camera, seen(), onto_wall, LIMITS, 0.05).refine(CASTER, start)
    reach = 0.5 * (np.abs(made.R[0].T @ onto_wall.axis_world) * made.scale[0] * LIMITS.shape_size_m).sum()
    assert made.position[0, 1] + reach == pytest.approx(3.0, abs=1e-6)


def test_an_object_whose_foot_is_not_seen_stays_at_its_distance() -> None:
    start = batch((-0.05, 0.4, 0.85, 0.0))
    away = TRUE.position[:2] / np.linalg.norm(TRUE.position[:2])
    moved = [
        abs(float((fit(foot_seen=seen_).refine(CASTER, start).position[0] - start.position[0])[:2] @ away))
        for seen_ in (True, False)
    ]
    assert moved[1] < 0.4 * moved[0]
