from __future__ import annotations

import numpy as np
import pytest

from diorama_app.panels.overlays import Overlays
from diorama_app.reconstruction.photo_outlines import PhotoOutlines


@pytest.fixture
def drawn(session, client, monkeypatch):
    """Pictures laid over the photo, and planes named in the room, newest last."""
    layers, planes = [], []
    monkeypatch.setattr(client.view.photo, "show_layer", lambda camera, picture: layers.append(picture))
    monkeypatch.setattr(client.view, "show_planes", lambda shown: planes.append([name for name, _ in shown]))
    client.panels = [Overlays(client, PhotoOutlines(session))]
    return layers, planes


def test_planes_are_named_while_wanted(session, client, drawn) -> None:
    _, planes = drawn
    client.change_preferences(planes=True)
    assert len(planes[-1]) == len(session.scene.architecture.planes)
    assert "Floor" in " ".join(planes[-1]).title()
    client.refresh()
    assert len(planes) == 1, "nothing changed"
    client.change_preferences(planes=False)
    assert planes[-1] == []


def test_edges_are_drawn_over_the_photo_only_through_its_camera(session, client, views, drawn) -> None:
    layers, _ = drawn
    client.change_preferences(planes=True)
    assert layers == []
    views.overlay(client, 1.0)
    client.refresh()
    camera = session.scene.camera.intrinsics
    assert layers[-1].shape == (camera.height, camera.width, 4)
    assert np.count_nonzero(layers[-1][..., 3]) > 500
    views.room_view(client)
    client.refresh()
    assert layers[-1] is None


def test_a_camera_being_tried_is_a_grid_on_the_floor(session, client, views, drawn) -> None:
    layers, _ = drawn
    views.overlay(client, 1.0)
    client.trial_camera = session.scene.camera
    client.refresh()
    alpha = layers[-1][..., 3]
    assert alpha.any()
    assert not alpha[: int(0.3 * len(alpha))].any(), "the floor is below the horizon"
