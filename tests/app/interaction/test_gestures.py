"""The mouse in the 3D view, on a real server: every gesture arrives as viser's event and ends as an edit."""

from __future__ import annotations

import asyncio
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_app.commands import edit as editing
from diorama_app.interaction.gestures import NODE, Gestures, objects_in
from diorama_app.session.client import Client, Measuring, Placing
from diorama_app.session.session import EditorSession
from diorama_core.editing.collisions import Collisions
from diorama_core.geometry.rotations import quaternion_wxyz
from diorama_core.scene.types import Pose, Scene, yaw_rotation
from tests.app import pointer
from tests.app.people import node, settle
from tests.app.small_room import furnished_scene

SCENE = furnished_scene()
CAMERA = SCENE.camera
VIEW = (CAMERA.T_world_camera[:3, :3], CAMERA.position, CAMERA.intrinsics.vertical_fov_rad, 640 / 480)
share = st.floats(0, 1)


@pytest.fixture
def gestures(session: EditorSession, client: Client) -> Gestures:
    made = Gestures(client, Collisions(session.library))
    client.panels = [made]
    # As a person works who wants neither grid nor bumps: what the hand says is what happens.
    client.change_preferences(snap=False, slide=False)
    return made


def pick(gestures: Gestures, object_id: str, modifier: pointer.Modifier | None = None, at=pointer.MIDDLE) -> None:
    visitor = gestures._client.viser_client
    gestures.pick(object_id, pointer.clicked(visitor, object_id, at=at, modifier=modifier))
    settle(gestures._session)


def drag(session: EditorSession, gestures: Gestures, object_id: str, by: tuple, *, phases=("update", "end"), alt=False):
    """Take an object at its middle and carry it by some metres, as the eye sees it."""
    grabbed = session.scene.object(object_id).pose.position
    for phase in ("start", *phases):
        hand = grabbed if phase == "start" else grabbed + np.array(by)
        send(session, gestures, object_id, phase, grabbed, hand, "alt" if alt else None)


def send(session: EditorSession, gestures: Gestures, object_id: str, phase, grabbed, hand, modifier=None) -> None:
    """One event of a drag."""
    target = node(session.server, session.viewport.node_name(object_id))
    event = pointer.dragged(gestures._client.viser_client, target, phase, grabbed, hand, modifier=modifier)
    gestures.drag(object_id, event)
    settle(session)


def shown_at(session: EditorSession, object_id: str) -> np.ndarray:
    """Where the page draws an object."""
    return np.array(node(session.server, session.viewport.node_name(object_id)).position)


def gizmo(session: EditorSession):
    return node(session.server, NODE)


def turn(session: EditorSession, gestures: Gestures, phase: str, pose: Pose) -> None:
    """Move the gizmo as the browser does."""
    handle = gizmo(session)
    target = SimpleNamespace(wxyz=quaternion_wxyz(pose.R_world_object), position=pose.position)
    for callback in list(handle._impl_aux.update_cb):
        asyncio.run(callback(SimpleNamespace(target=target, phase=phase, client_id=0)))
    settle(session)


# -- pointing ---------------------------------------------------------------------------------------------------


def test_a_click_selects_and_a_modified_one_adds_or_takes_away(session, client, gestures) -> None:
    pick(gestures, "chair_1")
    assert client.selection == ("chair_1",)
    pick(gestures, "lamp_1", "shift")
    assert client.selection == ("chair_1", "lamp_1")
    pick(gestures, "chair_1", "cmd/ctrl")
    assert client.selection == ("lamp_1",)
    pick(gestures, "chair_2")
    assert client.selection == ("chair_2",)


def test_a_click_beside_selects_nothing_but_the_echo_of_an_objects_own_click_does_not(
    session, client, gestures
) -> None:
    pick(gestures, "chair_1", at=(0.4, 0.6))
    gestures._click(np.zeros(3), np.array([0.0, 1.0, 0.0]), on_object=True)
    assert client.selection == ("chair_1",)
    gestures._click(np.zeros(3), np.array([0.0, 1.0, 0.0]), on_object=False)
    assert client.selection == ()


