from __future__ import annotations

from diorama_app.panels.dialog import dialog
from diorama_app.session.client import Client
from tests.app.page import Page


def test_one_dialog_at_a_time(client: Client, page: Page) -> None:
    client.viser_client.gui = page
    with dialog(client, "First") as close_first:
        assert client.dialog is close_first
    with dialog(client, "Second") as close_second:
        page.add_button("Inside")
    assert client.dialog is close_second
    first, second = (handle for kind, _, handle in page.made if kind == "modal")
    modals = page.gui._modal_handle_from_uuid
    assert first._uuid not in modals
    assert second._uuid in modals
    client.dialog()
    assert client.dialog is None
    assert second._uuid not in modals
