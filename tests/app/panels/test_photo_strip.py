from __future__ import annotations

import pytest

from diorama_app.commands.camera_presets import Views
from diorama_app.panels.photo_strip import PhotoStrip
from diorama_app.session.client import Client
from diorama_core.artefacts import FurtherPhoto, Inputs
from tests.app.page import Page
from tests.app.small_room import photo_camera, plain_photo


def test_photos_are_chosen_looked_through_and_taken_out(client: Client, page: Page, views: Views) -> None:
    strip = page.put(PhotoStrip, views)
    opened: list[bool] = []
    client.open_board = lambda: opened.append(True)
    strip.refresh()
    assert "Photos of this room" not in page.html
    joined = FurtherPhoto("beside", Inputs(plain_photo()), photo_camera(), (("chair_1", (1.0, 2.0, 3.0, 4.0)),))
    client.session.commit("add", client.session.scene, further=(joined, FurtherPhoto("new", Inputs(plain_photo()))))
    strip.refresh()
    assert page.html.count('class="tile') == 3
    assert page.html.count("not in the scene yet") == 1
    strip._choose("beside")
    assert client.further_photo is joined
    assert client.view.camera.through_photo
    assert "1 object of the scene is visible in it" in page.html
    strip._choose("new")
    assert opened == [True]
    strip._choose(None)
    assert client.further_photo is None


def test_what_is_missing_to_add_a_photo_is_told_before_one_is_marked(
    client: Client, page: Page, views: Views, monkeypatch: pytest.MonkeyPatch
) -> None:
    strip = PhotoStrip(page, client, views)
    strip.refresh()
    assert strip._upload.visible
    monkeypatch.setattr("diorama_app.reconstruction.photo_joining.find_spec", lambda name: None)
    client.session.glances.forget()
    strip.refresh()
    assert not strip._upload.visible
    assert "diorama[photos]" in page.html