def test_while_a_place_is_asked_for_a_click_puts_the_shape_there(session, client, gestures) -> None:
    before = len(session.scene.objects)
    client.doing = Placing("chair_c")
    pick(gestures, "table_1")
    assert client.selection == ()
    eye = np.array([-1.2, 0.5, 2.0])
    gestures._click(eye, np.array([0.0, 0.0, -1.0]), on_object=False)
    assert len(session.scene.objects) == before + 1
    new = session.scene.objects[-1]
    assert new.shape_id == "chair_c"
    np.testing.assert_allclose(new.pose.position[:2], eye[:2], atol=0.05)
    assert new.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    assert client.doing is None


def test_while_measuring_clicks_are_ends_of_the_tape(session, client, gestures) -> None:
    client.doing = Measuring()
    gestures._click(np.array([-1.0, 0.5, 2.0]), np.array([0.0, 0.0, -1.0]), on_object=False)
    gestures._click(np.array([-1.0, 0.9, 2.0]), np.array([0.0, 0.0, -1.0]), on_object=False)
    assert isinstance(client.doing, Measuring)
    a, b = np.array(client.doing.points)
    np.testing.assert_allclose(b - a, [0.0, 0.4, 0.0], atol=1e-6)


def test_a_frame_adds_what_it_takes_in(session, client, gestures) -> None:
    camera, eyes = session.scene.camera, client.viser_client.camera
    eyes.wxyz, eyes.position = quaternion_wxyz(camera.T_world_camera[:3, :3]), camera.position
    client.select(["picture_1"])
    gestures._frame((0.0, 0.0), (1.0, 1.0))
    everything = set(client.selection)
    client.select(["picture_1"])
    gestures._frame((0.0, 0.0), (0.001, 0.001))
    assert client.selection == ("picture_1",)
    assert everything > {"picture_1"}


def test_while_boxes_are_drawn_the_view_means_nothing(session, client, gestures) -> None:
    client.select(["chair_1"])
    client.view.canvas.open(session.photo.rgb, lambda event: None)
    gestures._frame((0.0, 0.0), (1.0, 1.0))
    gestures._click(np.zeros(3), np.array([0.0, 1.0, 0.0]), on_object=False)
    drag(session, gestures, "chair_2", (0.3, 0.0, 0.0))
    assert client.selection == ("chair_1",)
    assert session.scene.object("chair_2").pose.position[0] == 1.2


# -- dragging ---------------------------------------------------------------------------------------------------


def test_a_drag_is_seen_while_it_lasts_and_one_step_when_it_ends(session, client, gestures) -> None:
    start, steps = session.scene, len(session.document.history.entries)
    drag(session, gestures, "chair_1", (0.2, -0.1, 0.0), phases=("update",))
    assert session.scene is start
    assert client.selection == ("chair_1",)
    assert gizmo(session) is None
    seen = shown_at(session, "chair_1")
    assert np.linalg.norm(seen - start.object("chair_1").pose.position) > 0.1
    grabbed = start.object("chair_1").pose.position
    send(session, gestures, "chair_1", "end", grabbed, grabbed)
    after = session.scene.object("chair_1")
    np.testing.assert_allclose(after.pose.position, seen, atol=1e-6)
    assert after.corners_world[:, 2].min() == pytest.approx(0.0, abs=1e-6)
    assert len(session.document.history.entries) == steps + 1
    assert session.document.history.current.label == "move chair"
    session.undo(client)
    assert session.scene == start


def test_what_stands_on_it_goes_along(session, client, gestures) -> None:
    before = {i: session.scene.object(i).pose.position for i in ("table_1", "lamp_1")}
    drag(session, gestures, "table_1", (-0.3, 0.1, 0.0))
    moved = {i: session.scene.object(i).pose.position - p for i, p in before.items()}
    assert np.linalg.norm(moved["table_1"]) > 0.1
    np.testing.assert_allclose(moved["lamp_1"], moved["table_1"], atol=1e-9)


