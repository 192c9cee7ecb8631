"""The editor and the HTTP interface beside it, driven by a client that is made of its OpenAPI document."""

from __future__ import annotations

import io
import json
import threading
import urllib.request
from collections.abc import Iterator

import numpy as np
import pytest
import trimesh
from PIL import Image

pytest.importorskip("fastapi", reason="needs FastAPI (pip install 'diorama[api]')")
pytest.importorskip("uvicorn", reason="needs uvicorn (pip install 'diorama[api]')")

from diorama_app.http_api import beside  # after the check for its libraries
from diorama_app.http_api.beside import api_beside, find_servers
from diorama_app.serve import Running
from tests.app.http_api.openapi_client import Client
from tests.app.people import join
from tests.review.doubtful_room import doubtful_scene
from tests.waiting import until

TOKEN = "secret"


@pytest.fixture(scope="module")
def client(running: Running, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Client]:
    place = tmp_path_factory.mktemp("state")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(beside, "_folder", lambda: place / "servers")
        with api_beside(running, TOKEN) as address:
            yield Client(address, TOKEN)
        assert not list((place / "servers").iterdir())


@pytest.fixture
def scene(client: Client) -> dict:
    reply = client.get_project(name="demo")
    assert reply.status == 200
    return reply.body


def edited(client: Client, version: str, *edits: dict, author: str = "Tester") -> dict:
    reply = client.edit_project(name="demo", version=version, edits=list(edits), author=author)
    assert reply.status == 200, reply
    return reply.body


def test_the_token_of_the_page_is_asked_for(client: Client) -> None:
    stranger = Client.__new__(Client)
    stranger.__dict__ |= {**client.__dict__, "headers": {}}
    assert stranger.list_projects().status == 401


def test_programs_find_the_server(client: Client) -> None:
    assert [s.address.rstrip("/") for s in find_servers()] == [client.url]
    (beside._folder() / "1-9.json").write_text('{"address": "http://127.0.0.1:9/", "token": null}')
    assert [s.address.rstrip("/") for s in find_servers()] == [client.url]
    assert len(list(beside._folder().iterdir())) == 1


def test_an_edit_is_seen_and_one_undo_takes_it_back(running: Running, client: Client, scene: dict) -> None:
    session = running.session
    person = session.ui_thread.ask(lambda: join(session))
    said: list[tuple[str, bool]] = []
    person.toast = lambda message, undo: said.append((message, undo))
    before = session.scene
    moved = edited(
        client,
        scene["version"],
        {"do": "place", "objects": ["chair_1"], "base_m": [-1.2, 1.2, 0.0], "heading_deg": 90},
        {"do": "rename", "objects": ["lamp_1"], "to": "reading lamp"},
    )
    assert moved["changed"] == ["lamp_1", "chair_1"]
    assert len(moved["lines"]) == 2
    until(lambda: said)
    assert said[0][0].startswith("Tester: Place chair at (-1.20, 1.20, 0.00) m, heading 90 degrees; call lamp")
    assert said[0][1], "undo is offered"
    chair = next(o for o in client.get_project(name="demo").body["objects"] if o["id"] == "chair_1")
    assert (chair["base_m"], chair["heading_deg"], chair["by_hand"]) == ([-1.2, 1.2, 0.0], 90.0, True)
    session.ui_thread.ask(lambda: session.undo(person))
    assert session.scene == before
    session.ui_thread.ask(lambda: session.leave(person.viser_client))


def test_a_stale_edit_is_told_what_changed(client: Client, scene: dict) -> None:
    hide = {"do": "set", "objects": ["lamp_1"], "state": "hidden"}
    edited(client, scene["version"], hide)
    stale = client.edit_project(name="demo", version=scene["version"], edits=[hide])
    assert stale.status == 409
    assert "by Tester" in stale.body["error"]
    assert client.optimise_project(name="demo", version=scene["version"]).status == 409
    undone = client.undo_project(name="demo", author="Tester")
    assert undone.body["label"]
    assert undone.body["version"] != scene["version"]
    assert client.redo_project(name="demo", author="Tester").status == 200
    client.undo_project(name="demo", author="Tester")


