"""Files that are chosen in the page reach what takes them; buttons that are hidden are not drawn."""

from __future__ import annotations

from diorama_app.panels.fields import UploadField, add_hidden_upload
from diorama_app.session.client import Client
from tests.app.page import Page


def test_a_chosen_file_is_handed_over_by_name_and_content(session, client: Client, page: Page) -> None:
    taken: list[tuple[str, bytes]] = []
    field = UploadField(page, client, "Open", lambda name, content: taken.append((name, content)))
    page.upload("Open", "room.png", b"123")
    session.ui_thread.wait()
    assert taken == [("room.png", b"123")]
    assert field.visible


def test_a_hidden_button_has_a_style_that_hides_it(client: Client, page: Page) -> None:
    shown = UploadField(page, client, "Open", lambda *_: None)
    hidden = add_hidden_upload(page, client, "Dropped", lambda *_: None)
    assert f"#file_upload_{hidden}" in page.html
    assert f"#file_upload_{shown.uuid}" not in page.html
    shown.show_if(False)
    assert not shown.visible
    assert f"#file_upload_{shown.uuid}" in page.html
