from __future__ import annotations

import numpy as np
import pytest

from diorama_app.viewport.camera import NARROW_FOV_RAD
from diorama_core.artefacts import FurtherPhoto, Inputs, Photo
from diorama_core.errors import EditRefused
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.geometry.sphere import level_axes
from diorama_core.scene.types import Scene


@pytest.fixture
def moves(client, monkeypatch) -> list:
    """Where the camera was sent: position, target and what else."""
    sent: list = []
    monkeypatch.setattr(
        client.view.camera, "move", lambda position, target, *more: sent.append((position, target, *more))
    )
    monkeypatch.setattr(client.view.camera, "approach", lambda target, distance: sent.append((target, distance)))
    return sent


def test_the_room_is_seen_whole(session, client, views, moves) -> None:
    views.room_view(client)
    position, target = moves[-1][:2]
    corners = np.concatenate([p.polygon for p in session.scene.architecture.planes])
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    assert np.linalg.norm(target - middle) < 1.5
    assert np.linalg.norm(position - target) > 2.0


@pytest.mark.parametrize("back", [(0.0, -1e-3, 1.0), (0.0, -1.0, 0.0), (-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)])
def test_views_along_an_axis_look_that_way_nearly_in_parallel(client, views, moves, back) -> None:
    views.look(client, back)
    position, target, fov = moves[-1]
    way = (position - target) / np.linalg.norm(position - target)
    np.testing.assert_allclose(way, np.array(back) / np.linalg.norm(back), atol=0.02)
    assert fov == pytest.approx(float(NARROW_FOV_RAD))


def test_the_photo_view_needs_a_photo_and_the_plain_views_leave_it(session, client, views) -> None:
    views.photo(client)
    assert client.view.camera.through_photo
    views.overlay(client, 0.5)
    assert client.view.photo.opacity == 0.5
    views.room_view(client)
    assert client.view.photo.opacity == 0.0
    session.document.open(Scene())
    with pytest.raises(EditRefused, match="no photo"):
        views.photo(client)
    with pytest.raises(EditRefused, match="no photo"):
        views.overlay(client, 0.5)


def test_a_360_degree_photo_turns_with_the_view_until_one_walks_away(session, client, views) -> None:
    at = np.eye(4)
    at[:3, 3] = (0.3, 0.2, 1.5)
    rgb = np.broadcast_to(np.arange(256, dtype=np.uint8)[None, :, None], (128, 256, 3))  # columns by azimuth
    sphere = FurtherPhoto("all", Inputs(Photo(rgb, "all.jpg", (256, 128), equirectangular=True)), T_world_sphere=at)
    session.commit("add", session.scene, further=(sphere,))
    views.photo_of(client, "all")
    views.overlay(client, 0.5)
    np.testing.assert_allclose(client.view.camera.position, at[:3, 3], atol=0.01)
    shown = {}
    for x, y in ((0.0, -1.0), (1.0, 0.0), (0.0, 1.0)):
        ahead = np.array([x, y, 0.0])
        camera = client.viser_client.camera
        camera.position, camera.look_at = at[:3, 3], at[:3, 3] + 0.002 * ahead
        camera.wxyz = quaternion_wxyz(level_axes(float(np.arctan2(y, x))))
        views.turn(client)
        seen, photo = client.viewpoint
        np.testing.assert_allclose(seen.T_world_camera[:3, 2], ahead, atol=1e-6)
        shown[x, y] = int(photo.rgb[300, photo.width // 2, 0])
        assert client.view.photo.opacity == 0.5
    assert shown[0.0, -1.0] == pytest.approx(128, abs=2), "the middle column looks along -Y"
    assert shown[1.0, 0.0] == pytest.approx(64, abs=2), "and +X is a quarter to the left"
    client.viser_client.camera.position = at[:3, 3] + (0.5, 0.0, 0.0)
    views.turn(client)
    assert client.view.photo.opacity == 0.0
    assert not client.view.camera.through_photo


def test_focus_goes_to_the_middle_of_what_is_selected(session, client, views, moves) -> None:
    client.select(["chair_1", "chair_2"])
    views.focus(client)
    middle, distance = moves[-1]
    corners = np.concatenate([session.scene.object(i).corners_world for i in client.selection])
    np.testing.assert_allclose(middle, (corners.min(axis=0) + corners.max(axis=0)) / 2)
    assert distance > np.linalg.norm(np.ptp(corners, axis=0))
    client.select([])
    with pytest.raises(EditRefused, match="nothing is selected"):
        views.focus(client)
