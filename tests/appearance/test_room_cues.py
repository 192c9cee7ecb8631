"""What walls and windows say of the light, on a room of two walls and a floor seen from inside."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.appearance.room_cues import wall_shade, window_direction
from diorama_core.artefacts import DetectedObject
from diorama_core.io.srgb import linear_to_srgb
from diorama_core.scene.types import Architecture, Camera, Intrinsics, Plane, Pose, Scene, SceneObject

SIZE = (240, 180)
BACK = Plane("back", "wall", np.array([[-2.0, 3, 0], [-2, 3, 2.5], [2, 3, 2.5], [2, 3, 0]]))
LEFT = Plane("left", "wall", np.array([[-2.0, 0, 0], [-2, 0, 2.5], [-2, 3, 2.5], [-2, 3, 0]]))
FLOOR = Plane("floor", "floor", np.array([[-2.0, 0, 0], [-2, 3, 0], [2, 3, 0], [2, 0, 0]]))


def camera() -> Camera:
    T = np.eye(4)
    T[:3, :3] = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    T[:3, 3] = [-1.2, 0.2, 1.3]
    return Camera(Intrinsics(*SIZE, 150.0, 150.0, 120.0, 90.0), T)


def toward_room(plane: Plane) -> Plane:
    inside = plane.normal @ (np.array([0.0, 1.5, 1.2]) - plane.centre) > 0
    return replace(plane, polygon=plane.polygon if inside else plane.polygon[::-1], confidence=1.0)


ROOM = Scene(camera=camera(), architecture=Architecture(tuple(toward_room(p) for p in (FLOOR, BACK, LEFT))))


def photo(light: np.ndarray, left: tuple[float, float, float] = (0.5, 0.45, 0.4)) -> np.ndarray:
    """The room with both walls of one paint unless another is given, under `1 + light . n`."""
    x, y = np.meshgrid(np.arange(SIZE[0]) + 0.5, np.arange(SIZE[1]) + 0.5)
    rays = camera().rays(np.stack([x, y], axis=-1))
    eye = camera().position
    out, nearest = np.full((SIZE[1], SIZE[0], 3), 0.2), np.full((SIZE[1], SIZE[0]), np.inf)
    paints = {"floor": (0.2, 0.3, 0.2), "back": (0.5, 0.45, 0.4), "left": left}
    for plane in ROOM.architecture.planes:
        away = (plane.offset - eye @ plane.normal) / (rays @ plane.normal)
        met = (away > 0) & (away < nearest)
        nearest = np.where(met, away, nearest)
        out[met] = np.array(paints[plane.id]) * (1 + light @ plane.normal)
    return np.rint(255 * linear_to_srgb(out.clip(0, 1))).astype(np.uint8)


@pytest.mark.parametrize("light", [(0.4, 0.0, 0.2), (-0.2, -0.4, 0.2), (0.0, 0.3, 0.0)])
def test_walls_of_one_paint_tell_how_each_is_lit(light: tuple[float, float, float]) -> None:
    b = np.array(light)
    shade = wall_shade(photo(b), (), ROOM)
    assert shade is not None
    lit = 1 + shade.normals_world @ b
    assert shade.luminance[0] / shade.luminance[1] == pytest.approx(lit[0] / lit[1], rel=0.05)
    assert shade.weight.sum() == pytest.approx(1.0)


def test_walls_of_two_paints_tell_nothing() -> None:
    assert wall_shade(photo(np.zeros(3), left=(0.2, 0.3, 0.5)), (), ROOM) is None


def test_what_stands_before_a_wall_is_not_its_paint() -> None:
    b = np.array([0.4, 0.0, 0.2])
    rgb, mask = photo(b), np.zeros((SIZE[1], SIZE[0]), dtype=bool)
    mask[60:120, 100:190] = True
    rgb[mask] = (255, 255, 255)
    box = (100.0, 60.0, 190.0, 120.0)
    found = wall_shade(rgb, (DetectedObject("o", "box", "box", box, mask, 1, 1.0),), ROOM)
    bare = wall_shade(photo(b), (), ROOM)
    assert found is not None
    assert bare is not None
    np.testing.assert_allclose(found.luminance, bare.luminance, rtol=0.02)


def windowed(level: int) -> tuple[np.ndarray, tuple[DetectedObject, ...], Scene]:
    rgb, mask = photo(np.zeros(3)), np.zeros((SIZE[1], SIZE[0]), dtype=bool)
    mask[50:100, 20:50] = True
    rgb[mask] = level
    window = SceneObject("w", "window", "window", "s", (0.1, 1.0, 1.0), Pose.upright((-2.0, 1.5, 1.4), 0.0))
    chair = SceneObject("c", "chair", "chair", "s", (0.5, 0.5, 0.9), Pose.upright((0.5, 1.5, 0.4), 0.0))
    found = (DetectedObject("w", "window", "window", (20.0, 50.0, 50.0, 100.0), mask, 1, 1.0),)
    return rgb, found, replace(ROOM, objects=(window, chair))


def test_daylight_comes_from_the_window_and_none_by_night() -> None:
    by_day = window_direction(*windowed(250))
    assert by_day is not None
    assert by_day[0] < -0.9
    assert np.linalg.norm(by_day) == pytest.approx(1.0)
    assert window_direction(*windowed(5)) is None
    assert window_direction(photo(np.zeros(3)), (), ROOM) is None
