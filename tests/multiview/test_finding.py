from __future__ import annotations

import numpy as np
import pytest

from diorama_core.artefacts import FurtherPhoto
from diorama_core.library.catalogue import built_in_library
from diorama_core.multiview.finding import OWN, camera_of, photos_of_scene
from tests.multiview.two_photos import two_photos


@pytest.mark.slow
def test_the_camera_of_a_second_photo_is_found_with_one_known_photo() -> None:
    pytest.importorskip("pycolmap", reason="needs pycolmap (pip install 'diorama[photos]')")
    photos = two_photos()
    known = photos_of_scene(photos.scene, photos.first, ())
    found = camera_of(FurtherPhoto("beside", photos.second), known, photos.scene, built_in_library())
    trace = np.trace(found.T_world_camera[:3, :3].T @ photos.camera.T_world_camera[:3, :3])
    assert np.degrees(np.arccos(np.clip((trace - 1) / 2, -1, 1))) < 0.5
    assert np.linalg.norm(found.position - photos.camera.position) < 0.05
    assert found.intrinsics.fx == pytest.approx(photos.camera.intrinsics.fx, rel=0.02)


def test_photos_with_cameras_are_known_the_own_one_first() -> None:
    photos = two_photos()
    further = (FurtherPhoto("a", photos.second), FurtherPhoto("b", photos.second, photos.camera))
    known = photos_of_scene(photos.scene, photos.first, further)
    assert [p.name for p in known] == [OWN, "b"]
    assert {name for name, _ in known[0].seen} == {o.id for o in photos.scene.objects if o.box_px is not None}
