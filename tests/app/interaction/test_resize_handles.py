from __future__ import annotations

import asyncio

import numpy as np
import pytest

from diorama_app.commands import edit as editing
from diorama_app.interaction.resize_handles import MARGIN_M, NODE, SizeHandles
from diorama_app.session.client import Client
from diorama_app.session.session import EditorSession
from diorama_core.editing.stretching import HANDLES, handle_place
from diorama_core.scene.types import Scene
from tests.app import pointer

HANDLE = {h.name: h for h in HANDLES}


class Told:
    """What the handles say while they are pulled."""

    def __init__(self) -> None:
        self.previews: list[Scene] = []
        self.done = 0

    def show(self, start: Scene, now: Scene) -> None:
        self.previews.append(now)

    def end(self) -> None:
        self.done += 1


@pytest.fixture
def told() -> Told:
    return Told()


@pytest.fixture
def handles(session: EditorSession, client: Client, told: Told) -> SizeHandles:
    client.select(["chair_1"])
    client.change_preferences(snap=False)
    made = SizeHandles(client, told.show, told.end)
    made.show(session.scene.object("chair_1"))
    return made


def nodes(session: EditorSession) -> dict:
    return {n: h for n, h in session.server.scene._handle_from_node_name.items() if n.startswith(f"{NODE}/")}


def pull(session: EditorSession, name: str, by_m: float, phases=("start", "update", "end"), alt: bool = False) -> None:
    """Pull a handle along its axis."""
    item, handle = session.scene.object("chair_1"), HANDLE[name]
    grabbed = item.pose.position + item.pose.R_world_object @ handle_place(item, handle, MARGIN_M)
    outward = item.pose.R_world_object @ np.array(handle.along)
    for phase in phases:
        hand = grabbed if phase == "start" else grabbed + by_m * outward
        send(session, nodes(session)[f"{NODE}/{name}"], phase, grabbed, hand, "alt" if alt else None)


def send(session: EditorSession, node, phase: str, grabbed, hand, modifier=None) -> None:
    visitor = session.clients[0].viser_client
    asyncio.run(node._impl.drag_cb[0].callback(pointer.dragged(visitor, node, phase, grabbed, hand, modifier=modifier)))
    assert session.ui_thread.wait(60.0)


def test_every_face_has_a_handle_in_its_middle(session, handles) -> None:
    item = session.scene.object("chair_1")
    assert set(nodes(session)) == {f"{NODE}/{h.name}" for h in HANDLES}
    for handle in HANDLES:
        place = item.pose.position + item.pose.R_world_object @ handle_place(item, handle, MARGIN_M)
        np.testing.assert_allclose(nodes(session)[f"{NODE}/{handle.name}"].position, place)
    handles.show(None)
    assert nodes(session) == {}


def test_handles_follow_to_another_object(session, handles) -> None:
    table = session.scene.object("table_1")
    handles.show(table)
    faces = [f"{NODE}/{name}" for name in ("front", "back", "left", "right")]
    middle = np.mean([nodes(session)[f].position for f in faces], axis=0)
    np.testing.assert_allclose(middle, table.pose.position, atol=1e-6)


def test_pulling_a_face_makes_it_longer_in_one_step(session, client, handles, told) -> None:
    before, steps = session.scene.object("chair_1"), len(session.document.history.entries)
    pull(session, "front", 0.2)
    after = session.scene.object("chair_1")
    # The eye sees the pull from where it is, so that the hand's ray passes the axis a little off.
    assert after.size_m[0] - before.size_m[0] == pytest.approx(0.2, abs=0.02)
    assert after.size_m[1:] == pytest.approx(before.size_m[1:])
    back = before.pose.R_world_object @ np.array([-before.size_m[0] / 2, 0, 0]) + before.pose.position
    still = after.pose.R_world_object @ np.array([-after.size_m[0] / 2, 0, 0]) + after.pose.position
    np.testing.assert_allclose(still, back, atol=1e-9)
    assert len(session.document.history.entries) == steps + 1
    assert told.done == 1
    assert told.previews[0].object("chair_1").size_m[0] == pytest.approx(after.size_m[0])


def test_the_corner_keeps_the_proportions(session, handles) -> None:
    before = session.scene.object("chair_1").size_m
    pull(session, "corner", 0.1)
    ratio = session.scene.object("chair_1").size_m / before
    assert ratio == pytest.approx(np.full(3, ratio[0]))
    assert ratio[0] > 1.05


def test_snapping_gives_round_sizes_and_alt_inverts_it(session, client, handles) -> None:
    client.change_preferences(snap=True)
    pull(session, "left", 0.113)
    width = session.scene.object("chair_1").size_m[1] / 0.05
    assert width == pytest.approx(round(width))
    pull(session, "left", 0.113, alt=True)
    width = session.scene.object("chair_1").size_m[1] / 0.05
    assert abs(width - round(width)) > 0.02


def test_letting_go_by_esc_changes_nothing(session, handles) -> None:
    start = session.scene
    assert not handles.cancel()
    pull(session, "top", 0.3, phases=("start", "update"))
    assert handles.pulling
    handles.show(None)
    assert nodes(session), "a handle in a hand stays"
    assert handles.cancel()
    pull(session, "top", 0.3, phases=("end",))
    assert session.scene is start


def test_a_pull_that_comes_back_is_no_step(session, handles) -> None:
    steps = len(session.document.history.entries)
    pull(session, "top", 0.0, phases=("start",))
    pull(session, "top", 0.0, phases=("update", "end"))
    assert len(session.document.history.entries) == steps


def test_an_object_deleted_meanwhile_stays_deleted(session, client, handles) -> None:
    pull(session, "top", 0.3, phases=("start", "update"))
    node = nodes(session)[f"{NODE}/top"]
    editing.delete_selected(client)
    send(session, node, "end", (0.0, 0, 0), (0.0, 0, 0.1))
    assert not session.scene.has_object("chair_1")
    assert not handles.pulling
