from __future__ import annotations

import numpy as np
import pytest

from diorama_app.panels.room_size import Tape
from diorama_app.session.client import Measuring
from diorama_app.session.units import format_length
from tests.app.page import Page


@pytest.fixture
def tape(page: Page, client) -> Tape:
    made = page.put(Tape)
    client.doing = Measuring(((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)))
    made.refresh()
    return made


def test_the_length_is_shown_in_the_persons_unit(page, client, tape) -> None:
    for unit in ("m", "cm", "ft-in"):
        client.change_preferences(unit=unit)
        assert f"<b>{format_length(1.0, unit).replace(chr(39), '&#x27;').replace(chr(34), '&quot;')}</b>" in page.html


def test_the_true_length_scales_everything(session, page, client, tape) -> None:
    before = session.scene.object("table_1").size_m
    page.change("true", "2 m")
    np.testing.assert_allclose(session.scene.object("table_1").size_m, 2.0 * before)


def test_an_empty_length_changes_nothing_and_done_puts_it_away(session, page, client, tape) -> None:
    before = session.scene
    page.change("true", "  ")
    page.change("true", "a mile or so")
    assert session.scene is before
    assert client.viser_client.told, "nonsense is refused aloud"
    page.act("done")
    assert client.doing is None
    assert "between the two points" not in page.html
