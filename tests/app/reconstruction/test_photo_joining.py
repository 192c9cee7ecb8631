"""Another photo of the room is part of the document: added, marked, joined, taken out, undone and saved."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_app.reconstruction.photo_joining import fresh_name, join_photo, take_out, take_photo
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_core.artefacts import Inputs, LabelledBox, Photo
from diorama_core.errors import EditRefused, InputError
from diorama_core.importing import photo_of_scan
from diorama_core.importing.opening import Opened
from diorama_core.project.further_photos import load_photos
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.app.people import settle
from tests.app.small_room import photo_camera, plain_photo

BOX = LabelledBox((10.0, 20.0, 60.0, 80.0), "chair", "chair")


def names(session: EditorSession) -> list[str]:
    return [p.name for p in session.further_photos]


def test_a_photo_is_added_marked_undone_and_saved(session: EditorSession, client: Client) -> None:
    scene = session.scene
    opened: list[bool] = []
    client.open_board = lambda: opened.append(True)
    take_photo(client, "other side.jpg", Inputs(plain_photo()))
    assert opened == [True]
    assert names(session) == ["other-side"]
    assert client.inputs is session.further_photos[0].inputs
    client.annotate("draw a box", replace(client.inputs, boxes=(BOX,)))
    assert session.further_photos[0].inputs.boxes == (BOX,)
    assert session.scene is scene  # nothing of the scene changed
    assert len(session.inputs.boxes) == 1
    session.autosave.flush()
    found, _ = load_photos(session.project)
    assert found[0].inputs.boxes == (BOX,)
    session.undo(client)
    assert session.further_photos[0].inputs.boxes == ()
    session.undo(client)
    assert names(session) == []
    assert client.photo_name is None
    session.redo(client)
    session.autosave.flush()
    session.open_project(session.project)
    assert names(session) == ["other-side"]


def test_a_photo_is_taken_out_with_its_objects_left(session: EditorSession, client: Client) -> None:
    take_photo(client, "a.jpg", Inputs(plain_photo()))
    count = len(session.scene.objects)
    take_out(client, "a")
    assert names(session) == []
    assert len(session.scene.objects) == count
    assert client.inputs is session.inputs


def test_names_are_their_own() -> None:
    assert fresh_name("IMG 1.jpg", ["IMG-1"]) == "IMG-1-2"
    assert fresh_name("../..", []) == "photo"
    assert fresh_name("a.png", []) == "a"


def test_without_a_scene_from_a_photo_nothing_joins(session: EditorSession, client: Client) -> None:
    with pytest.raises(InputError, match="choose a photo"):
        join_photo(client)
    session.commit("no camera", Scene())
    with pytest.raises(EditRefused, match="first photo"):
        take_photo(client, "a.jpg", Inputs(plain_photo()))


def test_a_photo_that_does_not_join_is_one_line_and_nothing_is_lost(session: EditorSession, client: Client) -> None:
    pytest.importorskip("pycolmap", reason="needs pycolmap (pip install 'diorama[photos]')")
    grey = Photo(np.full((120, 160, 3), 120, np.uint8), "grey.png", (160, 120))
    take_photo(client, "grey.png", Inputs(grey, (BOX,)))
    scene, photos = session.scene, session.further_photos
    said: list[str] = []
    client.view.notice = lambda message, kind: said.append(message)
    join_photo(client)
    settle(session)
    assert any(line.startswith("grey does not join") for line in said), said
    assert session.scene is scene
    assert session.further_photos == photos


def scanned(session: EditorSession) -> None:
    """The session's scene as an opened scan: without photo and camera."""
    session.document.open(replace(session.scene, camera=None), None, ())


def test_the_first_photo_of_a_scan_is_marked_and_one_of_elsewhere_changes_nothing(
    session: EditorSession, client: Client
) -> None:
    scanned(session)
    scene, opened = session.scene, []
    client.open_board = lambda: opened.append(True)
    grey = Photo(np.full((120, 160, 3), 120, np.uint8), "grey.png", (160, 120))
    take_photo(
        client, "grey.png", Inputs(grey, tuple(replace(BOX, category=c, label=c) for c in ("bed", "stove", "sink")))
    )
    assert opened == [True]
    assert session.inputs.photo is grey
    assert session.further_photos == ()
    said: list[str] = []
    client.view.notice = lambda message, kind: said.append(message)
    join_photo(client)
    settle(session)
    assert any(line.startswith("grey.png does not join the scan") for line in said), said
    assert session.scene is scene
    session.undo(client)
    assert session.inputs is None


def test_the_first_photo_of_a_scan_brings_looks_and_new_things(
    session: EditorSession, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What it brings is tested in `tests/importing/test_photo_of_scan.py`."""
    scanned(session)
    before, grey = session.scene, np.full((4, 4, 3), 99, np.uint8)

    def with_photo(scan: Opened, given: Inputs, library: object, choose, layout, progress: object) -> Opened:
        assert scan.scene is before
        assert given.boxes == (BOX,)
        assert choose(given).camera is not None
        assert layout(frozenset()) is not None
        chair = edits.duplicate(before, "chair_1")[0]
        seen = edits.set_planes(replace(chair, camera=photo_camera()), [replace(chair.plane("floor"), texture="grey")])
        return Opened(seen, {"grey": grey}, ("room.png joins the scan",), photo=given.photo, boxes=given.boxes)

    monkeypatch.setattr(photo_of_scan, "with_photo_of_scan", with_photo)
    take_photo(client, "room.png", Inputs(plain_photo(), (BOX,)))
    join_photo(client)
    settle(session)
    scene = session.scene
    assert scene.camera is not None
    assert {o.id for o in before.objects} < {o.id for o in scene.objects}
    assert session.textures["grey"] is grey
    assert session.inputs.boxes == (BOX,)
    session.undo(client)
    assert session.scene is before
