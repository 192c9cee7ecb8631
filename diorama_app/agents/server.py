"""The process of `diorama mcp`: it joins the editor that has the project open, or starts one of its own."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import uvicorn
from mcp.server.mcpserver import Context, MCPServer
from mcp.server.mcpserver.exceptions import ResourceError, ToolError, UnexpectedResourceError, UnexpectedToolError
from pydantic import ValidationError

from diorama_app.agents.api import Api
from diorama_app.agents.tools import INSTRUCTIONS, Tools
from diorama_app.http_api.beside import HOST, api_beside, find_servers
from diorama_app.http_api.server import listen
from diorama_app.serve import start
from diorama_core.errors import DioramaError, ProjectError
from diorama_core.io.text import clean_text
from diorama_core.project.storage import Project


class _Server(MCPServer[Any]):  # type: ignore[misc]  # the SDK's classes are Any to mypy (pyproject.toml)
    """Tells every error in one line: what was wrong and what to do."""

    async def call_tool(self, name: str, arguments: dict[str, Any], context: Context[Any, Any] | None = None) -> Any:
        """As the SDK does; what Diorama and its schemas refuse is told in their own line."""
        try:
            return await super().call_tool(name, arguments, context)
        except ToolError as error:
            cause = error.__cause__
            if isinstance(cause, ValidationError):
                first = cause.errors()[0]
                where = ".".join(str(part) for part in first["loc"]) or name
                raise ToolError(clean_text(f"{where}: {first['msg']}")) from cause
            if isinstance(error, UnexpectedToolError) and isinstance(cause, DioramaError):
                raise ToolError(clean_text(" ".join(str(cause).split()))) from cause
            raise

    async def read_resource(self, *given: Any, **more: Any) -> Any:
        """As the SDK does; what Diorama refuses is told in its own line."""
        try:
            return await super().read_resource(*given, **more)
        except UnexpectedResourceError as error:
            if isinstance(error.__cause__, DioramaError):
                raise ResourceError(str(error.__cause__)) from error.__cause__
            raise


def mcp_server(tools: Tools) -> MCPServer[Any]:
    """The server of an agent's tools."""
    server = _Server("diorama", title="Diorama", instructions=INSTRUCTIONS, log_level="WARNING")
    for tool in tools.all():
        server.add_tool(tool)
    for uri, read in (
        ("diorama://scene", tools.scene_file),
        ("diorama://scene-schema", tools.scene_schema),
        ("diorama://edits-schema", tools.edits_schema),
    ):
        about = (read.__doc__ or "").strip()
        server.resource(uri, name=uri.partition("://")[2], description=about, mime_type="application/json")(read)
    return server


def serve_mcp(project: Path | None, projects_dir: Path, http_port: int | None) -> None:
    """Answer an agent until its end of input, or over HTTP until Ctrl+C.

    Args:
        project: to open first; None leaves that to the agent.
        projects_dir: where projects are, where no editor runs yet.
        http_port: of this machine, for streamable HTTP at `/mcp`; None for stdio.

    Raises:
        ProjectError, SceneError: the project cannot be opened.
        InputError: the port is taken.
    """
    folder = None if project is None else Project.open(project).folder.resolve()
    listening = None if http_port is None else listen(HOST, http_port)
    with _editor(folder, projects_dir) as (api, name):
        server = mcp_server(Tools(api, name))
        if listening is None:
            server.run("stdio")
            return
        port = listening.getsockname()[1]
        print(f"An agent reaches Diorama at http://{HOST}:{port}/mcp (Ctrl+C stops it)", file=sys.stderr)
        config = uvicorn.Config(server.streamable_http_app(host=HOST), log_level="warning", server_header=False)
        with listening, contextlib.suppress(KeyboardInterrupt):
            uvicorn.Server(config).run(sockets=[listening])


@contextlib.contextmanager
def _editor(folder: Path | None, projects_dir: Path) -> Iterator[tuple[Api, str | None]]:
    """An editor that runs already and has the project, or one that is started for the time being."""
    for server in find_servers():
        api = Api(server.address, server.token)
        rows: Sequence[dict[str, Any]] = api.get("v1/projects")["projects"]
        here = next((row["project"] for row in rows if folder is not None and Path(row["folder"]) == folder), None)
        if here is not None or folder is None:
            shown = api.get(f"v1/projects/{here or rows[0]['project']}") if rows else {"page": server.address}
            print(f"An editor is running: the agent's steps are seen at {shown['page']}", file=sys.stderr)
            yield api, here or next((row["project"] for row in rows if row["open"]), None)
            return
    running = start(project=folder, projects_dir=projects_dir)
    try:
        opened = running.session.project
        if folder is not None and running.session.read_only:
            raise ProjectError(running.session.read_only)
        with api_beside(running, None) as address:
            print(f"The agent's steps are seen at {running.url}", file=sys.stderr)
            yield Api(address), None if opened is None else opened.folder.name
    finally:
        running.stop()
    running.leave()
