from __future__ import annotations

import io

import pytest
from PIL import Image

from diorama_app.panels.plan_picture import PicturesBelow
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_core.errors import InputError
from diorama_core.project.plan_picture import load_plan_picture
from tests.app.page import Page
from tests.waiting import until


def test_a_picture_is_kept_moved_and_removed(session: EditorSession, client: Client, page: Page) -> None:
    below = page.put(PicturesBelow, lambda: [[-2.0, -1.0], [2.0, 1.0]])
    buffer = io.BytesIO()
    Image.new("RGB", (400, 200)).save(buffer, "PNG")
    below._receive("plan.png", buffer.getvalue())
    until(lambda: load_plan_picture(session.project) is not None)
    _, picture = load_plan_picture(session.project)
    assert (picture.size, picture.at, picture.metres) == ((400, 200), (0.0, 0.0), 0.01)
    below.place({"at": [1.0, 2.0], "metres": 0.02})
    assert load_plan_picture(session.project)[1].at == (1.0, 2.0)
    with pytest.raises(InputError, match="cannot lie there"):
        below.place({"at": [1.0, 2.0], "metres": 1e9})
    below.place(None)
    assert load_plan_picture(session.project) is None


def test_a_file_that_is_no_picture_is_one_line(session: EditorSession, client: Client, page: Page) -> None:
    below = PicturesBelow(page, client, lambda: [[-2.0, -1.0], [2.0, 1.0]])
    said: list[str] = []
    client.view.notice = lambda message, kind: said.append(message)
    below._receive("plan.txt", b"hello")
    until(lambda: bool(said))
    assert said[0].startswith("plan.txt is not a whole picture")
