"""Dialogs over the page, one at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from diorama_app.session.client import Client


@contextmanager
def dialog(client: Client, title: str) -> Iterator[Callable[[], None]]:
    """What is made inside the block is in a dialog, in place of one that is open; gives what closes it."""
    if client.dialog is not None:
        client.dialog()

    def close() -> None:
        client.dialog = None
        modal.close()

    with client.viser_client.gui.add_modal(title) as modal:
        client.dialog = close
        yield close
