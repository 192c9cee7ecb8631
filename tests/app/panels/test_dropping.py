from __future__ import annotations

import html
import json
import re

from diorama_app.panels.dropping import MODELS, take_dropped_files
from diorama_app.web.viser_adapter import component_uuid
from tests.app.page import Page


def test_files_go_where_their_kind_belongs(page: Page, client) -> None:
    taken: list[tuple[str, str, bytes]] = []
    takes = {kind: lambda n, c, kind=kind: taken.append((kind, n, c)) for kind in ("photo", "model", "scene")}
    take_dropped_files(page, client, takes["photo"], takes["model"], takes["scene"])
    uploads = [h for kind, _, h in page.made if kind == "upload_button"]
    script = html.unescape(page.html)
    to = json.loads(re.search(r"to=(\{.*?\})", script).group(1))
    assert {k for k in to if k} >= set(MODELS)
    kinds = {component_uuid(h): h for h in uploads}
    for uuid, name, expected in ((to[""], "room.jpg", "photo"), (to["glb"], "lamp.glb", "model")):
        page.made.append(("upload_button", "this one", kinds[uuid]))
        page.upload("this one", name, b"bytes")
        assert taken.pop() == (expected, name, b"bytes")
    # The buttons themselves are out of sight.
    assert all(f"#file_upload_{uuid}" in page.html for uuid in kinds)
