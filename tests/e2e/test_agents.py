"""A person looks on while an agent works through its tools: every step shows, and one undo takes it back."""

from __future__ import annotations

import threading
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import anyio
import pytest
from playwright.sync_api import expect

pytest.importorskip("mcp", reason="needs the MCP SDK (pip install 'diorama[agents]')")
pytest.importorskip("fastapi", reason="needs FastAPI (pip install 'diorama[agents]')")

from mcp import Client  # after the check for its library

from diorama_app.agents.api import Api
from diorama_app.agents.server import mcp_server
from diorama_app.agents.tools import Tools
from diorama_app.http_api import beside
from tests.e2e.browser import EditorPage
from tests.e2e.conftest import keep_picture

pytestmark = pytest.mark.browser


def beside_the_page(address: str, work: Callable[[Client], Awaitable[Any]]) -> None:
    """An agent at work, in a thread of its own: Playwright has this one's loop."""

    async def connected() -> None:
        async with Client(mcp_server(Tools(Api(address), "demo"))) as client:
            await work(client)

    failed: list[BaseException] = []

    def run() -> None:
        try:
            anyio.run(connected)
        except BaseException as error:  # raised again where the test can see it
            failed.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    thread.join(60.0)
    assert not thread.is_alive()
    if failed:
        raise failed[0]


def test_a_person_sees_an_agents_step_and_takes_it_back(
    editor: EditorPage, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(beside, "_folder", lambda: tmp_path)
    before = editor.session.scene
    move = {"do": "place", "objects": ["chair_1"], "base_m": [-1.3, 0.9, 0.0], "heading_deg": 45.0}

    async def edit(client: Client) -> None:
        result = await client.call_tool("edit", {"edits": [move]})
        assert not result.is_error, result.content

    with beside.api_beside(editor.running, None) as address:
        beside_the_page(address, edit)
        toast = editor.page.get_by_text("Agent: Place chair at (-1.30, 0.90, 0.00) m")
        expect(toast).to_be_visible()
        editor.settle()
        keep_picture(editor, "agent-step")
        assert editor.session.scene.object("chair_1").pose != before.object("chair_1").pose
        editor.page.get_by_role("button", name="Undo", exact=True).last.click()
        editor.until(lambda: editor.session.scene == before, "one undo takes it back")
