"""What a session needs of a browser that is connected to it; `Client` has it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, runtime_checkable

from diorama_app.viewport.client_view import ClientView, NoticeKind


@runtime_checkable
class Panel(Protocol):
    """A part of the page that shows something of the scene."""

    def refresh(self) -> None:
        """Draw what differs from what is drawn."""
        ...


@runtime_checkable
class ConnectedClient(Protocol):
    """One browser, as the session sees it."""

    id: int
    name: str
    colour: tuple[int, int, int]
    view: ClientView
    selection: tuple[str, ...]
    doing: Any
    job_panel: Panel | None
    curves: Panel | None
    """What is redrawn while a layout is optimised."""
    has_left: bool
    """Whether the page was closed: nobody waits for anything any more."""
    to_say: tuple[str, bool] | None
    """A line for the foot of the view, and whether it offers undo."""
    toast: Callable[[str, bool], None]
    offer: Callable[[str, str, Callable[[], None]], None]
    """Shows a line that stays, with a button that does something."""
    open_tab: Callable[[str], None]
    open_board: Callable[[], None]
    go_to: Callable[[str], None]
    """Takes this browser to a project, by the name of its folder."""

    def forget_choices(self) -> None:
        """Choose nothing: ids and places in lists mean something else in another project."""
        ...

    def drop_missing(self) -> None:
        """Deselect objects that no longer exist."""
        ...

    def refresh(self) -> None:
        """Update this browser's marks and panels to the document."""
        ...

    def notice(self, message: str, kind: NoticeKind = "info") -> None:
        """Show a message to the user."""
        ...

    def post(self, task: Callable[[], None], *, key: str | None = None) -> None:
        """Do `task` on the UI thread; the user is notified when it fails. May be called from any thread."""
        ...
