from __future__ import annotations

import numpy as np
import trimesh
from trimesh.visual.material import PBRMaterial

from diorama_core.appearance.surface_view import surface_view
from diorama_core.library.slots import slots_of
from diorama_core.scene.types import Camera, Intrinsics, Pose

CAMERA = Camera(
    Intrinsics(200, 150, 200.0, 200.0, 100.0, 75.0),
    np.array([[1.0, 0, 0, 0], [0, 0, 1, -2], [0, -1, 0, 0], [0, 0, 0, 1]]),
)


def parts() -> trimesh.Scene:
    body, foot = trimesh.creation.box((0.4, 0.4, 0.4)), trimesh.creation.box((0.1, 0.1, 0.1))
    foot.apply_translation((0, 0, -0.25))
    for mesh, name in ((body, "cloth"), (foot, "oak")):
        mesh.visual = trimesh.visual.TextureVisuals(material=PBRMaterial(name=name))
    return trimesh.Scene({"body": body, "foot": foot})


def test_every_pixel_has_its_slot_place_and_normal() -> None:
    slots, mask = slots_of(parts()), np.ones((150, 200), dtype=bool)
    view = surface_view(parts(), slots, Pose.upright((0.0, 0.0, 0.0)), CAMERA, mask)
    assert view is not None
    assert slots[view.slot[75, 100]].role == "fabric"
    assert slots[view.slot[75 + 28, 100]].role == "wood"
    assert view.slot[5, 5] == -1
    np.testing.assert_allclose(view.normals_world[75, 100], [0, -1, 0], atol=1e-6)
    step = view.uv_m[75, 101] - view.uv_m[75, 100]
    assert abs(np.linalg.norm(step) - 1.8 / 200) < 1e-5


def test_an_empty_mask_shows_nothing() -> None:
    nothing = np.zeros((150, 200), dtype=bool)
    assert surface_view(parts(), slots_of(parts()), Pose.upright((0.0, 0.0, 0.0)), CAMERA, nothing) is None


def test_large_objects_are_looked_at_coarsely() -> None:
    camera = Camera(CAMERA.intrinsics.resize(2000, 1500), CAMERA.T_world_camera)
    mask = np.ones((1500, 2000), dtype=bool)
    view = surface_view(parts(), slots_of(parts()), Pose.upright((0.0, 0.0, 0.0)), camera, mask)
    assert view is not None
    assert view.step > 1
    assert view.crop(mask).shape == view.slot.shape
