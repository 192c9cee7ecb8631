from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_app.viewport.decorations import (
    COLLIDING_COLOUR,
    LOCKED_COLOUR,
    SELECTED_COLOUR,
    UNSURE,
    Decorations,
    is_unsure,
    remove_quietly,
)
from diorama_core.scene import edits
from tests.app.people import LocalClient
from tests.app.small_room import furnished_scene

SCENE = furnished_scene()


@pytest.fixture
def marks(server):
    for item in SCENE.objects:
        server.scene.add_frame(f"/objects/{item.id}", show_axes=False)
    yield Decorations(LocalClient(server, 0))
    server.scene.reset()


def show(marks, scene=SCENE, selection=(), others=(), badges=None, names=False, unsure=False) -> None:
    marks.show(scene, lambda i: f"/objects/{i}", selection, others, badges or {}, names=names, unsure=unsure)


def drawn(server) -> dict:
    return {n.removeprefix("/objects/"): h for n, h in server.scene._handle_from_node_name.items() if "/mark/" in n}


def colour(server, object_id: str) -> tuple:
    return tuple(np.unique(drawn(server)[f"{object_id}/mark/outer"].colors.reshape(-1, 3), axis=0)[0].tolist())


def tag(server, object_id: str) -> str:
    return drawn(server)[f"{object_id}/mark/tag"].text


def test_what_is_selected_is_outlined_and_named_boldest_last(server, marks) -> None:
    show(marks, selection=("chair_1", "lamp_1"))
    assert {n.split("/")[0] for n in drawn(server)} == {"chair_1", "lamp_1"}
    assert colour(server, "lamp_1") == SELECTED_COLOUR
    assert tag(server, "lamp_1") == "lamp"
    assert drawn(server)["lamp_1/mark/outer"].thickness > drawn(server)["chair_1/mark/outer"].thickness
    points = drawn(server)["lamp_1/mark/outer"].points.reshape(-1, 3)
    np.testing.assert_allclose(np.ptp(points, axis=0), SCENE.object("lamp_1").size_m + 0.024, atol=1e-5)
    show(marks)
    assert drawn(server) == {}


def test_locked_hidden_and_colliding_objects_look_so(server, marks) -> None:
    scene = edits.set_locked(edits.set_hidden(SCENE, "lamp_1", True), "chair_1", True)
    show(marks, scene, selection=("chair_1", "lamp_1"))
    assert colour(server, "chair_1") == LOCKED_COLOUR
    assert tag(server, "chair_1").endswith("(locked)")
    assert not any(n.startswith("lamp_1") for n in drawn(server))
    assert marks.collide(["chair_1", "table_1"])
    assert not marks.collide(["table_1", "chair_1"])
    show(marks, scene, selection=("chair_1",))
    assert colour(server, "chair_1") == colour(server, "table_1") == COLLIDING_COLOUR
    assert "table_1/mark/tag" not in drawn(server)


def test_others_selections_carry_their_name_and_colour_under_ones_own(server, marks) -> None:
    others = [("Guest 2", (1, 2, 3), ("lamp_1", "chair_1"))]
    show(marks, selection=("chair_1",), others=others)
    assert colour(server, "lamp_1") == (1, 2, 3)
    assert tag(server, "lamp_1") == "Guest 2"
    assert colour(server, "chair_1") == SELECTED_COLOUR


def test_names_warnings_and_doubt(server, marks) -> None:
    doubtful = replace(SCENE.object("chair_2"), box_px=(0.0, 0.0, 10.0, 10.0), confidence=UNSURE - 0.01)
    scene = replace(SCENE, objects=tuple(doubtful if o.id == "chair_2" else o for o in SCENE.objects))
    show(marks, scene, badges={"lamp_1": ("floats",)}, unsure=True)
    assert {n.split("/")[0] for n in drawn(server)} == {"lamp_1", "chair_2"}
    assert tag(server, "lamp_1") == "⚠"
    assert tag(server, "chair_2") == "?"
    show(marks, scene, badges={"lamp_1": ("floats",)}, names=True)
    assert tag(server, "lamp_1") == "lamp ⚠ floats"
    assert tag(server, "table_1") == "dining table"


def test_unchanged_marks_are_not_drawn_again(server, marks) -> None:
    show(marks, selection=("chair_1",))
    before = drawn(server)
    show(marks, selection=("chair_1",))
    assert all(drawn(server)[n] is h for n, h in before.items())
    wider = edits.move(SCENE, "chair_1", replace(SCENE.object("chair_1").pose, scale=np.array([2.0, 1, 1])))
    show(marks, wider, selection=("chair_1",))
    assert drawn(server)["chair_1/mark/outer"] is not before["chair_1/mark/outer"]


def test_only_objects_of_the_photo_can_be_unsure() -> None:
    item = SCENE.object("chair_1")
    assert not is_unsure(replace(item, confidence=0.0))
    assert is_unsure(replace(item, confidence=0.0, box_px=(0.0, 0.0, 1.0, 1.0)))
    assert not is_unsure(replace(item, confidence=UNSURE, box_px=(0.0, 0.0, 1.0, 1.0)))


def test_a_node_that_went_with_its_parent_is_removed_quietly(server) -> None:
    frame = server.scene.add_frame("/gone")
    child = server.scene.add_frame("/gone/child")
    frame.remove()
    remove_quietly(child)
    assert "/gone/child" not in server.scene._handle_from_node_name
