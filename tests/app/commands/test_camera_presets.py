from __future__ import annotations

import numpy as np
import pytest

from diorama_app.viewport.camera import NARROW_FOV_RAD
from diorama_core.errors import EditRefused
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
    views.along(client, back)
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
