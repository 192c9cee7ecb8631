"""Requests to a running editor. Needs no Blender."""

from __future__ import annotations

import json
import os
import sys
import urllib.error
import urllib.request
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import quote

TIMEOUT_S = 120.0
"""The longest request: a large room is exported."""
ATTEMPTS = 5
"""Exports of a room that somebody changes meanwhile."""
AUTHOR = "Blender"


class RefusedError(Exception):
    """What to show instead of an answer, in one line."""


@dataclass(frozen=True)
class Client:
    """An editor's address and token."""

    address: str
    token: str = ""

    def projects(self) -> list[dict[str, Any]]:
        """All projects, the open ones first."""
        return list(self._json("v1/projects")["projects"])

    def room(self, project: str) -> tuple[str, bytes]:
        """A room's version and its GLB file."""
        path = f"v1/projects/{quote(project)}"
        version = str(self._json(path)["version"])
        for _ in range(ATTEMPTS):
            content, before = self._send(f"{path}/export/glb"), version
            version = str(self._json(path)["version"])
            if version == before:
                return version, content
        raise RefusedError("the room changes all the time; open it again when the others have finished")

    def scene(self, project: str) -> dict[str, Any]:
        """A room's scene file."""
        return dict(self._json(f"v1/projects/{quote(project)}/scene"))

    def edit(self, project: str, version: str, edits: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
        """Do edits as one step; gives the new version and what was done.

        Args:
            project: its name.
            version: of the room that they were made for.
            edits: typed edits.
        """
        body = {"version": version, "edits": list(edits), "author": AUTHOR}
        return dict(self._json(f"v1/projects/{quote(project)}/edits", body))

    def _json(self, path: str, body: Mapping[str, Any] | None = None) -> Any:
        try:
            return json.loads(self._send(path, body))
        except ValueError as error:
            raise RefusedError(self._no_interface()) from error

    def _no_interface(self) -> str:
        return (
            f"{self.address} is no editor's HTTP interface, which is not at the page's address; "
            "leave the address empty to find the editor of this machine"
        )

    def _send(self, path: str, body: Mapping[str, Any] | None = None) -> bytes:
        headers = {"Authorization": f"Bearer {self.token}"} if self.token else {}
        content = None if body is None else json.dumps(body).encode()
        if content is not None:
            headers["Content-Type"] = "application/json"
        try:
            request = urllib.request.Request(f"{self.address.rstrip('/')}/{path}", content, headers)
            with urllib.request.urlopen(request, timeout=TIMEOUT_S) as reply:
                return bytes(reply.read())
        except urllib.error.HTTPError as error:
            with error:
                raise RefusedError(_advice(error.code, _line_of(error.read()) or self._no_interface())) from error
        except (OSError, ValueError) as error:
            advice = "start 'diorama serve', or check the address"
            raise RefusedError(f"no editor answers at {self.address} ({error}); {advice}") from error


def local_editor() -> Client:
    """The editor that was started last on this machine, by the note that it left."""
    notes = sorted(_state_folder().glob("servers/*.json"), key=lambda p: p.stat().st_mtime, reverse=True)
    for path in notes:
        try:
            note = json.loads(path.read_text(encoding="utf-8"))
            client = Client(str(note["address"]), str(note["token"] or ""))
            client.projects()
            return client
        except (OSError, ValueError, LookupError, RefusedError):
            continue  # left behind by a server that is gone
    raise RefusedError("no editor runs on this machine: start 'diorama serve', or give an address and a token")


def _state_folder() -> Path:
    """Where editors leave notes: the folder that platformdirs names as the user's state."""
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or Path.home() / "AppData" / "Local") / "diorama"
    if sys.platform == "darwin":
        return Path.home() / "Library" / "Application Support" / "diorama"
    return Path(os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state") / "diorama"


def _advice(status: int, line: str) -> str:
    if status == 409:
        return f"press Reload (what you changed stays), look, and send again: {line}"
    return f"{line}; give the token that the page's address ends with" if status == 401 else line


def _line_of(body: bytes) -> str | None:
    """The line of an editor's refusal; None for an answer of something else."""
    try:
        return str(json.loads(body)["error"])
    except (ValueError, LookupError, TypeError):
        return None
