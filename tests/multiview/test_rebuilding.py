"""Photos stay with a scene that is built anew: their cameras follow its own photo's."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import FurtherPhoto, Inputs
from diorama_core.multiview import adding
from diorama_core.multiview.rebuilding import transfer_camera, with_photos_again
from diorama_core.pipeline.stages import Stages, embedded_stages
from diorama_core.scene.types import Camera, rigid, yaw_rotation
from tests.few_shapes import few_shapes
from tests.multiview.rooms import camera
from tests.multiview.two_photos import SMALL, AsItIs, two_photos, with_camera


def moved(one: Camera, turn_rad: float, scale: float) -> Camera:
    R = yaw_rotation(turn_rad)
    t = scale * (R @ one.position) + np.array([0.4, -0.2, 0.0])
    return Camera(one.intrinsics, rigid(R @ one.T_world_camera[:3, :3], t))


def test_a_camera_follows_turn_place_and_scale() -> None:
    first, second = camera(-0.4, -2.6), camera(2.2, -2.0, height_m=1.3)
    after = moved(first, 0.7, 1.2)
    found, expected = transfer_camera(second, first, after), moved(second, 0.7, 1.2)
    np.testing.assert_allclose(found.T_world_camera, expected.T_world_camera, atol=1e-9)
    same = transfer_camera(second, first, first)
    np.testing.assert_allclose(same.T_world_camera, second.T_world_camera, atol=1e-12)


@pytest.mark.slow
def test_photos_join_the_new_scene_or_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(adding, "DISTANCES", (0.8, 1.0, 1.25))
    photos = two_photos(SMALL)
    library = few_shapes(photos.scene)
    scene, beside = photos.scene, with_camera(photos)
    grey = replace(photos.second, photo=replace(photos.second.photo, rgb=np.full_like(photos.second.photo.rgb, 128)))
    blank = FurtherPhoto("blank", replace(grey, boxes=(), instances=None, instance_boxes=()), photos.camera)
    apart = FurtherPhoto("apart", photos.second)

    def choose(inputs: Inputs) -> Stages:
        return embedded_stages(inputs, library)

    found = with_photos_again(
        scene, photos.first, scene.camera, (beside, blank, apart), library, choose, lambda free: AsItIs()
    )
    assert [p.name for p in found.photos] == ["beside", "blank", "apart"]
    assert found.left_out == ("blank",)
    assert found.photos[0].camera is not None
    assert found.photos[0].seen
    assert found.photos[1].camera is None
    assert found.photos[2] is apart
    assert len(found.scene.objects) > len(scene.objects)
    assert all(p.texture in found.textures for p in found.scene.architecture.by_role("floor"))
