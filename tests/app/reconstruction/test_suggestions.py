"""Names for a box and boxes for a photo come in the background, once."""

from __future__ import annotations

import queue
import threading

import numpy as np
import pytest

from diorama_app.reconstruction.suggestions import COUNT, Suggestions
from diorama_core.artefacts import LabelledBox, Photo
from diorama_core.models import own_weights
from tests.app.small_room import plain_photo

PHOTO = Photo(np.full((60, 80, 3), 120, np.uint8), "room.png", (80, 60))
BOX = (10.0, 10.0, 50.0, 50.0)
shipped = pytest.mark.skipif(not own_weights.has_own_recogniser(), reason="no weights are shipped")


@shipped
def test_names_arrive_and_stay() -> None:
    ready = threading.Event()
    suggestions = Suggestions(PHOTO, ready.set)
    suggestions.names([BOX], 0)
    assert ready.wait(60)
    names = suggestions.names([BOX], 0)
    assert len(set(names)) == COUNT
    ready.clear()
    assert suggestions.names([BOX], 0) == names
    assert not ready.is_set()


@shipped
def test_boxes_of_a_photo_arrive_and_lie_in_it() -> None:
    ready, photo = threading.Event(), plain_photo()
    suggestions = Suggestions(photo, ready.set)
    suggestions.boxes()
    assert ready.wait(60)
    for found in suggestions.boxes():
        x1, y1, x2, y2 = found.box
        assert 0 <= x1 < x2 <= photo.width
        assert 0 <= y1 < y2 <= photo.height


@shipped
def test_a_click_tells_a_box_around_it_with_its_likeliest_name() -> None:
    told: queue.Queue[LabelledBox | None] = queue.Queue()
    photo = plain_photo()
    suggestions = Suggestions(photo, lambda: None)
    suggestions.at(320.0, 300.0, (), told.put)
    found = told.get(timeout=60)
    assert found is not None
    assert found.box[0] <= 320 <= found.box[2]
    assert found.box[1] <= 300 <= found.box[3]
    assert found.label == suggestions.names([found.box], 0)[0]


def test_without_weights_nothing_is_suggested(monkeypatch: pytest.MonkeyPatch, tmp_path) -> None:
    monkeypatch.setattr(own_weights, "FOLDER", tmp_path)
    suggestions = Suggestions(PHOTO, lambda: None)
    assert suggestions.names([BOX], 0) == ()
    assert suggestions.boxes() == ()
    told: queue.Queue[LabelledBox | None] = queue.Queue()
    suggestions.at(20.0, 20.0, (), told.put)
    assert told.get(timeout=20) is None
