"""Turns that a small part of the pixels tells, or colours alone, or nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import RankedShapes
from diorama_core.geometry.observed import observe
from diorama_core.geometry.shape_appearance import appearance_of
from diorama_core.geometry.silhouette import PoseBatch
from diorama_core.pose import RenderAndCompare
from diorama_core.pose.appearance_likelihood import AppearanceLikelihood, cells_for
from diorama_core.pose.surface import measured_surface
from diorama_core.progress import Progress
from diorama_core.scene.types import Pose
from tests.pose.rooms import LIBRARY, Room, camera_at, standing, yaw_error_deg

WHITE, WARM_FROM_LEFT = ((1.0, 1.0, 1.0), 0.0), ((0.62, 0.5, 0.32), 0.35)
"""Light: what it makes of white, and how much stronger it is on faces turned to the left."""


def alone(shape_id: str, yaw_deg: float, away_m: float = 2.2) -> Room:
    """One thing in front of a camera that looks a little down."""
    return Room(camera_at(1.2, 18.0), (standing(shape_id, 0.1, away_m, yaw_deg),), (0,))


def photo_of(room: Room, light=WHITE) -> np.ndarray:
    """The thing in its own colours under some light, sRGB."""
    item = room.placed[0]
    appearance = appearance_of(LIBRARY.parts(item.shape_id))
    k = room.camera.intrinsics
    x, y = np.meshgrid(np.arange(k.width) + 0.5, np.arange(k.height) + 0.5)
    directions = room.camera.rays(np.stack([x.ravel(), y.ravel()], axis=1))
    hits = appearance.caster.cast(room.camera.position, directions, batch(item.pose))
    colour, slope = light
    strength = 1.0 - slope * hits.normals_world[0, :, 0]
    linear = (appearance.face_rgba[np.where(hits.is_hit, hits.triangles, 0)[0], :3] / 255.0) ** 2.2 * colour
    shown = 255 * np.clip(linear * strength[:, None], 0, 1) ** (1 / 2.2)
    return np.where(hits.is_hit[0][:, None], shown, 120).reshape(k.height, k.width, 3).astype(np.uint8)


def batch(pose: Pose) -> PoseBatch:
    return PoseBatch(pose.R_world_object[None], pose.position[None], pose.scale[None])


def posed(room: Room, rgb: np.ndarray, noise: float = 0.0):
    depth = room.depth(True)
    if noise:
        factor = 1 + noise * np.random.default_rng(3).standard_normal(depth.depth_m.shape)
        depth = replace(depth, depth_m=(depth.depth_m * factor).astype(np.float32))
    inputs = replace(room.inputs, photo=replace(room.inputs.photo, rgb=rgb))
    stage = RenderAndCompare(LIBRARY)
    return stage.pose(inputs, room.objects, room.geometry, depth, room.ranked(), Progress())[0]


def error_deg(room: Room, found) -> float:
    item = room.placed[0]
    fold = LIBRARY.shape(item.shape_id).symmetry
    return yaw_error_deg(found.candidates[0].pose, item.pose, fold)


@pytest.mark.parametrize("yaw_deg", [-160, -75, 10, 65])
def test_a_handle_that_is_seen_tells_how_a_mug_is_turned(yaw_deg: int) -> None:
    room = alone("mug", yaw_deg)
    assert error_deg(room, posed(room, photo_of(room))) < 12.0


def test_a_handle_out_of_sight_is_taken_to_be_in_the_middle_of_where_it_can_be() -> None:
    errors = []
    for off in (-15, 0, 15):
        room = alone("mug", 90 + off)
        errors.append(error_deg(room, posed(room, photo_of(room))))
    assert max(errors) < 30.0


@pytest.mark.parametrize("light", [WHITE, WARM_FROM_LEFT], ids=["white", "warm from the left"])
@pytest.mark.parametrize("noise", [0.0, 0.05], ids=["calm", "noisy"])
@pytest.mark.parametrize("yaw_deg", [-60, 120])
def test_colours_alone_tell_front_from_back_in_any_light(yaw_deg: int, noise: float, light) -> None:
    room = alone("red front", yaw_deg)
    assert error_deg(room, posed(room, photo_of(room, light), noise)) < 20.0


def test_without_colours_in_the_picture_front_and_back_are_doubted() -> None:
    room = alone("red front", -60)
    told, untold = posed(room, photo_of(room)), posed(room, np.full_like(photo_of(room), 128))
    assert untold.confidence < told.confidence


def test_a_tripod_is_right_in_each_of_its_three_turns() -> None:
    for yaw_deg in (20, 80):
        room = alone("tripod", yaw_deg, 3.0)
        found = posed(room, photo_of(room))
        assert error_deg(room, found) < 15.0
        assert found.confidence > 0.6


@pytest.mark.parametrize(("thing", "shape_id", "yaw_deg"), [("chair", "sofa", -70), ("tripod", "carton", -90)])
def test_what_fits_badly_whichever_way_it_is_turned_stays_before_the_wall(thing: str, shape_id: str, yaw_deg) -> None:
    item = standing(thing, 0.1, 4.0, yaw_deg)
    wall = standing("carton", 0.0, 4.1 + item.size_m[0] / 2, -90, (0.25, 16.0, 7.5))
    room = Room(camera_at(1.4, 14.0), (item, wall), (0, 0))
    ranked = (RankedShapes("o0", ((shape_id, 1.0),)),)
    stage = RenderAndCompare(LIBRARY)
    (found,) = stage.pose(room.inputs, room.objects[:1], room.geometry, room.depth(True), ranked, Progress())
    assert np.linalg.norm(found.candidates[0].pose.position[:2] - item.pose.position[:2]) < 0.15


def appearance_likelihood(room: Room, rgb: np.ndarray) -> AppearanceLikelihood:
    item = room.objects[0]
    seen = observe(room.camera, item.box, item.mask, 1.0, (), cells_for(item.box))
    surface = measured_surface(room.depth(True), seen, item.mask, 0.0)
    assert surface is not None
    return AppearanceLikelihood.of(rgb, item.mask, seen, surface, room.placed[0].size_m)


def test_shapes_of_one_colour_are_compared_by_place_alone() -> None:
    room = alone("mug", 10)
    appearance = appearance_of(LIBRARY.parts("mug"))
    poses = batch(room.placed[0].pose).and_also(batch(Pose.upright(room.placed[0].pose.position, 1.0)))
    rng = np.random.default_rng(0)
    noise = rng.integers(0, 255, room.inputs.photo.rgb.shape).astype(np.uint8)
    plain, wild = (
        appearance_likelihood(room, rgb).log_likelihoods(appearance, poses) for rgb in (photo_of(room), noise)
    )
    assert np.array_equal(plain, wild)
    assert plain[0] > plain[1] + 1


def test_broken_pictures_and_shapes_without_colours_say_nothing() -> None:
    room = alone("red front", 30)
    appearance = appearance_of(LIBRARY.parts("red front"))
    bare = replace(appearance, face_rgba=np.zeros_like(appearance.face_rgba))
    black = appearance_likelihood(room, np.zeros_like(room.inputs.photo.rgb))
    poses = batch(room.placed[0].pose)
    assert np.isfinite(black.log_likelihoods(appearance, poses)).all()
    assert np.isfinite(black.log_likelihoods(bare, poses)).all()
