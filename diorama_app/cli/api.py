"""`diorama api` and `diorama mcp`: HTTP for other programs, tools for agents."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from diorama_app.cli.arguments import PROJECTS_HELP, command, need, projects_folder


def add_api(commands: Any) -> None:
    """Declare `diorama api`."""
    p = command(commands, "api", _api, "diorama api --port 8090")
    p.add_argument("--host", default="127.0.0.1", help="address to listen on (default: %(default)s)")
    p.add_argument("--port", type=int, default=8090, help="port to listen on, 0 for any (default: %(default)s)")
    p.add_argument("--projects", type=Path, metavar="DIR", help=PROJECTS_HELP)
    p.add_argument("--token", metavar="T", help="requests must bring this token: needed for hosts other than this one")
    p.add_argument("--library", default="built-in", metavar="NAME", help="shape library (default: %(default)s)")


def _api(a: argparse.Namespace) -> None:
    """Answer other programs over HTTP: photos in, scenes out."""
    need("diorama api", "api", "fastapi", "python_multipart", "uvicorn")
    from diorama_app.http_api.server import serve_api

    serve_api(
        projects_dir=projects_folder(a.projects),
        host=a.host,
        port=a.port,
        token=a.token,
        library=a.library,
    )


def add_mcp(commands: Any) -> None:
    """Declare `diorama mcp`."""
    p = command(commands, "mcp", _mcp, "diorama mcp my-room")
    p.add_argument("project", nargs="?", type=Path, metavar="PROJECT", help="project folder to begin with")
    p.add_argument("--http", type=int, metavar="PORT", help="streamable HTTP on this port instead of stdio")


def _mcp(a: argparse.Namespace) -> None:
    """Let an agent work on a project, beside the browser (Model Context Protocol)."""
    need("diorama mcp", "agents", "fastapi", "python_multipart", "uvicorn", "mcp")
    from diorama_app.agents.server import serve_mcp

    serve_mcp(a.project, projects_folder(None), a.http)
