"""An agent's tools, called through the SDK's own client, on a real editor."""

from __future__ import annotations

import base64
import io
import json
from collections.abc import Awaitable, Callable, Iterator
from pathlib import Path
from typing import Any

import anyio
import pytest
import trimesh
from PIL import Image

pytest.importorskip("mcp", reason="needs the MCP SDK (pip install 'diorama[agents]')")
pytest.importorskip("fastapi", reason="needs FastAPI (pip install 'diorama[agents]')")

from mcp import Client  # after the check for its library

from diorama_app.agents.api import Api
from diorama_app.agents.server import mcp_server
from diorama_app.agents.tools import Tools
from diorama_app.http_api import beside
from diorama_app.serve import Running
from diorama_core.scene import edits
from diorama_core.scene.types import Scene
from tests.review.doubtful_room import doubtful_scene

Work = Callable[[Client], Awaitable[None]]


@pytest.fixture(scope="module")
def address(running: Running, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(beside, "_folder", lambda: tmp_path_factory.getbasetemp() / "servers")
        with beside.api_beside(running, None) as found:
            yield found


@pytest.fixture
def agent(address: str) -> Callable[[Work], None]:
    def work(do: Work) -> None:
        async def connected() -> None:
            async with Client(mcp_server(Tools(Api(address), "demo"))) as client:
                await do(client)

        anyio.run(connected)

    return work


async def told(client: Client, tool: str, **arguments: Any) -> Any:
    """What a tool answers; a refusal is an assertion."""
    result = await client.call_tool(tool, arguments)
    assert not result.is_error, result.content[0].text
    return result.structured_content


async def refused(client: Client, tool: str, **arguments: Any) -> str:
    result = await client.call_tool(tool, arguments)
    assert result.is_error
    (content,) = result.content
    assert "\n" not in content.text
    return content.text


def test_the_tools_and_resources_are_listed(agent) -> None:
    async def work(client: Client) -> None:
        tools = {tool.name: tool for tool in (await client.list_tools()).tools}
        names = "rooms open_room build look ask questions answer edit optimise check undo redo export"
        assert set(tools) == set(names.split())
        assert all(tool.description for tool in tools.values())
        assert '"outward_m"' in json.dumps(tools["edit"].input_schema), "the edits are described field by field"
        found = {str(r.uri) for r in (await client.list_resources()).resources}
        assert found == {"diorama://scene", "diorama://scene-schema", "diorama://edits-schema"}
        scene = json.loads((await client.read_resource("diorama://scene")).contents[0].text)
        schema = json.loads((await client.read_resource("diorama://scene-schema")).contents[0].text)
        pytest.importorskip("jsonschema").validate(scene, schema)
        assert "SetPlace" in (await client.read_resource("diorama://edits-schema")).contents[0].text

    agent(work)


def test_an_agent_looks_asks_edits_and_undoes(agent, running: Running) -> None:
    before = running.session.scene

    async def work(client: Client) -> None:
        assert [r["project"] for r in (await told(client, "rooms"))["projects"]] == ["demo"]
        room = await told(client, "ask")
        assert {o["id"] for o in room["objects"]} >= {"table_1", "lamp_1"}
        assert running.url.rstrip("/") in room["page"]
        (picture,) = (await client.call_tool("look", {"view": "top", "width": 320, "height": 240})).content
        assert Image.open(io.BytesIO(base64.b64decode(picture.data))).size == (896, 672)
        table = await told(client, "ask", about="one object", object_id="table_1")
        assert table["carries"] == ["lamp_1"]
        assert (await told(client, "ask", about="free floor", width_m=0.5, depth_m=0.5))["spots"]
        assert (await told(client, "ask", about="doubts"))["objects"] == {}
        move = {"do": "place", "objects": ["chair_1"], "base_m": [0.1, 2.2, 0.3]}
        done = await told(client, "edit", edits=[move])
        assert done["changed"] == ["chair_1"]
        assert running.session.document.history.current.author == "Agent"
        assert ["chair_1", "table_1"] in (await told(client, "check"))["collisions"]
        assert (await told(client, "edit", words="make the lamp twice as tall"))["changed"] == ["lamp_1"]
        for _ in range(2):
            await told(client, "undo")
        await told(client, "redo")
        await told(client, "undo")

    agent(work)
    assert running.session.scene == before


def test_an_agent_answers_what_the_build_is_not_sure_of(agent, running: Running) -> None:
    session = running.session
    before = session.scene
    session.ui_thread.ask(lambda: session.commit("doubt", doubtful_scene()))

    async def work(client: Client) -> None:
        first, *others = (await told(client, "questions"))["questions"]
        await told(client, "answer", question=first["id"], value=first["choices"][0]["value"])
        left = (await told(client, "questions"))["questions"]
        assert {q["id"] for q in left} == {q["id"] for q in others}
        assert "armchair" in await refused(client, "answer", question="kind:chair_1", value="unicorn")
        await told(client, "undo")

    agent(work)
    assert session.scene == doubtful_scene()
    session.ui_thread.ask(lambda: session.commit("as before", before))


def test_an_agent_tidies_up_and_exports(agent, running: Running, tmp_path: Path) -> None:
    async def work(client: Client) -> None:
        lift = {"do": "place", "objects": ["chair_2"], "base_m": [1.2, 1.4, 0.5]}
        await told(client, "edit", edits=[lift])
        assert "floats" in (await told(client, "check"))["problems"]["chair_2"]
        await told(client, "optimise", by_hand_too=True)
        assert "chair_2" not in (await told(client, "check"))["problems"]
        written = await told(client, "export", path=str(tmp_path / "room.glb"))
        assert written["bytes"] == (tmp_path / "room.glb").stat().st_size
        await told(client, "undo")
        await told(client, "undo")

    agent(work)
    assert len(trimesh.load_scene(tmp_path / "room.glb").geometry) >= 5


def test_errors_say_in_one_line_what_to_do(agent, running: Running, tmp_path: Path) -> None:
    session = running.session

    async def work(client: Client) -> None:
        assert "sofa_9" in await refused(client, "edit", edits=[{"do": "remove", "objects": ["sofa_9"]}])
        assert "expected tags" in await refused(client, "edit", edits=[{"do": "fly"}])
        assert "either edits or words" in await refused(client, "edit")
        assert "there are: demo" in await refused(client, "open_room", project="nowhere")
        assert "there is no format" in await refused(client, "export", path=str(tmp_path / "a.docx"), format="docx")
        assert "cannot be read" in await refused(client, "build", photo=str(tmp_path / "none.jpg"))
        assert "either a photo or a text" in await refused(client, "build")
        assert "object_id" in await refused(client, "ask", about="one object")
        assert "orbit" in await refused(client, "look", view="sideways")
        await told(client, "ask")
        session.ui_thread.ask(lambda: session.edit("hide lamp", _with_hidden_lamp, author="User 1"))
        stale = await refused(client, "edit", words="remove the lamp")
        assert "by User 1" in stale
        assert "look at it again" in stale
        await told(client, "ask")
        await told(client, "edit", words="remove the lamp")
        await told(client, "undo")
        session.ui_thread.ask(lambda: session.undo("User 1"))

    agent(work)


def test_without_an_open_room_an_agent_is_told_how_to_begin(address: str) -> None:
    async def work() -> None:
        async with Client(mcp_server(Tools(Api(address), None))) as client:
            assert "open_room" in await refused(client, "look")
            room = await told(client, "open_room", project="demo")
            assert room["version"]

    anyio.run(work)


def _with_hidden_lamp(scene: Scene) -> Scene:
    return edits.set_hidden(scene, "lamp_1", True)
