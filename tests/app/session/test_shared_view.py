from __future__ import annotations

import numpy as np
import pytest

from diorama_app.session.client import Client, Placing
from diorama_app.session.session import EditorSession
from diorama_app.viewport.camera import room_view
from diorama_core.artefacts import FurtherPhoto, Inputs
from diorama_core.errors import LibraryError
from tests.app import pointer
from tests.app.small_room import photo_camera, plain_photo
from tests.waiting import until


def test_a_part_that_cannot_be_drawn_costs_that_part_only(
    session: EditorSession, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*given: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(session.viewport, "show", fails)
    drawn: list[Client] = []
    monkeypatch.setattr(session.view, "show_photo_camera", drawn.append)
    session.refresh()
    assert drawn == [client]
    assert client.viser_client.told == ["The view could not be drawn; your work is saved. See the server's log."]


def test_a_shape_that_cannot_be_read_is_said_as_it_is(
    session: EditorSession, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*given: object) -> None:
        raise LibraryError("chair_a cannot be read")

    monkeypatch.setattr(session.viewport, "show", fails)
    session.refresh()
    assert client.viser_client.told == ["chair_a cannot be read"]


def test_the_shapes_of_the_scene_are_readied(session: EditorSession) -> None:
    session.refresh()
    assert session.ui_thread.wait(60.0)
    shapes = [o.shape_id for o in session.scene.objects]
    assert not session.preparer.ready(["chair_c"])
    until(lambda: session.preparer.ready(shapes))


def test_the_whole_room_is_seen_and_nothing_is_selected(session: EditorSession, client: Client) -> None:
    client.select(["chair_1"])
    client.doing = Placing("chair_a")
    session.view.show_whole_room()
    assert client.selection == ()
    assert client.doing is None
    position, target = room_view(session.scene)
    np.testing.assert_allclose(session.server.initial_camera.position, position)
    np.testing.assert_allclose(session.server.initial_camera.look_at, target)


def test_clicks_and_drags_are_told_to_who_listens(session: EditorSession, client: Client) -> None:
    click = pointer.clicked(client.viser_client, "chair_1")
    session.view._pick("chair_1", click)  # nobody listens yet
    told: list = []
    session.view.on_pick = session.view.on_drag = lambda object_id, event: told.append((object_id, event))
    drag = pointer.dragged(client.viser_client, "chair_1", "start", (0, 0, 0), (0, 0, 0))
    session.view._pick("chair_1", click)
    session.view._drag("chair_1", drag)
    assert told == [("chair_1", click), ("chair_1", drag)]


def test_who_clicks_the_photos_camera_asks_to_look_through_it(
    session: EditorSession, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown: list = []
    monkeypatch.setattr(client.view.photo, "show_cameras", shown.extend)
    asked: list[tuple[Client, str | None]] = []
    session.view.on_photo_camera = lambda who, name: asked.append((who, name))
    beside = FurtherPhoto("beside", Inputs(plain_photo()), photo_camera())
    unjoined = FurtherPhoto("elsewhere", Inputs(plain_photo()))
    session.commit("add photos", session.scene, further=(unjoined, beside))
    shown.clear()
    session.view.show_photo_camera(client)
    assert [camera.name for camera in shown] == ["", "_1"]
    for camera in shown:
        camera.on_click()
    assert session.ui_thread.wait(60.0)
    assert asked == [(client, None), (client, "beside")]
