from __future__ import annotations

import numpy as np
import pytest

from diorama_app.panels import photo_camera
from diorama_app.panels.photo_camera import PhotoCameraPanel, figures
from diorama_core.geometry.rotations import CameraAttitude
from tests.app.page import Page
from tests.app.small_room import photo_camera as camera_of_the_photo


@pytest.fixture
def panel(page: Page, client, views) -> PhotoCameraPanel:
    return page.put(PhotoCameraPanel, views)


def test_figures_are_those_of_the_camera() -> None:
    assert figures(camera_of_the_photo()) == pytest.approx({"fov": 66.0, "tilt": 12.0, "roll": 0.0}, abs=1e-6)


def test_typed_figures_are_tried_as_a_grid_and_taken_back(client, page, panel) -> None:
    assert 'value="66.0"' in page.html
    assert not page.shows("build")
    page.change("tilt", "20°")
    assert 'value="20.0"' in page.html
    attitude = CameraAttitude.of(client.trial_camera.T_world_camera[:3, :3])
    assert np.degrees(attitude.pitch_rad) == pytest.approx(20.0)
    assert client.view.camera.through_photo
    page.act("back")
    assert client.trial_camera is None
    assert 'value="12.0"' in page.html


@pytest.mark.parametrize(("field", "value"), [("fov", "500"), ("tilt", "straight down"), ("tilt", "200")])
def test_nonsense_is_refused_and_nothing_changes(client, page, panel, field, value) -> None:
    page.change(field, value)
    assert client.viser_client.told
    assert client.trial_camera is None
    assert not page.shows("build")


def test_the_height_rescales_everything(session, page, panel) -> None:
    before = session.scene.object("table_1").size_m
    page.change("height", "3 m")
    np.testing.assert_allclose(session.scene.object("table_1").size_m, 2.0 * before)
    assert session.scene.camera.position[2] == pytest.approx(3.0)


def test_only_what_was_typed_is_given_to_the_build(client, page, panel, monkeypatch) -> None:
    asked = []
    monkeypatch.setattr(photo_camera, "rebuild_with_camera", lambda *given: asked.append(given[1:]))
    page.change("fov", "70")
    page.act("build")
    page.change("roll", "5")
    page.act("build")
    (first, second) = asked
    assert first == (70.0, None)
    assert second[0] == 70.0
    assert np.degrees([second[1].pitch_rad, second[1].roll_rad]) == pytest.approx([12.0, 5.0])


def test_without_a_camera_nothing_is_drawn(session, page, panel) -> None:
    session.document.open(type(session.scene)())
    session.refresh()
    assert "Camera and floor" not in page.html
