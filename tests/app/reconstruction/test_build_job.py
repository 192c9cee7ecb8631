"""A scene that was built again is shown with the photos that joined it anew."""

from __future__ import annotations

from dataclasses import replace

import pytest

from diorama_app.reconstruction.build_job import show_built
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_core.artefacts import FurtherPhoto, Inputs
from diorama_core.multiview.rebuilding import Rebuilt
from diorama_core.scene.types import Camera
from tests.app.small_room import photo_camera, plain_photo


def turned(camera: Camera) -> Camera:
    T = camera.T_world_camera.copy()
    T[:3, 3] += (0.5, 0.0, 0.0)
    return Camera(camera.intrinsics, T)


def test_photos_have_their_new_cameras_and_those_that_do_not_join_are_named(
    session: EditorSession, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = photo_camera()
    joined = FurtherPhoto("one", Inputs(plain_photo()), own, (("table_1", (1.0, 2.0, 3.0, 4.0)),))
    lost, added = FurtherPhoto("two", Inputs(plain_photo()), own), FurtherPhoto("three", Inputs(plain_photo()))
    session.annotate_further("photos", (joined, lost, added), by=client)
    said: list[str] = []
    monkeypatch.setattr(session, "notice_all", lambda message, kind: said.append(message))
    scene = replace(session.scene, camera=turned(own))
    photos = (replace(joined, camera=turned(own)), replace(lost, camera=None))
    again = Rebuilt(scene, photos, {}, ("two",))
    assert session.project is not None
    show_built(session, session.project, scene, label="build the scene", again=again)
    assert session.scene is scene
    assert session.further_photos == (*photos, added)
    assert any("To be added again: two." in line for line in said), said
    session.undo(client)
    assert session.further_photos == (joined, lost, added)


def test_without_other_photos_nothing_is_said_of_them(session: EditorSession, monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    monkeypatch.setattr(session, "notice_all", lambda message, kind: said.append(message))
    assert session.project is not None
    show_built(session, session.project, replace(session.scene, camera=turned(photo_camera())), label="build")
    assert not any("again" in line for line in said), said
