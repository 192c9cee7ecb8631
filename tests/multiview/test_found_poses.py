from __future__ import annotations

import sys

import numpy as np
import pytest

from diorama_core.errors import Cancelled, InputError, UnavailableError
from diorama_core.library.catalogue import built_in_library
from diorama_core.multiview.found_poses import UnposedPhoto, _describe_excluded, find_poses
from diorama_core.progress import CancelToken, Progress
from diorama_core.scene.types import Camera
from diorama_core.synthesis import furnish_room
from diorama_core.synthesis.cameras import sample_cameras
from diorama_core.synthesis.truth import Studio
from tests.multiview.two_photos import SIZE, camera_beside

pytest.importorskip("pycolmap", reason="needs pycolmap (pip install 'diorama[photos]')")


def photos_and_cameras() -> tuple[list[UnposedPhoto], list[Camera]]:
    """Three views of a rendered room from places side by side, and one of nothing."""
    library = built_in_library()
    scene = furnish_room(7006, "dining", library, clutter=8)
    first = sample_cameras(scene, library, 7006, 1, SIZE)[0]
    studio, cameras = Studio(scene, library), [camera_beside(first, aside_m) for aside_m in (0.0, -0.35, 0.35)]
    photos = [UnposedPhoto(f"{k}.jpg", studio.photograph(c, SIZE)[0], None) for k, c in enumerate(cameras)]
    blank = np.full((480, 640, 3), 200, np.uint8)
    return [*photos, UnposedPhoto("blank.jpg", blank, None)], cameras


@pytest.mark.slow
def test_cameras_of_a_rendered_room_are_found_and_a_strange_photo_is_named() -> None:
    photos, cameras = photos_and_cameras()
    poses = find_poses(photos)
    assert [p.name for p in poses.photos] == ["0.jpg", "1.jpg", "2.jpg"]
    assert not poses.metric
    assert poses.up is None
    assert any(note.startswith("blank.jpg: too little in common") for note in poses.notes)
    found = [p.camera for p in poses.photos]
    for a, b in ((0, 1), (0, 2), (1, 2)):
        true = cameras[a].T_world_camera[:3, :3].T @ cameras[b].T_world_camera[:3, :3]
        own = found[a].T_world_camera[:3, :3].T @ found[b].T_world_camera[:3, :3]
        assert np.degrees(np.arccos(np.clip((np.trace(own.T @ true) - 1) / 2, -1, 1))) < 1.0
    true_steps = [np.linalg.norm(cameras[k].position - cameras[0].position) for k in (1, 2)]
    own_steps = [np.linalg.norm(found[k].position - found[0].position) for k in (1, 2)]
    assert own_steps[0] / own_steps[1] == pytest.approx(true_steps[0] / true_steps[1], rel=0.05)
    assert found[0].intrinsics.fx == pytest.approx(cameras[0].intrinsics.fx, rel=0.08)


def test_photos_with_nothing_in_common_are_one_line() -> None:
    grey = [UnposedPhoto(f"{n}.jpg", np.full((120, 160, 3), 90 + n, np.uint8), 150.0) for n in range(2)]
    with pytest.raises(InputError, match="too little in common"):
        find_poses(grey)
    with pytest.raises(InputError, match="2 to"):
        find_poses(grey[:1])


def test_photos_of_two_rooms_are_told_apart() -> None:
    groups = [frozenset({"a.jpg", "b.jpg"}), frozenset({"c.jpg", "d.jpg", "e.jpg"}), frozenset({"f.jpg"})]
    assert _describe_excluded([], groups) == ()
    assert _describe_excluded(["a.jpg", "b.jpg", "f.jpg"], groups) == (
        "a.jpg, b.jpg: join one another only, as photos of another room do; left out",
        "f.jpg: too little in common with the other photos to find the camera; left out",
    )


def test_finding_is_cancelled() -> None:
    token = CancelToken()
    token.cancel()
    grey = [UnposedPhoto(f"{n}.jpg", np.zeros((120, 160, 3), np.uint8), None) for n in range(2)]
    with pytest.raises(Cancelled):
        find_poses(grey, Progress(token=token))


def test_without_pycolmap_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pycolmap", None)
    with pytest.raises(UnavailableError, match=r"diorama\[photos\]"):
        find_poses([])
