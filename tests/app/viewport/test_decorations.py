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
from diorama_core.scene.belief import Belief
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


def outlined(marks) -> dict[str, tuple]:
    return {o.node.removeprefix("/objects/"): (o.colour, o.thickness_px) for o in marks.outlines}


def tag(server, object_id: str) -> str:
    return drawn(server)[f"{object_id}/mark/tag"].text


def test_what_is_selected_is_outlined_boldest_last_and_its_page_is_told_once(server, marks) -> None:
    told = []
    marks.on_outlines = told.append
    show(marks, selection=("chair_1", "lamp_1"))
    assert set(outlined(marks)) == {"chair_1", "lamp_1"}
    assert outlined(marks)["lamp_1"][0] == SELECTED_COLOUR
    assert outlined(marks)["lamp_1"][1] > outlined(marks)["chair_1"][1]
    assert drawn(server) == {}, "names are shown to those who ask"
    show(marks, selection=("chair_1", "lamp_1"))
    assert len(told) == 1
    show(marks, selection=("lamp_1",), names=True)
    assert tag(server, "lamp_1") == "lamp"
    show(marks)
    assert marks.outlines == ()
    assert drawn(server) == {}


def test_locked_hidden_and_colliding_objects_look_so(server, marks) -> None:
    scene = edits.set_locked(edits.set_hidden(SCENE, "lamp_1", True), "chair_1", True)
    show(marks, scene, selection=("chair_1", "lamp_1"), names=True)
    assert outlined(marks) == {"chair_1": (LOCKED_COLOUR, 2.5)}
    assert tag(server, "chair_1").endswith("(locked)")
    assert marks.collide(["chair_1", "table_1"])
    assert not marks.collide(["table_1", "chair_1"])
    show(marks, scene, selection=("chair_1",))
    assert outlined(marks)["chair_1"][0] == outlined(marks)["table_1"][0] == COLLIDING_COLOUR
    assert "table_1/mark/tag" not in drawn(server)


def test_others_selections_carry_their_name_and_colour_under_ones_own(server, marks) -> None:
    others = [("Guest 2", (1, 2, 3), ("lamp_1", "chair_1"))]
    show(marks, selection=("chair_1",), others=others)
    assert outlined(marks)["lamp_1"][0] == (1, 2, 3)
    assert tag(server, "lamp_1") == "Guest 2"
    assert outlined(marks)["chair_1"][0] == SELECTED_COLOUR


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
    show(marks, names=True)
    before = drawn(server)
    assert before
    show(marks, names=True)
    assert all(drawn(server)[n] is h for n, h in before.items())
    wider = edits.move(SCENE, "chair_1", replace(SCENE.object("chair_1").pose, scale=np.array([2.0, 1, 1])))
    taller = edits.move(wider, "chair_1", replace(SCENE.object("chair_1").pose, scale=np.array([1.0, 1, 2])))
    show(marks, taller, names=True)
    assert drawn(server)["chair_1/mark/tag"] is not before["chair_1/mark/tag"]


def test_only_objects_of_the_photo_can_be_unsure() -> None:
    item = SCENE.object("chair_1")
    assert not is_unsure(replace(item, confidence=0.0))
    assert is_unsure(replace(item, confidence=0.0, box_px=(0.0, 0.0, 1.0, 1.0)))
    seen = replace(item, confidence=UNSURE, box_px=(0.0, 0.0, 1.0, 1.0))
    assert not is_unsure(seen)
    assert is_unsure(replace(seen, belief=Belief(kinds=(("chair", 0.4), ("stool", 0.6)))))
    assert not is_unsure(replace(seen, belief=Belief(kinds=(("chair", 0.6), ("stool", 0.4)))))


def test_a_node_that_went_with_its_parent_is_removed_quietly(server) -> None:
    frame = server.scene.add_frame("/gone")
    child = server.scene.add_frame("/gone/child")
    frame.remove()
    remove_quietly(child)
    assert "/gone/child" not in server.scene._handle_from_node_name
