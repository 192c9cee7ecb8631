from __future__ import annotations

import pytest

from diorama_app.commands import review
from diorama_core.errors import EditRefused
from tests.review.doubtful_room import doubtful_scene


def test_an_answer_is_one_step_and_what_it_places_stays_where_the_person_wants_it(session, client) -> None:
    session.commit("doubt", doubtful_scene())
    review.answer(session, "front:chair_1", "left", by=client)
    assert session.scene.object("chair_1").by_hand
    review.answer(session, "kind:chair_2", "chair", by=client)
    assert not session.scene.object("chair_2").by_hand
    assert session.document.next_undo().label.startswith("name chair")
    session.undo(client)
    session.undo(client)
    assert session.scene == doubtful_scene()


def test_an_answer_about_what_is_gone_is_refused(session, client) -> None:
    with pytest.raises(EditRefused, match="ask for the questions again"):
        review.answer(session, "kind:gone", "chair", by=client)
