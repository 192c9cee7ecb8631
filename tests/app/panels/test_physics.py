from __future__ import annotations

import numpy as np
import pytest

from diorama_app.commands import edit as editing
from diorama_app.panels.physics import Physics
from tests.app.page import Page
from tests.app.people import node


@pytest.fixture
def panel(page: Page, client) -> Physics:
    return page.put(Physics)


def colliders(client):
    return node(client.session.server, "/colliders")


def test_physics_are_folded_until_somebody_wants_them(session, client, page, panel) -> None:
    client.select(["table_1"])
    assert "Physics" in page.html
    assert "Mass" not in page.html
    page.act("fold")
    assert "Mass" in page.html
    assert "Moves</td><td>freely" in page.html
    assert "5 convex parts" in page.html, "a top and four legs"
    drawn, table = colliders(client), session.scene.object("table_1")
    np.testing.assert_allclose(np.ptp(drawn.vertices, axis=0), np.ptp(table.corners_world, axis=0), atol=1e-3)
    page.act("fold")
    assert "Mass" not in page.html
    assert colliders(client) is None


def test_colliders_follow_and_what_holds_an_object_is_told(session, client, page, panel) -> None:
    client.change_preferences(physics=True)
    client.select(["picture_1"])
    assert "no: fixed to wall 3" in page.html
    client.select(["chair_1"])
    before = np.array(colliders(client).vertices)
    editing.set_base_position(client, "chair_1", np.array([0.5, 0.5, 0.0]))
    assert not np.allclose(colliders(client).vertices, before)
    editing.set_locked(client, ["chair_1"], True)
    assert "no: it is locked" in page.html
    client.select(())
    assert colliders(client) is None