def test_selected_objects_go_along_with_the_one_dragged(session, client, gestures) -> None:
    client.select(["chair_2", "chair_1"])
    before = {i: session.scene.object(i).pose.position for i in ("chair_1", "chair_2")}
    drag(session, gestures, "chair_1", (0.1, 0.1, 0.0))
    assert client.selection == ("chair_2", "chair_1")
    moved = [session.scene.object(i).pose.position - p for i, p in before.items()]
    np.testing.assert_allclose(moved[0], moved[1], atol=1e-9)
    assert np.linalg.norm(moved[0]) > 0.05


def test_an_object_lifted_onto_a_table_stands_on_it(session, client, gestures) -> None:
    drag(session, gestures, "lamp_1", (-1.4, -0.6, 0.0))
    assert session.scene.support_of("lamp_1").parent == "floor"
    table = session.scene.object("table_1").pose.position
    drag(
        session,
        gestures,
        "lamp_1",
        tuple(table + np.array([0.0, 0.0, 0.595]) - session.scene.object("lamp_1").pose.position),
    )
    assert session.scene.support_of("lamp_1").parent == "table_1"


def test_a_drag_that_comes_back_is_no_step(session, client, gestures) -> None:
    steps = len(session.document.history.entries)
    drag(session, gestures, "chair_1", (0.0, 0.0, 0.0), phases=("end",))
    assert len(session.document.history.entries) == steps
    assert gizmo(session) is not None


def test_snapping_keeps_to_the_grid_and_alt_inverts_it(session, client, gestures) -> None:
    client.change_preferences(snap=True)
    drag(session, gestures, "chair_1", (0.113, 0.037, 0.0))
    on_grid = session.scene.object("chair_1").pose.position[:2] / 0.05
    np.testing.assert_allclose(on_grid, on_grid.round(), atol=1e-6)
    drag(session, gestures, "chair_1", (0.113, 0.037, 0.0), alt=True)
    off_grid = session.scene.object("chair_1").pose.position[:2] / 0.05
    assert np.abs(off_grid - off_grid.round()).max() > 0.05


def test_what_collides_is_marked_until_the_drag_ends(session, client, gestures) -> None:
    to_the_table = session.scene.object("table_1").pose.position - session.scene.object("chair_1").pose.position
    drag(session, gestures, "chair_1", (*to_the_table[:2], 0.0), phases=("update",))
    assert client.marks._colliding >= {"chair_1", "table_1"}
    assert gestures.cancel()
    assert client.marks._colliding == frozenset()


def test_esc_puts_everything_back(session, client, gestures) -> None:
    start = session.scene
    drag(session, gestures, "chair_1", (0.5, 0.0, 0.0), phases=("update",))
    assert gestures.cancel()
    np.testing.assert_allclose(shown_at(session, "chair_1"), start.object("chair_1").pose.position)
    send(session, gestures, "chair_1", "end", (0, 0, 0), (0, 0, 0))
    assert session.scene is start
    assert not gestures.cancel()


def test_a_locked_object_is_not_dragged_and_says_why(session, client, gestures) -> None:
    editing.set_locked(client, ["chair_1"], True)
    drag(session, gestures, "chair_1", (0.5, 0.0, 0.0))
    assert session.scene.object("chair_1").pose.position[0] == -0.9
    assert any("locked" in told for told in client.viser_client.told)


def test_a_drag_ends_on_the_scene_as_it_is_by_then(session, client, gestures) -> None:
    drag(session, gestures, "chair_1", (0.2, 0.0, 0.0), phases=("update",))
    editing.rename(client, "lamp_1", "a lamp renamed meanwhile")
    grabbed = session.scene.object("chair_1").pose.position
    send(session, gestures, "chair_1", "end", grabbed, grabbed)
    assert session.scene.object("lamp_1").label == "a lamp renamed meanwhile"
    assert session.scene.object("chair_1").pose.position[0] != -0.9


# -- the gizmo --------------------------------------------------------------------------------------------------


