from __future__ import annotations

from dataclasses import replace

import pytest

from diorama_app.panels.review import Doubt, Review
from diorama_core.artefacts import Inputs, LabelledBox
from diorama_core.review.questions import questions
from tests.app.small_room import furnished_scene, plain_photo
from tests.review.doubtful_room import doubtful_scene


@pytest.fixture
def panel(session, page, client) -> Review:
    made = page.put(Review)
    session.commit("doubt", doubtful_scene())
    session.ui_thread.wait()
    return made


def test_a_scene_that_nobody_doubts_has_no_card(page, client) -> None:
    Review(page, client).refresh()
    assert "sure" not in page.html


def test_the_card_tells_how_sure_the_scene_is_and_how_few_answers_settle_it(page, panel) -> None:
    doubt = Doubt.of(doubtful_scene().objects, questions(doubtful_scene()))
    assert f"{round(100 * doubt.right)} % sure" in page.html
    assert 1 < doubt.answers < len(questions(doubtful_scene()))


def test_one_question_after_another_is_answered_by_a_click_and_undone(session, client, page, panel) -> None:
    page.act("review")
    first = questions(session.scene)[0]
    assert client.selection == (first.object_id,)
    page.act("answer", f"{first.id}={first.choices[0].value}")
    session.ui_thread.wait()
    second = questions(session.scene)[0]
    assert second.id != first.id
    assert page.shows("answer", f"{second.id}={second.choices[0].value}")
    session.undo(client)
    assert questions(session.scene)[0].id == first.id


def test_later_asks_something_else_first_and_close_keeps_the_answers(session, page, panel) -> None:
    page.act("review")
    first, second, *_ = questions(session.scene)
    page.act("later", first.id)
    assert page.shows("answer", f"{second.id}={second.choices[0].value}")
    page.act("close")
    assert page.shows("review")


def test_pointing_at_an_answer_shows_it_and_changes_nothing(session, page, panel) -> None:
    page.act("review")
    before, name = session.scene, session.viewport.mesh_name("chair_1")
    panel._peek("kind:chair_1", "table")
    assert session.scene is before
    assert session.viewport.mesh_name("chair_1") != name
    panel._peek("", "")
    assert session.scene is before


def test_another_kind_is_answered_in_words(session, page, panel) -> None:
    page.act("review")
    while (asked := panel._question()) is not None and asked.subject != "kind":
        page.act("later", asked.id)
    assert page.field("It is another kind").visible
    page.write("It is another kind", "table")
    session.ui_thread.wait()
    assert session.scene.object(asked.object_id).category == "table"


def test_a_length_that_is_typed_rescales_the_room_and_later_builds(session, client, page, panel) -> None:
    boxes = {"chair_1": (50.0, 100.0, 150.0, 400.0)}
    scene = doubtful_scene()
    seen = tuple(replace(o, box_px=boxes.get(o.id)) for o in scene.objects)
    session.commit("unscaled", replace(scene, objects=seen, scale_sigma=0.3), inputs=Inputs(plain_photo()))
    session.ui_thread.wait()
    page.act("review")
    assert "How high is the chair?" in page.html
    panel._peek("scale:chair_1", "1.0")
    page.write("Another height", "172 cm")
    session.ui_thread.wait()
    assert session.scene.object("chair_1").size_m[2] == pytest.approx(1.72)
    factor = 1.72 / scene.object("chair_1").size_m[2]
    assert session.inputs.camera_height_m == pytest.approx(factor * scene.camera.position[2])
    session.undo(client)
    assert session.inputs.camera_height_m is None


def test_what_the_scene_may_lack_is_asked_and_added_from_the_photo_or_dismissed(
    session, client, page, panel, monkeypatch
) -> None:
    added = []
    monkeypatch.setattr("diorama_app.panels.review.add_from_photo", lambda by, box, label: added.append((box, label)))
    proposals = [
        LabelledBox((10.0, 20.0, 200.0, 220.0), "stool", "stool", 0.9),
        LabelledBox((210.0, 20.0, 300.0, 220.0), "plant", "plant", 0.85),
    ]
    client.proposals = lambda: tuple(proposals)
    client.dismiss = proposals.remove
    session.commit("photo", furnished_scene(), inputs=Inputs(plain_photo()))
    session.ui_thread.wait()
    page.act("review")
    assert "Is something here?" in page.html
    assert "Yes, a stool" in page.html
    page.act("answer", "missing:10,20,200,220=yes")
    assert added == [((10.0, 20.0, 200.0, 220.0), "stool")]
    page.act("answer", "missing:210,20,300,220=no")
    assert [b.label for b in proposals] == ["stool"]
