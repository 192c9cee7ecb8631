from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_app.viewport.annotation_canvas import (
    Accepted,
    AnnotationCanvas,
    Clicked,
    Deleted,
    Dismissed,
    Drawn,
    Event,
    Finished,
    Named,
    Pointed,
    Reshaped,
    Selected,
    _event,
)
from diorama_app.web.html import Action
from diorama_core.artefacts import LabelledBox
from tests.app.small_room import plain_photo


@pytest.mark.parametrize(
    ("do", "arg", "event"),
    [
        ("draw", [30, 40, 10, 20], Drawn((10.0, 20.0, 30.0, 40.0))),
        ("change", [2, [10, 20, 9999, 40]], Reshaped(2, (10.0, 20.0, 640.0, 40.0))),
        ("select", None, Selected(None)),
        ("select", 3, Selected(3)),
        ("name", [1, "couch"], Named(1, "couch")),
        ("delete", 0, Deleted(0)),
        ("point", [5, 6, False], Pointed(5.0, 6.0, False)),
        ("click", [5, 6], Clicked(5.0, 6.0)),
        ("accept", [1, "couch"], Accepted(1, "couch")),
        ("dismiss", 2, Dismissed(2)),
        ("done", None, Finished()),
    ],
)
def test_what_a_page_says_is_understood(do: str, arg: object, event: Event) -> None:
    assert _event(Action(do, json.dumps(arg), False), (640, 480)) == event


@given(
    st.sampled_from(["draw", "change", "select", "name", "delete", "point", "click", "accept", "dismiss", "else"]),
    st.text(max_size=40),
)
def test_nonsense_is_no_event_or_a_harmless_one(do: str, arg: str) -> None:
    event = _event(Action(do, arg, False), (640, 480))
    assert event is None or isinstance(
        event, (Drawn, Reshaped, Selected, Named, Deleted, Pointed, Clicked, Accepted, Dismissed)
    )


@pytest.mark.parametrize("corners", [[1, 1, 2, 2], [700, 10, 800, 90], [float("nan")] * 4, [1, 2, 3]])
def test_boxes_that_are_none_are_dropped(corners: list[float]) -> None:
    assert _event(Action("draw", json.dumps(corners), False), (640, 480)) is None


@pytest.fixture
def canvas(server):
    made = AnnotationCanvas(server.gui)
    yield made
    server.gui.reset()


def test_it_reports_only_while_it_is_open(canvas: AnnotationCanvas) -> None:
    heard: list[Event] = []
    canvas._receive(Action("done", "null", False))
    canvas.open(plain_photo().rgb, heard.append)
    canvas._receive(Action("done", "null", False))
    canvas.close()
    canvas._receive(Action("done", "null", False))
    assert heard == [Finished()]


def test_the_page_is_told_boxes_with_escaped_names(canvas: AnnotationCanvas) -> None:
    canvas.show_boxes([LabelledBox((1.0, 2.0, 30.0, 40.0), "chair", "chair")], 0)
    assert canvas._boxes._html.content == "", "nothing while it is closed"
    canvas.open(plain_photo().rgb, lambda event: None, names=["chair"])
    canvas.show_boxes([LabelledBox((1.0, 2.0, 30.0, 40.0), "object", "<b>&quot;")], 0)
    assert "<b>" not in canvas._boxes._html.content
    assert "[1.0,2.0,30.0,40.0]" in canvas._boxes._html.content
    canvas.show_mask(np.ones((480, 640), dtype=bool))
    assert "data:image/png" in canvas._mask._html.content


def test_proposals_and_likely_names_are_told_while_it_is_open(canvas: AnnotationCanvas) -> None:
    chair = LabelledBox((1.0, 2.0, 30.0, 40.0), "chair", "chair")
    canvas.show_proposals([chair])
    assert canvas._proposals._html.content == ""
    canvas.open(plain_photo().rgb, lambda event: None)
    canvas.show_proposals([chair])
    canvas.show_boxes([chair], 0, ["stool", "bench"])
    assert "chair" in canvas._proposals._html.content
    assert "stool" in canvas._boxes._html.content
    canvas.close()
    assert "chair" not in canvas._proposals._html.content
