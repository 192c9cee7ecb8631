"""Flat things that were seen on another wall are as large as their boxes are there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.layout.on_walls import moved_to_wall
from diorama_core.scene.types import Pose, Scene
from tests.layout.feasible.test_photo_observations import looking_north, outline
from tests.layout.small_rooms import Room


def seen_too_far(room: Room, factor: float, shape: str = "picture_13") -> tuple[Scene, str, Pose]:
    """A thing on the far wall, so many times as far away and as large as it is; and where it is."""
    size = np.array(room.library.shape(shape).size_m)
    pose = Pose.upright((0.6, 2.5 - size[0] / 2, 1.6), -np.pi / 2)
    name = room.put(shape, (0, 0, 0), on="wall_2", relation="mounted on", pose=pose)
    scene = room.scene(camera=looking_north())
    eye = scene.camera.position
    box = tuple(outline(scene, name))
    far = Pose(pose.R_world_object, eye + factor * (pose.position - eye), factor * pose.scale)
    return replace(scene, objects=(replace(scene.object(name), pose=far, box_px=box),)), name, pose


def test_a_picture_comes_to_its_wall_with_its_size(room: Room) -> None:
    scene, name, pose = seen_too_far(room, 1.8)
    moved = moved_to_wall(scene, scene.object(name), scene.plane("wall_2")).object(name)
    assert np.allclose(moved.pose.position, pose.position, atol=0.03)
    assert np.allclose(moved.size_m[1:], np.array(room.library.shape("picture_13").size_m)[1:], rtol=0.05)
    assert np.allclose(moved.pose.R_world_object[:, 0], [0.0, -1.0, 0.0], atol=1e-9)


def test_sides_beyond_the_pictures_border_go_on(room: Room) -> None:
    scene, name, _ = seen_too_far(room, 1.8)
    item = scene.object(name)
    x1, y1, x2, y2 = item.box_px
    k = scene.camera.intrinsics
    cut = replace(item, box_px=(x1, y1, 0.5 * (x1 + x2), y2))
    narrow = replace(scene.camera, intrinsics=replace(k, width=round(0.5 * (x1 + x2))))
    scene = replace(scene, camera=narrow, objects=(cut,))
    moved = moved_to_wall(scene, cut, scene.plane("wall_2")).object(name)
    assert moved.size_m[1] > 0.8 * room.library.shape("picture_13").size_m[1]


def test_what_is_about_as_far_or_not_flat_or_without_a_box_stays(room: Room) -> None:
    scene, name, _ = seen_too_far(room, 1.1)
    assert moved_to_wall(scene, scene.object(name), scene.plane("wall_2")) == scene
    scene, name, _ = seen_too_far(Room(room.library), 1.8, "cup_21")
    assert moved_to_wall(scene, scene.object(name), scene.plane("wall_2")) == scene
    scene, name, _ = seen_too_far(Room(room.library), 1.8)
    unboxed = replace(scene.object(name), box_px=None)
    scene = replace(scene, objects=(unboxed,))
    assert moved_to_wall(scene, unboxed, scene.plane("wall_2")) == scene


def test_a_wall_that_its_lines_of_sight_do_not_meet_tells_nothing(room: Room) -> None:
    scene, name, _ = seen_too_far(room, 1.8)
    behind = scene.plane("wall_0")
    assert moved_to_wall(scene, scene.object(name), behind) == scene
