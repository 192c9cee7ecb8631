from __future__ import annotations

from diorama_app.panels.help import MOUSE, show_help
from tests.app.page import Page


def test_every_command_is_named_once_and_the_dialog_closes(session, client, page: Page, commands) -> None:
    client.viser_client.gui = page
    show_help(client, commands)
    for command in commands.all:
        assert command.label in page.html
        assert not command.keys or f"<kbd>{command.keys}</kbd>" in page.html
    assert all(f"<kbd>{keys}</kbd>" in page.html for _, keys in MOUSE)
    assert [t.split("<")[0] for t in page.html.split("<h4>")[1:]] == ["Mouse", "Objects", "View", "Project"]
    first = client.dialog
    assert first is not None
    show_help(client, commands)
    assert client.dialog is not first
    page.press("Close")
    assert client.dialog is None
