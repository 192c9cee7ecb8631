"""The photo-real path: refuses clearly without Blender's module, and renders a tiny picture with it."""

from __future__ import annotations

import os
from dataclasses import replace
from importlib.util import find_spec

import pytest

from diorama_core.errors import SceneError, UnavailableError
from diorama_core.export.blender import PYTHON_VARIABLE
from diorama_core.library.catalogue import built_in_library
from diorama_core.synthesis import furnished_room, hold_cameras, in_photo_world
from diorama_core.synthesis.cycles import truth_picture


@pytest.fixture(scope="module")
def scene():
    library = built_in_library()
    room = furnished_room(1, "corridor", library, clutter=0)
    return in_photo_world(replace(room, camera=sample_cameras(room, library, 1, 1, (48, 36))[0]))


@pytest.mark.skipif(find_spec("bpy") is not None, reason="Blender's module is installed")
def test_says_what_to_install(scene, monkeypatch):
    monkeypatch.delenv(PYTHON_VARIABLE, raising=False)
    with pytest.raises(UnavailableError, match=PYTHON_VARIABLE):
        truth_picture(scene, built_in_library())


def test_a_python_that_is_not_there_is_named(scene, monkeypatch):
    monkeypatch.setenv(PYTHON_VARIABLE, "/nowhere/python")
    with pytest.raises(UnavailableError, match="/nowhere/python"):
        truth_picture(scene, built_in_library())


def test_needs_a_camera(scene):
    with pytest.raises(SceneError, match="no camera"):
        truth_picture(replace(scene, camera=None), built_in_library())


@pytest.mark.skipif(
    find_spec("bpy") is None and PYTHON_VARIABLE not in os.environ,
    reason=f"needs Blender's module: name a Python that has it in {PYTHON_VARIABLE}",
)
def test_renders_a_tiny_picture(scene):
    picture = truth_picture(scene, built_in_library(), samples=2)
    assert picture.shape == (36, 48, 3)
    assert 20 < picture.mean() < 240
    assert picture.std() > 5
