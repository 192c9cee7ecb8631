"""Names for a box and boxes for a photo come in the background, once."""

from __future__ import annotations

import queue
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import torch

from diorama_app.reconstruction import suggestions as suggesting
from diorama_app.reconstruction.suggestions import COUNT, Suggestions, drop_marked
from diorama_core.artefacts import Box, LabelledBox, Photo
from diorama_core.io import assets
from diorama_core.models.boxes import Detections
from diorama_core.models.store import ModelStore
from tests.app.small_room import plain_photo
from tests.models import tiny_networks
from tests.models.tiny_networks import install
from tests.pipeline.test_presets import BOX as CHAIR
from tests.pipeline.test_presets import HEIGHT, WIDTH, _Yolox

PHOTO = Photo(np.full((60, 80, 3), 120, np.uint8), "room.png", (80, 60))
BOX = (10.0, 10.0, 50.0, 50.0)
shipped = pytest.mark.skipif(not assets.has_own_recogniser(), reason="no weights are shipped")


def clicked(suggestions: Suggestions, x: float, y: float) -> LabelledBox | None:
    """What is meant by a click."""
    told = queue.Queue[LabelledBox | None]()
    suggestions.suggest(x, y, (), told.put)
    return told.get(timeout=60)


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
    suggestions = Suggestions(plain_photo(), lambda: None)
    found = clicked(suggestions, 320.0, 300.0)
    assert found is not None
    assert found.box[0] <= 320 <= found.box[2]
    assert found.box[1] <= 300 <= found.box[3]
    assert found.label == suggestions.names([found.box], 0)[0]


@shipped
def test_the_outline_of_the_last_box_arrives_and_stays() -> None:
    ready, photo = threading.Event(), plain_photo()
    suggestions = Suggestions(photo, ready.set)
    box = (200.0, 150.0, 420.0, 400.0)
    assert suggestions.outline(box) is None
    assert ready.wait(60)
    mask = suggestions.outline(box)
    assert mask is not None
    assert mask.shape == (photo.height, photo.width)
    inside = mask[150:400, 200:420]
    assert inside.any()
    assert inside.sum() == mask.sum(), "nothing outside the box"
    assert suggestions.outline(box) is mask
    ready.clear()
    assert suggestions.outline(BOX) is None
    assert ready.wait(60)
    assert suggestions.outline(BOX) is not None
    assert suggestions.outline(box) is None, "only the last one is held"


@shipped
def test_outlines_that_nobody_waits_for_hold_up_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    traced, photo = list[Box](), plain_photo(320, 240)

    def segment_box(self: object, rgb: np.ndarray, box: Box) -> tuple[np.ndarray, float]:
        if rgb is photo.rgb:  # an earlier test's may still be worked out
            traced.append(box)
        return np.ones(rgb.shape[:2], dtype=bool), 1.0

    monkeypatch.setattr("diorama_core.perception.masks.EmbeddedMasks.segment_box", segment_box)
    begin, ready = threading.Event(), threading.Event()
    worker = ThreadPoolExecutor(1)
    monkeypatch.setattr(suggesting, "_ASKED", worker)
    monkeypatch.setattr(suggesting, "_AHEAD", worker)
    suggestions = Suggestions(photo, ready.set)
    worker.submit(begin.wait, 30)
    boxes = [(10.0, 10.0, 50.0 + k, 60.0) for k in range(5)]
    assert [suggestions.outline(box) for box in boxes] == [None] * 5
    begin.set()
    worker.submit(lambda: None).result(30)
    assert traced == boxes[-1:]


@shipped
def test_what_waits_for_its_turn_is_left_out_when_nobody_looks_any_more(monkeypatch: pytest.MonkeyPatch) -> None:
    worker, begin = ThreadPoolExecutor(1), threading.Event()
    monkeypatch.setattr(suggesting, "_ASKED", worker)
    monkeypatch.setattr(suggesting, "_AHEAD", worker)
    here = [True]
    told = queue.Queue[LabelledBox | None]()
    suggestions = Suggestions(plain_photo(), lambda: None, lambda: here[0])
    worker.submit(begin.wait, 30)
    suggestions.boxes()
    suggestions.suggest(20.0, 20.0, (), told.put)
    here[0] = False
    begin.set()
    worker.submit(lambda: None).result(30)
    assert told.empty()
    assert suggestions.boxes() == ()


