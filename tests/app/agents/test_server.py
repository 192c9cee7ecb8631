"""`diorama mcp` as an agent's program starts it, over both transports."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import anyio
import pytest

pytest.importorskip("mcp", reason="needs the MCP SDK (pip install 'diorama[agents]')")
pytest.importorskip("fastapi", reason="needs FastAPI (pip install 'diorama[agents]')")

from mcp import Client  # after the check for its library
from mcp.client.stdio import StdioServerParameters

from diorama_app.projects.example import example_project
from tests.cli.room_photo import write_room
from tests.cli.running import refused
from tests.waiting import until

pytestmark = pytest.mark.posix

ROOT = Path(__file__).resolve().parents[3]
COMMAND = ["-m", "tests.small_planes", "mcp"]


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A person's folder with one project, and nothing of what runs on this machine otherwise."""
    folder = tmp_path_factory.mktemp("home")
    example_project(folder / "Diorama")
    return folder


@pytest.fixture(scope="module")
def environment(home: Path) -> dict[str, str]:
    kept = {name: value for name, value in os.environ.items() if not name.startswith("XDG_")}
    return {**kept, "HOME": str(home), "PYTHONPATH": str(ROOT)}


@pytest.fixture(scope="module")
def over_http(home: Path, environment: dict[str, str]) -> Iterator[str]:
    command = [sys.executable, *COMMAND, str(home / "Diorama" / "example"), "--http", "0"]
    process = subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True, cwd=ROOT)
    assert process.stderr is not None
    lines = [process.stderr.readline() for _ in range(2)]
    assert "seen at http://127.0.0.1:" in lines[0], lines
    yield lines[1].split(" at ")[1].split()[0]
    process.send_signal(signal.SIGINT)
    try:
        assert process.wait(60) == 0
    finally:
        process.kill()
        process.wait()
        process.stderr.close()


def test_an_agent_comes_over_http_and_a_second_joins_over_stdio(
    over_http: str, home: Path, environment: dict[str, str]
) -> None:
    room = str(home / "Diorama" / "example")
    second = StdioServerParameters(command=sys.executable, args=[*COMMAND, room], env=environment, cwd=ROOT)

    async def work() -> None:
        async with Client(over_http) as first, Client(second) as other:
            room = (await first.call_tool("ask", {})).structured_content
            assert room["project"] == "example"
            done = await first.call_tool("edit", {"words": "remove the armchair"})
            assert not done.is_error, done.content[0].text
            seen = (await other.call_tool("ask", {})).structured_content
            assert seen["page"] == room["page"], "both are in the same editor"
            assert {o["id"] for o in seen["objects"]} < {o["id"] for o in room["objects"]}
            await first.call_tool("undo", {})

    anyio.run(work)
    scene = home / "Diorama" / "example" / "scene.json"
    until(lambda: "armchair" in json.dumps(json.loads(scene.read_text())["objects"]))


def test_a_taken_port_and_a_missing_project_are_one_line(
    over_http: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    port = over_http.split(":")[2].split("/")[0]
    assert f"port {port}" in refused(capsys, ["mcp", "--http", port])
    assert "is not a project" in refused(capsys, ["mcp", str(tmp_path)])


@pytest.mark.slow
def test_an_agent_builds_from_a_photo(over_http: str, tmp_path: Path) -> None:
    image, boxes = write_room(tmp_path, marked=1)
    told: list[str] = []

    async def progress(share: float, total: float | None, message: str | None) -> None:
        told.append(message or "")

    async def work() -> None:
        async with Client(over_http, read_timeout_seconds=300.0) as client:
            given = {"photo": str(image), "boxes": json.loads(boxes.read_text()), "fov_deg": 62.0}
            built = await client.call_tool("build", given, progress_callback=progress)
            assert not built.is_error, built.content[0].text
            room = built.structured_content
            assert len(room["objects"]) >= 1
            assert room["job"]["message"] == "done"
            assert (await client.call_tool("rooms", {})).structured_content["projects"][0]["open"]

    anyio.run(work)
    assert told, "it is told how far the build is"
