"""`diorama mcp`: tools for agents."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from diorama_app.cli.arguments import command, need, projects_folder


def add_mcp(commands: Any) -> None:
    """Declare `diorama mcp`."""
    p = command(
        commands, "mcp", _mcp, "Let an agent work on a project, beside the browser (Model Context Protocol).",
        "diorama mcp my-room",
    )  # fmt: skip
    p.add_argument("project", nargs="?", type=Path, metavar="PROJECT", help="project folder to begin with")
    p.add_argument("--http", type=int, metavar="PORT", help="streamable HTTP on this port instead of stdio")


def _mcp(a: argparse.Namespace) -> None:
    need("diorama mcp", "agents", "fastapi", "python_multipart", "uvicorn", "mcp")
    from diorama_app.agents.server import serve_mcp

    serve_mcp(a.project, projects_folder(None), a.http)