@shipped
def test_what_is_drawn_is_told_with_its_likeliest_name() -> None:
    told = queue.Queue[LabelledBox]()
    suggestions = Suggestions(PHOTO, lambda: None)
    suggestions.name(BOX, (), told.put)
    found = told.get(timeout=60)
    assert found.box == BOX
    assert found.label == suggestions.names([BOX], 0)[0]


@shipped
def test_a_network_for_everyday_objects_proposes_names_and_is_clicked(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    store = ModelStore(tmp_path / "models")
    example = (torch.zeros(1, 3, 416, 416),)
    graph = tiny_networks.export(_Yolox(), example, tmp_path / "y.onnx", ["images"], ["output"])
    install(store, "yolox-nano", [graph])
    monkeypatch.setenv("DIORAMA_MODELS", str(store.folder))
    photo = plain_photo(WIDTH, HEIGHT)
    ready = threading.Event()
    suggestions = Suggestions(photo, ready.set)
    suggestions.boxes()
    assert ready.wait(60)
    chair = suggestions.boxes()[0]
    assert chair.label == "chair"
    np.testing.assert_allclose(chair.box, CHAIR, atol=1.0)
    meant = clicked(suggestions, (CHAIR[0] + CHAIR[2]) / 2, (CHAIR[1] + CHAIR[3]) / 2)
    assert meant is not None
    np.testing.assert_allclose(meant.box, CHAIR, atol=1.0)
    assert "chair" in suggestions.names([meant.box], 0)[0], "its word counts beside what the thing looks like"


@shipped
def test_a_damaged_network_does_not_stop_marking(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    store = ModelStore(tmp_path / "models")
    (tmp_path / "y.onnx").write_bytes(b"no graph")
    install(store, "yolox-nano", [tmp_path / "y.onnx"])
    monkeypatch.setenv("DIORAMA_MODELS", str(store.folder))
    assert clicked(Suggestions(plain_photo(), lambda: None), 320.0, 300.0) is not None
    assert "marking goes on without the network" in caplog.text


def test_in_a_marked_box_something_smaller_is_meant() -> None:
    sofa, pillow, other = (100.0, 100.0, 400.0, 300.0), (150.0, 150.0, 220.0, 220.0), (90.0, 90.0, 600.0, 400.0)
    found = Detections(np.array([sofa, pillow, other]), np.ones(3), np.zeros(3, dtype=int))
    assert drop_marked(found, 180.0, 180.0, ()) is found
    assert drop_marked(found, 500.0, 350.0, (sofa,)) is found, "beside what is marked"
    assert drop_marked(found, 180.0, 180.0, (sofa,)).boxes.tolist() == [list(pillow)]
    assert not len(drop_marked(found, 180.0, 180.0, (sofa, pillow)))


def test_without_weights_nothing_is_suggested(monkeypatch: pytest.MonkeyPatch, tmp_path) -> None:
    monkeypatch.setattr(assets, "FOLDER", tmp_path)
    suggestions = Suggestions(PHOTO, lambda: None)
    assert suggestions.names([BOX], 0) == ()
    assert suggestions.boxes() == ()
    assert suggestions.outline(BOX) is None
    assert clicked(suggestions, 20.0, 20.0) is None


@shipped
def test_a_click_waits_for_no_photo_that_is_looked_at_ahead(monkeypatch: pytest.MonkeyPatch) -> None:
    ahead, begin = ThreadPoolExecutor(1), threading.Event()
    monkeypatch.setattr(suggesting, "_AHEAD", ahead)
    suggestions = Suggestions(plain_photo(), lambda: None)
    ahead.submit(begin.wait, 60)
    suggestions.boxes()
    clicked(suggestions, 20.0, 20.0)
    assert not begin.is_set()
    begin.set()
    ahead.shutdown()
