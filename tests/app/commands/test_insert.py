from __future__ import annotations

import pytest

from diorama_app.commands.insert import insert_shape
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession


def parent_of_new(session: EditorSession, client: Client) -> str:
    edge = session.scene.support_of(client.selection[0])
    assert edge is not None
    return edge.parent


def test_what_stands_on_tables_is_put_on_the_selected_table(session: EditorSession, client: Client) -> None:
    client.select(["table_1"])
    insert_shape(client, "lamp_a")
    assert parent_of_new(session, client) == "table_1"
    table, lamp = session.scene.object("table_1"), session.scene.object(client.selection[0])
    assert lamp.corners_world[:, 2].min() == pytest.approx(table.corners_world[:, 2].max(), abs=1e-6)


@pytest.mark.parametrize("shape_id", ["chair_a", "table_b"])
def test_furniture_is_put_on_the_floor_whatever_is_selected(
    session: EditorSession, client: Client, shape_id: str
) -> None:
    client.select(["table_1"])
    insert_shape(client, shape_id)
    assert parent_of_new(session, client) == "floor"


def test_a_lamp_is_not_put_on_a_chair(session: EditorSession, client: Client) -> None:
    client.select(["chair_1"])
    insert_shape(client, "lamp_a")
    assert parent_of_new(session, client) == "floor"