def test_questions_are_told_and_answered(running: Running, client: Client) -> None:
    session = running.session
    before = session.scene
    session.ui_thread.ask(lambda: session.commit("doubt", doubtful_scene()))
    asked = client.get_questions(name="demo").body
    first = asked["questions"][0]
    answer = {"question": first["id"], "answer": first["choices"][0]["value"], "author": "Tester"}
    assert client.answer_question(name="demo", version="old", **answer).status == 409
    assert client.answer_question(name="demo", version=asked["version"], question="kind:x", answer="y").status == 422
    done = client.answer_question(name="demo", version=asked["version"], **answer)
    assert done.status == 200
    left = client.get_questions(name="demo").body
    assert left["version"] == done.body["version"]
    assert first["id"] not in {q["id"] for q in left["questions"]}
    session.ui_thread.ask(lambda: session.commit("as before", before))


def test_programs_take_back_only_what_is_theirs(client: Client, scene: dict) -> None:
    edited(client, scene["version"], {"do": "set", "objects": ["lamp_1"], "state": "locked"}, author="One")
    refused = client.undo_project(name="demo", author="Another")
    assert (refused.status, refused.body["error"]) == (422, "there is nothing of yours to undo")
    assert client.undo_project(name="demo", author="One").status == 200


def test_words_are_edits_too(client: Client, scene: dict) -> None:
    reply = client.edit_project(name="demo", version=scene["version"], words="make the lamp twice as tall")
    assert reply.status == 200
    assert reply.body["changed"] == ["lamp_1"]
    assert client.undo_project(name="demo", author="API").status == 200


@pytest.mark.parametrize(
    ("body", "status", "line"),
    [
        ({"edits": [{"do": "fly"}]}, 422, "does not match any of the expected tags"),
        ({"edits": [{"do": "remove", "objects": ["sofa_9"]}]}, 422, "no object “sofa_9”"),
        ({"edits": []}, 422, "either edits or words"),
        ({"words": "make it nice"}, 422, "known here"),
    ],
)
def test_a_refused_edit_is_one_line(client: Client, scene: dict, body: dict, status: int, line: str) -> None:
    reply = client.edit_project(name="demo", version=scene["version"], **body)
    assert reply.status == status
    assert line in reply.body["error"]
    assert "\n" not in reply.body["error"]
    assert client.get_project(name="demo").body["version"] == scene["version"]


def test_what_is_around_an_object_is_told(client: Client) -> None:
    lamp = client.get_object(name="demo", object_id="lamp_1").body
    assert lamp["object"]["held_by"] == "table_1"
    assert lamp["gaps_m"]["table_1"] == 0
    table = client.get_object(name="demo", object_id="table_1").body
    assert table["carries"] == ["lamp_1"]
    assert {c["side"] for c in table["clearances"]} == {"front", "back", "left", "right"}
    assert [a["shape"] for a in table["alternatives"]] == ["table_a", "table_b"]
    missing = client.get_object(name="demo", object_id="sofa_9")
    assert (missing.status, "table_1" in missing.body["error"]) == (404, True)
    assert client.get_project(name="nowhere").status == 404


def test_collisions_and_free_floor_are_told(client: Client, scene: dict) -> None:
    free = client.get_free_floor(name="demo", width_m=1.0, depth_m=1.0).body
    assert 10.0 < free["free_m2"] < 17.6
    assert free["spots"]
    onto = {"do": "place", "objects": ["chair_1"], "base_m": [0.1, 2.2, 0.3]}
    edited(client, scene["version"], onto)
    check = client.check_project(name="demo").body
    assert ["chair_1", "table_1"] in check["collisions"]
    assert any("chair_1 collides with table_1" in line for line in check["lines"])
    assert client.undo_project(name="demo", author="Tester").status == 200


