from __future__ import annotations

from dataclasses import replace

import pytest

pytest.importorskip("fastapi", reason="needs FastAPI (pip install 'diorama[api]')")

from fastapi import Request  # after the check for its library

from diorama_app.http_api.answers import png, respond
from diorama_app.http_api.project_answers import check_answer, object_answer
from diorama_core.api import Reconstruction
from diorama_core.artefacts import Reason
from diorama_core.errors import EditRefused, ProjectError
from diorama_core.scene import edits
from tests.app.small_room import PlainLibrary, furnished_scene

SCENE = furnished_scene()
AGAINST = Reason("chair_1", "front", "wall", -2.0, "nats", "its back is to the table")


def test_doubts_are_what_the_build_was_not_sure_of() -> None:
    chair = replace(SCENE.object("chair_1"), confidence=0.1, box_px=(0.0, 0.0, 9.0, 9.0))
    doubts = object_answer(SCENE, chair, {}, (AGAINST,)).doubts
    assert len(doubts) == 2
    assert "confidence 0.10" in doubts[0]
    assert doubts[1] == "front: its back is to the table"
    assert object_answer(SCENE, replace(chair, by_hand=True), {}, (AGAINST,)).doubts == doubts[:1]


def test_what_is_fine_is_not_complained_of() -> None:
    assert check_answer(SCENE, PlainLibrary()).lines == []
    blocked = edits.move(SCENE, "table_1", SCENE.object("table_1").pose.move((0.0, 0.0, 0.3)))
    lines = check_answer(blocked, PlainLibrary()).lines
    assert any("table_1 floats" in line for line in lines), lines


def test_a_picture_is_of_the_scene_that_is_given() -> None:
    room = Reconstruction(SCENE, PlainLibrary(), {})
    without = replace(room, scene=edits.remove(SCENE, ["table_1", "lamp_1"]))
    assert png(room, "top", (80, 60)) != png(without, "top", (80, 60))


@pytest.mark.parametrize(("error", "status"), [(EditRefused("a\nb"), 422), (ProjectError("damaged"), 500)])
def test_errors_are_one_line(error: Exception, status: int) -> None:
    reply = respond(Request({"type": "http"}), error)
    assert reply.status_code == status
    assert b"\\n" not in reply.body
