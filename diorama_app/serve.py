"""The editor's server: start it, stop it.

The port opens first: while a browser fetches the page, the editor and the library are imported.
"""

from __future__ import annotations

import atexit
import contextlib
import os
import signal
import socket
import sys
import threading
import time
import webbrowser
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import viser

import diorama_core as diorama
from diorama_app.session.preparation import warm_up
from diorama_app.strings import SOURCE_LANGUAGE, use_language
from diorama_app.web.viser_adapter import create_server, stop_server
from diorama_app.web.visitors import ANY_HOST, Visitors, page_address, with_token
from diorama_core.io.large_libraries import load_quickly
from diorama_core.project.storage import Project

if TYPE_CHECKING:
    from diorama_app.app import Editor
    from diorama_app.session.session import EditorSession
    from diorama_app.workspace import Workspace
    from diorama_core.library.record import ShapeLibrary

SIGNALS_S = 1.0
"""How often Ctrl+C and a request to end are looked for, in seconds."""
MAX_LOADING_S = 5.0
"""How long stopping waits for libraries that are being loaded: nobody needs them any more."""
MAX_START_S = 60.0
"""How long a browser waits that came before the editor was there."""


@dataclass(frozen=True)
class Running:
    """A running server."""

    server: viser.ViserServer
    workspace: Workspace
    url: str
    """Where to open it, token included."""
    stopped: threading.Event
    """Set when it has been stopped."""
    loading: threading.Thread
    """Loads in the background what the first build needs."""

    @property
    def editor(self) -> Editor:
        """The first editor: that of an address without a project."""
        return self.workspace.editors[0]

    @property
    def session(self) -> EditorSession:
        """The session of the first editor."""
        return self.editor.session

    @property
    def port(self) -> int:
        """The port it listens on."""
        return int(self.server.get_port())

    def stop(self) -> None:
        """Save, end jobs, close the port; wait a little for libraries that are being loaded."""
        self.stopped.set()
        self.workspace.close()
        stop_server(self.server)
        self.loading.join(MAX_LOADING_S)
        if self.loading.is_alive():  # an interpreter that ends while another thread loads native code aborts
            atexit.register(self.loading.join)

    def leave(self) -> None:
        """End the process after `stop` where a library is still being loaded, which takes minutes on a busy machine."""
        if self.loading.is_alive():
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(0)


def start(
    *,
    project: Path | None = None,
    projects_dir: Path,
    host: str = "127.0.0.1",
    port: int = 0,
    low_graphics: bool = False,
    token: str | None = None,
    library: str | ShapeLibrary = "built-in",
    frame_origins: Sequence[str] = (),
    language: str = SOURCE_LANGUAGE,
) -> Running:
    """Start the editor in the background.

    Args:
        project: folder to open; the bundled example when None.
        projects_dir: where new projects are made and recent ones are found.
        host: address to listen on; loopback unless asked otherwise.
        port: 0 lets the system choose.
        low_graphics: no shadows, no environment map.
        token: access token of clients; generated when other machines can reach the server and none is given.
        library: where shapes come from, or its name.
        frame_origins: whose pages may show the editor in a frame; see `Visitors`.
        language: of the page; see `use_language`.

    Raises:
        InputError: the port is taken, an origin is none, or there is no such translation.
        LibraryError: there is no library of that name.
        ProjectError, SceneError: the project cannot be opened.
    """
    use_language(language)
    opened = None if project is None else Project.open(project)
    made: list[Workspace] = []

    host = host or "0.0.0.0"  # an empty one means every address, on a port for each kind
    token = with_token(host, token)

    def refuse(client_id: int, line: str) -> None:
        for workspace in made:
            workspace.editors[0].refuse_upload(client_id, line)

    server = create_server(
        host=host,
        port=port,
        label="Diorama",
        visitors=Visitors(host, token, tuple(frame_origins)),
        refused=refuse,
        pictures=lambda name: made[0].picture(name) if made else _no_picture(),
        projects=_Opening(made),
    )
    try:
        load_quickly()
        from diorama_app.workspace import Workspace

        if isinstance(library, str):
            library = diorama.open_library(library)
        workspace = Workspace(library, projects_dir, low_graphics=low_graphics)
        workspace.begin(server, opened)
        made.append(workspace)
    except BaseException:
        stop_server(server)
        raise
    stopped = threading.Event()
    loading = threading.Thread(target=warm_up, args=(stopped,), daemon=True, name="warm up")
    loading.start()
    return Running(server, workspace, page_address(host, server.get_port(), token), stopped, loading)


Beside = Callable[[Running, str | None], contextlib.AbstractContextManager[object]]
"""Runs beside an editor, given its token, for as long as the context lasts."""


@dataclass(frozen=True)
class _Opening:
    """Projects of a server whose editor is being put together; browsers that come earlier wait for it."""

    made: list[Workspace]

    def first(self) -> str | None:
        return self.made[0].first() if self.made else None

    def server(self, name: str) -> viser.ViserServer | None:
        until = time.monotonic() + MAX_START_S
        while not self.made and time.monotonic() < until:
            time.sleep(0.05)
        return self.made[0].server(name) if self.made else None


def _no_picture() -> Future[bytes | None]:
    nothing: Future[bytes | None] = Future()  # a page of an earlier server asks before the editor is there
    nothing.set_result(None)
    return nothing


def serve(
    *,
    project: Path | None,
    projects_dir: Path,
    host: str,
    port: int,
    open_browser: bool,
    low_graphics: bool,
    token: str | None,
    library: str | ShapeLibrary = "built-in",
    frame_origins: Sequence[str] = (),
    language: str = SOURCE_LANGUAGE,
    beside: Beside | None = None,
) -> None:
    """Run the editor until Ctrl+C.

    Args:
        project: to open; None for the start page.
        projects_dir: where projects are kept.
        host: to listen at.
        port: to listen at.
        open_browser: whether to open one here.
        low_graphics: whether to draw for machines without a graphics card.
        token: that pages must bring; None for none.
        library: by name, or itself.
        frame_origins: whose pages may show the editor in a frame.
        language: of the page.
        beside: what runs beside it, of its editor and token: the HTTP interface.
    """
    token = with_token(host or "0.0.0.0", token)
    running = start(
        project=project,
        projects_dir=projects_dir,
        host=host,
        port=port,
        low_graphics=low_graphics,
        token=token,
        library=library,
        frame_origins=frame_origins,
        language=language,
    )
    asked = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: asked.set())  # before anybody is told that it runs
    print(f"Diorama is at {running.url} (Ctrl+C stops it)", flush=True)
    if host in ANY_HOST:
        address = running.url.replace(urlsplit(running.url).netloc, f"{socket.gethostname()}:{running.port}")
        print(f"From other machines: {address} (who has this address can change the project)", flush=True)
    if open_browser:
        threading.Thread(target=webbrowser.open, args=(running.url,), daemon=True).start()
    try:
        with contextlib.nullcontext() if beside is None else beside(running, token):
            while not asked.wait(SIGNALS_S):  # a signal that another thread takes does not wake this one
                pass
    except KeyboardInterrupt:
        print("Saving and stopping.", flush=True)
    finally:
        running.stop()
    running.leave()
