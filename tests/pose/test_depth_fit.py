"""Shapes fitted to rendered depth with exact truth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from diorama_core.arrangement.facing.evidence import WallSamples
from diorama_core.artefacts import DepthMap
from diorama_core.geometry.observed import observe_among
from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.pose.depth_fit import DepthFit, SeenOutline
from diorama_core.pose.hypotheses import anchor_of
from diorama_core.pose.limits import SizeLimits
from diorama_core.pose.mask_observations import Evidence
from diorama_core.pose.measured import MeasuredObject, foot_height_m
from diorama_core.pose.surface import measure_surface, noise_of
from diorama_core.scene.types import yaw_rotation
from tests.pose.rooms import LIBRARY, Room, camera_at, standing, yaw_error_deg

NO_WALLS = WallSamples(np.zeros((0, 2)), np.zeros((0, 2)))


def measured(
    room: Room, index: int = 0, depth: DepthMap | None = None, floor_foot_m: float | None = None
) -> MeasuredObject:
    """The first thing of a room as depth shows it, with its true cuboid."""
    item, cuboid = room.objects[index], room.geometry.cuboids[index]
    centres = np.array([c.centre for c in room.geometry.cuboids])
    seen = observe_among(room.camera, room.objects, centres, [None] * len(centres), index, 56)
    depth = depth or room.depth(True)
    surface = measure_surface(depth, seen, item.mask, noise_of(depth))
    evidence = Evidence(room.camera, seen, surface)
    anchor = anchor_of(cuboid, False, room.camera.position[:2] - cuboid.centre[:2])
    found = MeasuredObject.of(item.mask, evidence, cuboid, anchor, NO_WALLS, floor_foot_m)
    assert found is not None
    return found


def fit_of(room: Room, **settings) -> tuple[DepthFit, ShapeCaster]:
    shape = LIBRARY.shape(room.placed[0].shape_id)
    limits = SizeLimits.of(shape.size_m, shape.category, room.geometry.cuboids[0].size_m)
    return measured(room, **settings).fit(limits), ShapeCaster(LIBRARY.mesh(shape.id))


@settings(max_examples=12)
@given(
    st.floats(-180, 180),
    st.tuples(st.floats(-0.12, 0.12), st.floats(-0.12, 0.12), st.floats(-0.05, 0.05)),
    st.floats(-14, 14),
    st.floats(0.88, 1.12),
)
def test_a_displaced_chair_finds_back(yaw: float, shift: tuple, turn: float, factor: float) -> None:
    room = Room(camera_at(), (standing("chair", 0.2, 2.6, yaw),), (0,))
    fit, caster = fit_of(room)
    true = room.placed[0].pose
    start = PoseBatch(
        (yaw_rotation(np.deg2rad(turn)) @ true.R_world_object)[None],
        (true.position + shift)[None],
        true.scale[None] * factor,
    )
    found = fit.refine(caster, start)
    before, after = (float(np.linalg.norm(p.position[0] - true.position)) for p in (start, found))
    assert after < max(0.3 * before, 0.03)
    assert yaw_error_deg(replace(true, R_world_object=found.R[0]), true, 1) < 5.0
    assert np.abs(found.scale[0] / true.scale - 1).max() < 0.1


def test_a_stretched_table_is_measured_along_every_axis() -> None:
    room = Room(camera_at(), (standing("table", 0.0, 3.0, 25.0, (1.1, 0.9, 1.08)),), (0,))
    fit, caster = fit_of(room)
    true = room.placed[0].pose
    found = fit.refine(caster, fit.starts(true.R_world_object[None]))
    assert np.abs(found.scale[0] / true.scale - 1).max() < 0.05
    assert np.linalg.norm(found.position[0] - true.position) < 0.03


def test_noise_and_holes_in_the_depth_are_survived() -> None:
    room = Room(camera_at(), (standing("chair", 0.0, 2.6, 40.0),), (0,))
    exact = room.depth(True)
    rng = np.random.default_rng(3)
    noisy = exact.depth_m * (1 + 0.05 * rng.standard_normal(exact.depth_m.shape))
    noisy[rng.random(noisy.shape) < 0.3] = 0.0
    fit, caster = fit_of(room, depth=replace(exact, depth_m=noisy.astype(np.float32)))
    true = room.placed[0].pose
    found = fit.refine(caster, fit.starts(true.R_world_object[None]))
    assert np.linalg.norm(found.position[0] - true.position) < 0.06
    assert np.abs(found.scale[0] / true.scale - 1).max() < 0.12


def test_turns_all_around_contain_the_truth() -> None:
    room = Room(camera_at(), (standing("chair", 0.0, 2.6, 100.0),), (0,))
    shape = LIBRARY.shape("chair")
    limits = SizeLimits.of(shape.size_m, shape.category, room.geometry.cuboids[0].size_m)
    tried = measured(room).hypotheses(shape.symmetry, limits)
    true = room.placed[0].pose
    errors = [yaw_error_deg(replace(true, R_world_object=R), true, 1) for R in tried.poses.R]
    assert len(errors) == 24
    best = int(np.argmin(errors))
    assert errors[best] <= 7.6
    assert np.linalg.norm(tried.poses.position[best] - true.position) < 0.12


def test_outlines_know_what_the_border_and_nearer_objects_may_hide() -> None:
    alone = Room(camera_at(), (standing("chair", 0.0, 3.0, 30.0),), (0,))
    outline = measured(alone).outline
    assert outline is not None
    assert outline.known.all()
    behind = Room(camera_at(), (standing("chair", 0.0, 4.2, 30.0), standing("sofa", 0.0, 2.9, -90.0)), (0, 2))
    hidden = measured(behind).outline
    assert hidden is not None
    assert hidden.upper_end_seen
    assert not hidden.lower_end_seen


def test_outlines_reach_to_the_edges_of_the_pixels() -> None:
    room = Room(camera_at(), (standing("chair", 0.0, 3.0, 30.0),), (0,))
    outline = measured(room).outline
    assert outline is not None
    rows, columns = np.nonzero(room.objects[0].mask)
    assert outline.reach_px[0] == pytest.approx(columns.max() + 1)
    assert outline.reach_px[4] == pytest.approx(rows.max() + 1)
    assert SeenOutline.of(measured(room).observations.seen, np.zeros_like(room.objects[0].mask)) is None


def test_where_its_foot_is_hidden_an_object_may_stand_anywhere_below() -> None:
    seen_foot = Room(camera_at(), (standing("chair", 0.0, 3.0, 30.0),), (0,))
    hidden_foot = Room(camera_at(), (standing("chair", 0.0, 4.2, 30.0), standing("sofa", 0.0, 2.9, -90.0)), (0, 2))
    sure, unsure = measured(seen_foot).contact, measured(hidden_foot).contact
    assert sure.anchor.point_world[2] == pytest.approx(0.0, abs=1e-6)
    assert unsure.sigma_m > 3 * sure.sigma_m


def test_hardly_any_depth_is_no_measurement() -> None:
    room = Room(camera_at(), (standing("chair", 0.0, 2.6, 40.0),), (0,))
    whole = measured(room)
    few = replace(whole.points, **{k: a[:3] for k, a in vars(whole.points).items() if isinstance(a, np.ndarray)})
    assert len(few.depth_m) == 3
    mask = np.zeros_like(room.objects[0].mask)
    assert whole.observations.surface is not None
    blind = replace(whole.observations, surface=replace(whole.observations.surface, weight=np.zeros(56 * 56)))
    assert MeasuredObject.of(mask, blind, whole.cuboid, whole.contact.anchor, NO_WALLS) is None


def test_the_foot_of_a_table_is_where_its_thin_legs_end() -> None:
    room = Room(camera_at(), (standing("table", 0.0, 3.0, 20.0),), (0,))
    height = foot_height_m(room.depth(True), room.objects[0].mask, room.camera)
    assert height == pytest.approx(0.0, abs=0.05)
    assert foot_height_m(room.depth(True), np.zeros_like(room.objects[0].mask), room.camera) is None


def test_an_object_that_is_measured_above_the_floor_does_not_stand_on_it() -> None:
    room = Room(camera_at(), (standing("carton", 0.0, 3.0, 20.0),), (0,))
    lifted = measured(room, floor_foot_m=0.3)
    points = lifted.points.span(np.eye(3)[None])[0][0, 2]
    assert lifted.contact.anchor.point_world[2] == pytest.approx(min(float(points), 0.3), abs=0.06)
    assert measured(room, floor_foot_m=0.01).contact.anchor.point_world[2] == pytest.approx(0.0, abs=1e-6)


def test_poses_away_from_the_measured_box_cost_as_much_as_they_disagree() -> None:
    room = Room(camera_at(), (standing("desk", 0.2, 2.6, 30.0),), (1,))
    shape, seen = LIBRARY.shape("desk"), measured(room)
    limits = SizeLimits.of(shape.size_m, shape.category, room.geometry.cuboids[0].size_m)
    true = room.placed[0].pose
    width = shape.size_m[1] * true.scale[1]
    along = true.R_world_object[:, 1] * width
    places = np.array([true.position, true.position + 0.5 * along, true.position + 1.5 * along])
    poses = PoseBatch(np.tile(true.R_world_object, (3, 1, 1)), places, np.tile(true.scale, (3, 1)))
    cost = seen.elsewhere_cost(poses, limits, np.full(3, 0.9))
    assert cost[0] == pytest.approx(0.0, abs=1e-9)
    assert cost[1] == pytest.approx(2 / 3 * cost[2]), "half of either box is a third of both"
    assert cost[2] > 2.0
    np.testing.assert_allclose(seen.elsewhere_cost(poses, limits, np.full(3, 0.3)), cost / 9)


@settings(max_examples=25)
@given(st.floats(-180, 180), st.floats(-1, 1), st.floats(-1, 1), st.floats(0.5, 2.0))
def test_no_box_is_nearer_to_the_measured_one_than_itself(yaw: float, x: float, y: float, scale: float) -> None:
    room = Room(camera_at(), (standing("desk", 0.2, 2.6, 30.0),), (0,))
    shape, seen = LIBRARY.shape("desk"), measured(room)
    limits = SizeLimits.of(shape.size_m, shape.category, room.geometry.cuboids[0].size_m)
    pose = PoseBatch(yaw_rotation(np.deg2rad(yaw))[None], np.array([[x, 2.0 + y, 0.4]]), np.full((1, 3), scale))
    (cost,) = seen.elsewhere_cost(pose, limits, np.ones(1))
    (most,) = seen.elsewhere_cost(PoseBatch(pose.R, pose.position + 100.0, pose.scale), limits, np.ones(1))
    assert -1e-9 <= cost <= most + 1e-9
