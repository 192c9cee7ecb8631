from __future__ import annotations

import numpy as np
import pytest

from diorama_app.panels.overlays import Compare, Overlays, Silhouettes
from diorama_app.reconstruction.photo_outlines import PhotoOutlines
from tests.app.page import Page


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


@pytest.fixture
def panel(client, page: Page, views) -> Compare:
    return page.put(Compare, views)


def test_the_slider_lays_the_photo_over_the_model(client, page: Page, views, panel: Compare) -> None:
    page.change("over", "40")
    assert client.view.camera.through_photo
    assert client.view.photo.opacity == 0.4
    panel.refresh()
    assert 'value="0"' in page.html, "a slider in the hand is not drawn anew"
    page.change("over", "100")
    views.room_view(client)
    panel.refresh()
    assert client.view.photo.opacity == 0.0
    views.overlay(client, 1.0)
    panel.refresh()
    assert 'value="100"' in page.html, "what a command shows is seen on the slider"


@pytest.mark.parametrize("written", ["", "-5", "much"])
def test_what_is_no_share_changes_nothing(client, page: Page, panel: Compare, written: str) -> None:
    page.change("over", written)
    assert client.view.photo.opacity == 0.0


def test_without_a_photo_there_is_nothing_to_compare(session, client, page: Page, views) -> None:
    session.document.open(session.scene)
    Compare(page, client, views).refresh()
    assert not page.shows("over", kind="change")


def test_on_the_drawing_board_it_is_not_in_the_way(client, page: Page, panel: Compare, monkeypatch) -> None:
    monkeypatch.setattr(type(client.view.canvas), "is_open", property(lambda _: True))
    panel.refresh()
    assert not page.shows("over", kind="change")


def test_the_page_is_told_outlines_and_names(session, client, page: Page) -> None:
    panel = page.put(Silhouettes)
    client.select(("lamp_1",))
    session.ui_thread.wait()
    node = session.viewport.node_name("lamp_1")
    assert f"[[&quot;{node}&quot;,&quot;#ff7a1a&quot;,3.5]]" in page.html
    assert f"&quot;{node}&quot;:&quot;lamp&quot;" in page.html
    told = page.html
    panel.refresh()
    assert page.html == told
    client.select(())
    session.ui_thread.wait()
    assert "&quot;lines&quot;:[]" in page.html
