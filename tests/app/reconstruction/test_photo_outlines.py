from __future__ import annotations

from dataclasses import replace

import pytest

from diorama_app.reconstruction.photo_outlines import PhotoOutlines
from diorama_core.errors import EditRefused
from tests.app.people import settle


def test_what_was_found_in_the_photo_is_outlined_once(session, client, monkeypatch) -> None:
    outlines = PhotoOutlines(session)
    assert outlines.objects is None
    outlines.find(client)
    settle(session)
    (table,) = outlines.objects
    assert table.category == "table"
    assert table.mask[320, 340]
    assert not table.mask[50, 50]
    monkeypatch.setattr(session.jobs, "start", lambda *given: pytest.fail("outlined again"))
    outlines.find(client)


def test_another_photo_is_not_shown_with_the_old_outlines(session, client) -> None:
    outlines = PhotoOutlines(session)
    outlines.find(client)
    settle(session)
    session.document.open(session.scene, replace(session.inputs, photo=replace(session.photo, name="another")))
    assert outlines.objects is None


def test_without_a_photo_it_says_what_to_do(session, client) -> None:
    session.document.open(session.scene)
    with pytest.raises(EditRefused, match="no photo"):
        PhotoOutlines(session).find(client)
