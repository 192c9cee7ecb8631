from __future__ import annotations

import numpy as np
import pytest

from diorama_core.geometry.silhouette import PoseBatch, ShapeCaster
from diorama_core.layout.refinement.pixel_grid import PixelGrid
from diorama_core.layout.refinement.posed_picture import PosedPicture
from diorama_core.scene.types import Scene
from tests.layout.refinement.views import looking_down, seen_objects
from tests.layout.small_rooms import Room


def crowded(room: Room) -> Scene:
    room.put("box_24", (0.0, 0.0, 0.15), scale=(1.0, 2.0, 1.5))
    room.put("box_24", (0.2, 0.6, 0.15), scale=(1.0, 2.0, 3.0))
    room.put("box_24", (-0.4, 0.3, 0.15))
    return room.scene(camera=looking_down())


def picture_of(scene: Scene, masks: list[np.ndarray], room: Room) -> tuple[PosedPicture, PoseBatch]:
    grid = PixelGrid.of(looking_down(), 320, 240)
    pose = [o.pose for o in scene.objects]
    batch = PoseBatch(
        np.array([p.R_world_object for p in pose]),
        np.array([p.position for p in pose]),
        np.array([p.scale for p in pose]),
    )
    casters = [ShapeCaster(room.library.mesh(o.shape_id)) for o in scene.objects]
    return PosedPicture.of(grid, grid.labels(masks), casters, batch), batch


def moved(poses: PoseBatch, i: int, moves: np.ndarray) -> PoseBatch:
    """One of the poses, moved so."""
    count = len(moves)
    R, scale = (np.repeat(of[i][None], count, axis=0) for of in (poses.R, poses.scale))
    return PoseBatch(R, poses.position[i] + moves, scale)


def test_masks_of_the_poses_themselves_are_met_and_others_less(room: Room) -> None:
    scene = crowded(room)
    picture, poses = picture_of(scene, [o.mask for o in seen_objects(scene, room.library)], room)
    look = picture.look(0, moved(poses, 0, np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]])))
    assert look is not None
    assert look.agreement[0] == pytest.approx(np.ones(3))
    assert look.agreement[1, 0] < 0.95


def test_a_look_counts_what_a_new_picture_does(room: Room) -> None:
    scene, rng = crowded(room), np.random.default_rng(5)
    picture, poses = picture_of(scene, [o.mask for o in seen_objects(scene, room.library)], room)
    current = PoseBatch(poses.R.copy(), poses.position.copy(), poses.scale.copy())
    for turn in range(12):
        i = turn % len(scene.objects)
        moves = np.concatenate([np.zeros((1, 3)), 0.15 * rng.standard_normal((3, 3))])
        tried = moved(current, i, moves)
        look = picture.look(i, tried)
        assert look is not None
        picture.replace(look, 1 + turn % 3)
        current.position[i] = tried.position[1 + turn % 3]
        anew = PosedPicture.of(picture.grid, picture.wanted, picture.casters, current)
        still = anew.look(0, current[np.array([0])])
        again = picture.look(0, current[np.array([0])])
        assert still is not None
        assert again is not None
        assert (still.rest.pixels == again.rest.pixels).all()
        assert (still.rest.right == again.rest.right).all()
        assert still.agreement == pytest.approx(again.agreement)
        assert look.agreement[1 + turn % 3] == pytest.approx(again.agreement[0])


def test_small_moves_are_seen_as_exactly_as_large_ones(room: Room) -> None:
    low = room.put("box_24", (0.0, 0.0, 0.15), scale=(2.0, 2.0, 1.0))
    room.put("box_24", (0.0, 0.0, 0.4), on=low, scale=(1.0, 1.0, 2 / 3))
    room.put("box_24", (0.3, 0.8, 0.3), scale=(2.0, 1.0, 2.0))
    scene = room.scene(camera=looking_down())
    picture, poses = picture_of(scene, [o.mask for o in seen_objects(scene, room.library)], room)
    for i in range(3):
        moves = np.concatenate([np.zeros((1, 3)), 0.02 * np.eye(3), -0.02 * np.eye(3)])
        near, far = (moved(poses, i, np.concatenate([moves, np.full((more, 3), 1.0)])) for more in (0, 1))
        look, whole = picture.look(i, near), picture.look(i, far)  # the far pose has every ray cast
        assert look is not None
        assert whole is not None
        assert look.agreement == pytest.approx(whole.agreement[:-1])


def test_what_is_outside_the_photo_is_not_looked_at(room: Room) -> None:
    scene = crowded(room)
    picture, poses = picture_of(scene, [o.mask for o in seen_objects(scene, room.library)], room)
    assert picture.look(0, moved(poses, 0, np.array([[0.0, -9.0, 0.0]]))) is None
