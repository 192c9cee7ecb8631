"""Names for a box come in the background, once."""

from __future__ import annotations

import threading

import numpy as np
import pytest

from diorama_app.reconstruction.suggestions import COUNT, Suggestions
from diorama_core.artefacts import Photo
from diorama_core.models import own_weights

PHOTO = Photo(np.full((60, 80, 3), 120, np.uint8), "room.png", (80, 60))
BOX = (10.0, 10.0, 50.0, 50.0)


@pytest.mark.skipif(not own_weights.has_own_recogniser(), reason="no weights are shipped")
def test_names_arrive_and_stay() -> None:
    ready = threading.Event()
    suggestions = Suggestions(ready.set)
    assert suggestions.of(PHOTO, BOX) == ()
    assert ready.wait(60)
    names = suggestions.of(PHOTO, BOX)
    assert len(set(names)) == COUNT
    ready.clear()
    assert suggestions.of(PHOTO, BOX) == names
    assert not ready.is_set()


def test_without_weights_nothing_is_suggested(monkeypatch: pytest.MonkeyPatch, tmp_path) -> None:
    monkeypatch.setattr(own_weights, "FOLDER", tmp_path)
    assert Suggestions(lambda: None).of(PHOTO, BOX) == ()
