"""The photo-real path: refuses clearly without Blender's module, and renders a tiny picture with it."""

from __future__ import annotations

import os
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest

from diorama_core.errors import SceneError, UnavailableError
from diorama_core.export.blender import PYTHON_VARIABLE
from diorama_core.export.cycles import LightPortal, Outdoors, cycles_picture, cycles_radiance
from diorama_core.library.catalogue import built_in_library
from diorama_core.scene.types import Architecture, Camera, Intrinsics, Plane, Scene
from diorama_core.synthesis import furnish_room, sample_cameras, to_photo_world


@pytest.fixture(scope="module")
def scene():
    library = built_in_library()
    room = furnish_room(1, "corridor", library, clutter=0)
    return to_photo_world(replace(room, camera=sample_cameras(room, library, 1, 1, (48, 36))[0]))


@pytest.mark.skipif(find_spec("bpy") is not None, reason="Blender's module is installed")
def test_says_what_to_install(scene, monkeypatch):
    monkeypatch.delenv(PYTHON_VARIABLE, raising=False)
    with pytest.raises(UnavailableError, match=PYTHON_VARIABLE):
        cycles_picture(scene, built_in_library())


def test_a_python_that_is_not_there_is_named(scene, monkeypatch):
    monkeypatch.setenv(PYTHON_VARIABLE, "/nowhere/python")
    with pytest.raises(UnavailableError, match="/nowhere/python"):
        cycles_picture(scene, built_in_library())


def test_needs_a_camera(scene):
    with pytest.raises(SceneError, match="no camera"):
        cycles_picture(replace(scene, camera=None), built_in_library())


@pytest.mark.skipif(
    find_spec("bpy") is None and PYTHON_VARIABLE not in os.environ,
    reason=f"needs Blender's module: name a Python that has it in {PYTHON_VARIABLE}",
)
def test_renders_a_tiny_picture(scene):
    picture = cycles_picture(scene, built_in_library(), samples=2)
    assert picture.shape == (36, 48, 3)
    assert 20 < picture.mean() < 240
    assert picture.std() > 5


@pytest.mark.skipif(
    find_spec("bpy") is None and PYTHON_VARIABLE not in os.environ,
    reason=f"needs Blender's module: name a Python that has it in {PYTHON_VARIABLE}",
)
def test_daylight_comes_through_the_opening_and_falls_where_the_sun_sends_it():
    """A box without its left wall: what the sun meets is brighter than what it does not, and the floor is below."""
    corners = np.array([[-2.0, 0.0], [2.0, 0.0], [2.0, 5.0], [-2.0, 5.0]])
    floor, up = np.column_stack([corners, np.zeros(4)]), np.array([0.0, 0.0, 2.5])

    def wall(name: str, a: int, b: int) -> Plane:
        low, high = floor[[a, b]], floor[[b, a]] + up
        return Plane(name, "wall", np.vstack([low, high]), colour=(0.9, 0.9, 0.9))

    planes = (
        Plane("floor", "floor", floor, colour=(0.6, 0.1, 0.1)),
        Plane("ceiling", "ceiling", floor[::-1] + up, colour=(0.9, 0.9, 0.9)),
        wall("right", 2, 1), wall("back", 3, 2), wall("near", 1, 0),
    )  # fmt: skip
    camera = Camera(Intrinsics.from_fov(48, 36, np.radians(70.0)), _looking_ahead([0.0, 0.3, 1.25]))
    opening = LightPortal(np.array([-2.0, 2.5, 1.25]), np.array([1.0, 0.0, 0.0]), 5.0, 2.5)
    down = np.array([-0.7, 0.0, 0.7])
    outdoors = Outdoors(np.array([2.0, 2.0, 2.0]), np.array([50.0, 50.0, 50.0]), down, 0.01, (opening,))
    light = cycles_radiance(Scene(camera, Architecture(planes)), built_in_library(), outdoors, samples=8)
    assert light.shape == (36, 48, 3)
    assert np.isfinite(light).all()
    assert light.min() >= 0
    floor_part, ceiling_part = light[-3:, 20:28].mean(axis=(0, 1)), light[:3, 20:28].mean(axis=(0, 1))
    assert floor_part[0] > 8 * floor_part[1]  # the red floor is at the bottom of the picture
    assert ceiling_part[0] < 5 * ceiling_part[1]  # the white ceiling above has a glow of it
    assert light[30:, 10:30, 0].mean() > 2 * light[:6, 10:30, 0].mean()  # the sun comes from above


def _looking_ahead(position: list[float]) -> np.ndarray:
    """A camera that looks along +y, upright."""
    T = np.eye(4)
    T[:3, :3] = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    T[:3, 3] = position
    return T