def test_pictures_name_objects_where_they_are(client: Client) -> None:
    plain = client.get_project_picture(name="demo", view="look:0,-0.4,1.5:0,2,0.8", width=160, height=120)
    assert Image.open(io.BytesIO(plain.body)).size == (160, 120)
    named = Image.open(
        io.BytesIO(client.get_project_picture(name="demo", view="top", width=320, height=240, ids=True).body)
    )
    assert named.size == (896, 672)
    assert len(np.unique(np.asarray(named).reshape(-1, 3), axis=0)) > 50
    assert client.get_project_picture(name="demo", view="look:1").status == 422


def test_files_and_the_scene_are_of_what_is_open(client: Client, scene: dict) -> None:
    edited(client, scene["version"], {"do": "remove", "objects": ["lamp_1"]})
    file = client.export_project(name="demo", format_name="glb", texture_size=64)
    names = trimesh.load_scene(io.BytesIO(file.body), file_type="glb").graph.nodes
    assert not any("lamp" in str(name) for name in names)
    assert len(client.get_project_scene(name="demo").body["objects"]) == 4
    assert client.undo_project(name="demo", author="Tester").status == 200
    assert client.export_project(name="demo", format_name="docx").status == 404


def test_tidying_up_is_one_step(running: Running, client: Client, scene: dict) -> None:
    up = {"do": "place", "objects": ["chair_1"], "base_m": [-0.9, 1.5, 0.4]}
    version = edited(client, scene["version"], up)["version"]
    assert client.optimise_project(name="demo", version=version, only=["sofa_9"]).status == 404
    begun = client.optimise_project(name="demo", version=version, by_hand_too=True, author="Tester")
    assert begun.status == 202
    done = client.get_project_job(name="demo", wait_s=60).body
    assert (done["running"], done["error"], done["message"]) == (False, None, "done")
    assert running.session.scene.object("chair_1").corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-3)
    assert client.undo_project(name="demo", author="Tester").body["label"] == "tidy up"
    assert client.undo_project(name="demo", author="Tester").status == 200


def test_events_tell_of_changes_by_anybody(running: Running, client: Client, scene: dict) -> None:
    request = urllib.request.Request(f"{client.url}/v1/projects/demo/events", headers=client.headers)
    events: list[tuple[str, dict]] = []

    def listen() -> None:
        with urllib.request.urlopen(request, timeout=30) as reply:
            assert reply.headers.get_content_type() == "text/event-stream"
            kind = ""
            for raw in reply:
                line = raw.decode().rstrip("\n")
                if line.startswith("event: "):
                    kind = line.removeprefix("event: ")
                elif line.startswith("data: "):
                    events.append((kind, json.loads(line.removeprefix("data: "))))
                    if len(events) == 2:
                        return

    listener = threading.Thread(target=listen, daemon=True)
    listener.start()
    until(lambda: events)
    assert events[0][1]["version"] == scene["version"]
    edited(client, scene["version"], {"do": "set", "objects": ["lamp_1"], "state": "hidden"})
    listener.join(30)
    kind, told = events[1]
    assert (kind, told["author"]) == ("scene", "Tester")
    assert told["version"] != scene["version"]
    assert client.undo_project(name="demo", author="Tester").status == 200
    until(lambda: not running.session.watchers)


def test_a_described_room_is_offered_to_whoever_looks_on(running: Running, client: Client) -> None:
    session = running.session
    person = session.ui_thread.ask(lambda: join(session))
    offered: list[tuple[str, str]] = []
    went: list[str] = []
    person.offer = lambda message, label, do: (offered.append((message, label)), do())
    person.go_to = went.append
    reply = client.describe_project(text="a table with two chairs", author="Tester")
    assert reply.status == 201
    made = reply.body
    assert sum(o["category"] == "chair" for o in made["objects"]) == 2
    until(lambda: went)
    assert offered == [(f"Tester builds {made['title']}", "Look")]
    assert went == [made["project"]]
    assert client.describe_project(text="   ").status == 422
    session.ui_thread.ask(lambda: session.leave(person.viser_client))