def test_the_gizmo_is_where_the_selected_object_is_if_it_can_be_moved(session, client, gestures) -> None:
    assert gizmo(session) is None
    client.select(["table_1"])
    np.testing.assert_allclose(gizmo(session).position, session.scene.object("table_1").pose.position)
    client.select(["chair_1"])
    np.testing.assert_allclose(gizmo(session).position, session.scene.object("chair_1").pose.position)
    editing.set_locked(client, ["chair_1"], True)
    assert gizmo(session) is None
    client.select(["chair_2"])
    client.change_preferences(gizmo="size")
    assert gizmo(session) is None
    assert node(session.server, "/size/front") is not None
    client.change_preferences(gizmo="free")
    assert gizmo(session) is not None
    assert node(session.server, "/size/front") is None


def test_the_gizmo_moves_and_turns_in_one_step(session, client, gestures) -> None:
    client.select(["chair_1"])
    start, steps = session.scene.object("chair_1").pose, len(session.document.history.entries)
    there = Pose(yaw_rotation(1.0), start.position + np.array([0.1, 0.2, 0.0]), start.scale)
    turn(session, gestures, "start", start)
    turn(session, gestures, "update", there)
    np.testing.assert_allclose(shown_at(session, "chair_1"), there.position, atol=1e-9)
    assert session.scene.object("chair_1").pose == start
    turn(session, gestures, "end", there)
    np.testing.assert_allclose(session.scene.object("chair_1").pose.R_world_object, there.R_world_object, atol=1e-9)
    np.testing.assert_allclose(session.scene.object("chair_1").pose.position, there.position)
    assert len(session.document.history.entries) == steps + 1


def test_the_gizmo_snaps_to_steps_of_the_turn(session, client, gestures) -> None:
    client.change_preferences(snap=True)
    client.select(["chair_1"])
    start = session.scene.object("chair_1").pose
    there = Pose(yaw_rotation(start.yaw_rad + np.deg2rad(28.0)), start.position, start.scale)
    turn(session, gestures, "start", start)
    turn(session, gestures, "end", there)
    # Headings are steps of 15 degrees of the world: 50.9 becomes 45.
    assert np.rad2deg(session.scene.object("chair_1").pose.yaw_rad) == pytest.approx(45.0)


def test_a_gizmo_that_comes_back_or_loses_its_object_changes_nothing(session, client, gestures) -> None:
    client.select(["chair_1"])
    start, steps = session.scene.object("chair_1").pose, len(session.document.history.entries)
    turn(session, gestures, "start", start)
    turn(session, gestures, "end", start)
    assert len(session.document.history.entries) == steps
    handle = gizmo(session)
    turn(session, gestures, "start", start)
    editing.delete_selected(client)
    target = SimpleNamespace(wxyz=quaternion_wxyz(start.R_world_object), position=start.position + 1.0)
    for callback in list(handle._impl_aux.update_cb):
        asyncio.run(callback(SimpleNamespace(target=target, phase="end", client_id=0)))
    settle(session)
    assert not session.scene.has_object("chair_1")
    assert len(session.document.history.entries) == steps + 1


@given(share, share, share, share)
def test_a_frame_takes_in_what_has_its_middle_inside(x1, y1, x2, y2) -> None:
    low, high = (min(x1, x2), min(y1, y2)), (max(x1, x2), max(y1, y2))
    found = objects_in(SCENE, low, high, *VIEW)
    pixels = {o.id: CAMERA.project(o.pose.position) / [640, 480] for o in SCENE.objects}
    inside = {i for i, p in pixels.items() if (p > np.array(low) + 1e-9).all() and (p < np.array(high) - 1e-9).all()}
    outside = {i for i, p in pixels.items() if (p < np.array(low) - 1e-9).any() or (p > np.array(high) + 1e-9).any()}
    assert inside <= set(found)
    assert not outside & set(found)


def test_hidden_objects_and_those_behind_are_left_out() -> None:
    whole = ((-100.0, -100.0), (100.0, 100.0))
    assert set(objects_in(SCENE, *whole, *VIEW)) == {o.id for o in SCENE.objects}
    hidden = Scene(SCENE.camera, SCENE.architecture, tuple(replace(o, hidden=True) for o in SCENE.objects))
    assert objects_in(hidden, *whole, *VIEW) == ()
    backward = VIEW[0] @ np.diag([-1.0, 1.0, -1.0])
    assert objects_in(SCENE, *whole, backward, *VIEW[1:]) == ()
