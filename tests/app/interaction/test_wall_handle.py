from __future__ import annotations

import numpy as np
import pytest

from diorama_app.interaction.wall_handle import WallHandle


@pytest.fixture
def handle(client) -> WallHandle:
    made = WallHandle(client)
    client.panels = [made]
    return made


def pull(handle: WallHandle, session, plane_id: str, outward_m: float) -> None:
    plane = session.scene.plane(plane_id)
    start = 0.5 * (plane.polygon.min(axis=0) + plane.polygon.max(axis=0))
    handle._move("start", start)
    handle._move("update", start - 0.5 * outward_m * plane.normal)
    handle._move("end", start - outward_m * plane.normal)


def test_a_pull_moves_the_wall_as_one_step(session, client, handle) -> None:
    client.select_surface("wall_2")
    session.ui_thread.wait()
    before = session.scene
    pull(handle, session, "wall_2", 0.43)
    wall, old = session.scene.plane("wall_2"), before.plane("wall_2")
    assert float((old.centre - wall.centre) @ old.normal) == pytest.approx(0.43)
    session.undo(client)
    assert session.scene == before


def test_snapping_and_a_pull_of_nothing(session, client, handle) -> None:
    client.select_surface("ceiling")
    session.ui_thread.wait()
    before = session.scene
    pull(handle, session, "ceiling", 0.0)
    assert session.scene is before
    client.change_preferences(snap=True)
    pull(handle, session, "ceiling", 0.23)
    assert float(np.max(session.scene.plane("ceiling").polygon[:, 2])) == pytest.approx(2.75)


def test_floors_and_nothing_have_no_arrow(session, client, handle) -> None:
    for chosen in ("floor", None):
        client.select_surface(chosen)
        session.ui_thread.wait()
        assert handle._node is None
    client.select_surface("wall_1")
    session.ui_thread.wait()
    assert handle._node is not None
