"""The add-on's requests, to a real editor."""

from __future__ import annotations

import io
from collections.abc import Iterator
from pathlib import Path

import pytest
import trimesh

pytest.importorskip("fastapi", reason="needs FastAPI (pip install 'diorama[api]')")
pytest.importorskip("uvicorn", reason="needs uvicorn (pip install 'diorama[api]')")

from addons.blender import client as client_module  # after the check for its libraries
from addons.blender.client import AUTHOR, Client, RefusedError, local_editor
from diorama_app.http_api import beside, forms
from diorama_app.http_api.beside import api_beside
from diorama_app.serve import Running
from diorama_core.text.edit_plan import MAX_EDITS


@pytest.fixture
def client(running: Running, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Client]:
    monkeypatch.setattr(beside, "_folder", lambda: tmp_path / "servers")
    monkeypatch.setattr(client_module, "_state_folder", lambda: tmp_path)
    with api_beside(running, "secret"):
        yield local_editor()


def test_the_editor_of_this_machine_is_found(client: Client, tmp_path: Path) -> None:
    assert client.token == "secret"
    (tmp_path / "servers" / "9-9.json").write_text('{"address": "http://127.0.0.1:9/", "token": null}')
    assert local_editor() == client, "what others left behind is passed over"
    assert [p["project"] for p in client.projects()] == ["demo"]


def test_notes_are_where_editors_leave_them() -> None:
    assert client_module._state_folder() == beside._folder().parent


def test_a_room_is_changed_for_its_version_only(running: Running, client: Client) -> None:
    version, glb = client.room("demo")
    assert trimesh.load_scene(io.BytesIO(glb), file_type="glb").geometry
    edits = [{"do": "remove", "objects": ["chair_2"]}]
    assert client.edit("demo", version, edits)["version"] != version
    assert running.session.document.history.current.author == AUTHOR
    assert "chair_2" not in [o["id"] for o in client.scene("demo")["objects"]]
    with pytest.raises(RefusedError, match=r"press Reload .* and send again: the scene is at version .* by Blender"):
        client.edit("demo", version, edits)


def test_what_is_wrong_is_one_line(client: Client, tmp_path: Path) -> None:
    with pytest.raises(RefusedError, match="give the token that the page's address ends with"):
        Client(client.address, "wrong").projects()
    with pytest.raises(RefusedError, match="there is no project 'attic'"):
        client.room("attic")
    for address in ("http://127.0.0.1:9", "nonsense"):
        with pytest.raises(RefusedError, match=f"no editor answers at {address}"):
            Client(address).projects()
    for note in (tmp_path / "servers").iterdir():
        note.unlink()
    with pytest.raises(RefusedError, match="start 'diorama serve'"):
        local_editor()


def test_the_page_s_own_address_is_told_from_the_interface(running: Running) -> None:
    with pytest.raises(RefusedError, match="not at the page's address; leave the address empty"):
        Client(running.url.partition("?")[0]).projects()


def test_limits_are_those_of_the_interface() -> None:
    from addons.blender import transforms

    assert transforms.MAX_EDITS == MAX_EDITS
    assert len(AUTHOR) <= forms.EditRequest.model_fields["author"].metadata[0].max_length
