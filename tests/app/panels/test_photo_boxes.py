"""What a person clicks on in the photo becomes a box; proposals are accepted or dropped."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import pytest

from diorama_app.panels.photo_boxes import PhotoBoxes, box_list
from diorama_app.reconstruction import suggestions
from diorama_app.reconstruction.build_job import UNASKED
from diorama_app.session.client import Client
from diorama_app.viewport.annotation_canvas import Accepted, Clicked, Dismissed, Drawn, Named, Selected
from diorama_core.artefacts import Box, FurtherPhoto, Inputs, LabelledBox, Photo
from diorama_core.progress import Progress
from tests.app.small_room import plain_photo

CHAIR = LabelledBox((40.0, 250.0, 160.0, 440.0), "chair", "chair")
LAMP = LabelledBox((400.0, 50.0, 460.0, 200.0), "lamp", "lamp", 0.55)


class Known(suggestions.Suggestions):
    """Knows a chair and a lamp at once."""

    def __init__(self, photo: Photo, on_ready: Callable[[], None], is_wanted: Callable[[], bool]) -> None:
        super().__init__(photo, on_ready, is_wanted)
        self._boxes = CHAIR, LAMP

    def sure(self) -> tuple[LabelledBox, ...]:
        return tuple(b for b in self.boxes() if b is CHAIR)

    def names(self, boxes: Sequence[Box], index: int) -> tuple[str, ...]:
        return ("chair", "stool", "bench", "sofa")

    def name(self, box: Box, marked: Sequence[Box], then: Callable[[LabelledBox], None]) -> None:
        then(LabelledBox(box, "stool", "stool"))

    def suggest(self, x: float, y: float, marked: Sequence[Box], then: Callable[[LabelledBox | None], None]) -> None:
        holding = (b for b in (CHAIR, LAMP) if b.box[0] <= x <= b.box[2] and b.box[1] <= y <= b.box[3])
        then(next(holding, None))


@pytest.fixture
def marking(session, client: Client, monkeypatch: pytest.MonkeyPatch) -> PhotoBoxes:
    monkeypatch.setattr("diorama_app.panels.photo_boxes.Suggestions", Known)
    session.document.open(session.scene, Inputs(plain_photo()))
    made = PhotoBoxes(client, lambda: None)
    made.open()
    return made


def labels(session) -> list[str]:
    return [b.label for b in session.inputs.boxes]


def test_a_click_marks_what_is_there_and_selects_it(session, client: Client, marking: PhotoBoxes) -> None:
    marking.handle(Clicked(100.0, 300.0))
    session.ui_thread.wait()
    assert [(b.box, b.label) for b in session.inputs.boxes] == [(CHAIR.box, "chair")]
    assert client.selected_box == 0
    marking.handle(Named(0, "stool"))
    assert labels(session) == ["stool"]
    session.undo(client)
    session.undo(client)
    assert labels(session) == []


def test_a_drawn_box_gets_the_kind_that_is_recognised_and_is_selected(
    session, client: Client, marking: PhotoBoxes
) -> None:
    marking.handle(Drawn((10.0, 20.0, 90.0, 120.0)))
    session.ui_thread.wait()
    assert labels(session) == ["stool"]
    assert client.selected_box == 0
    session.undo(client)
    assert labels(session) == []


def test_a_click_beside_everything_says_so(session, client: Client, marking: PhotoBoxes) -> None:
    said: list[str] = []
    client.toast = lambda message, undo: said.append(message)
    marking.handle(Clicked(600.0, 470.0))
    session.ui_thread.wait()
    assert session.inputs.boxes == ()
    assert said == ["Nothing was recognised there; drag a box around the object."]


def test_a_click_on_a_marked_object_selects_its_box(session, client: Client, marking: PhotoBoxes) -> None:
    marking.handle(Accepted(0, ""))
    marking.handle(Selected(None))
    assert client.selected_box is None
    marking.handle(Clicked(100.0, 300.0))
    session.ui_thread.wait()
    assert labels(session) == ["chair"]
    assert client.selected_box == 0


def test_proposals_are_accepted_under_another_name_or_dropped(session, client: Client, marking: PhotoBoxes) -> None:
    marking.handle(Accepted(1, "floor lamp"))
    assert labels(session) == ["floor lamp"]
    marking.handle(Dismissed(0))
    marking.handle(Accepted(0, ""))
    assert labels(session) == ["floor lamp"], "none is left to accept"


def test_each_photo_is_looked_at_once_whichever_is_shown(
    session, client: Client, marking: PhotoBoxes, monkeypatch: pytest.MonkeyPatch
) -> None:
    looked_at: list[str] = []

    class Counted(Known):
        def __init__(self, photo: Photo, *more: Callable[[], object]) -> None:
            looked_at.append(photo.name)
            super().__init__(photo, *more)

    monkeypatch.setattr("diorama_app.panels.photo_boxes.Suggestions", Counted)
    beside = replace(plain_photo(), name="beside.png")
    session.commit("add", session.scene, further=(FurtherPhoto("beside", Inputs(beside)),))
    assert marking.proposal_count(session.inputs) == 2
    for _ in range(3):  # at every redraw the card asks for the scene's photo, the canvas for the one that is marked
        assert len(marking.proposals()) == 2
        assert marking.proposal_count(session.further_photos[0].inputs) == 2
    assert looked_at == [session.photo.name, "beside.png"]


def test_the_list_escapes_names(session) -> None:
    listed = box_list(Inputs(plain_photo(), boxes=(LabelledBox(CHAIR.box, "object", "<b>"),)), 0)
    assert "<b>" not in listed
    assert "Delete the box of &lt;b&gt;" in listed


def test_all_proposals_are_accepted_as_one_undo_step(session, client: Client, marking: PhotoBoxes) -> None:
    marking.handle(Dismissed(1))
    assert marking.proposal_count(session.inputs) == 1
    marking.accept_all()
    assert labels(session) == ["chair"], "what was dismissed is not accepted"
    assert marking.proposal_count(session.inputs) == 0
    marking.accept_all()
    session.undo(client)
    assert labels(session) == []


def test_only_sure_proposals_are_built_unseen_and_their_names_stay_guesses(session, marking: PhotoBoxes) -> None:
    (box,) = marking.sure(session.inputs)
    assert (box.box, box.label, box.guessed) == (CHAIR.box, "chair", True)
    marking.handle(Dismissed(0))
    assert marking.sure(session.inputs) == ()
    assert session.inputs.boxes == (), "nothing is marked by it"


def test_a_name_stays_a_guess_until_somebody_gives_it(session, client: Client, marking: PhotoBoxes) -> None:
    marking.accept_all()
    assert [b.guessed for b in session.inputs.boxes] == [True, True]
    marking.handle(Named(0, "stool"))
    assert [b.guessed for b in session.inputs.boxes] == [False, True]


def test_who_marks_something_ends_the_build_that_nobody_asked_for(
    session, client: Client, marking: PhotoBoxes, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun = threading.Event()

    def work(progress: Progress) -> None:
        begun.set()
        while True:
            progress.check()
            time.sleep(0.01)

    session.jobs.start("find", UNASKED, work)
    begun.wait()
    marking.handle(Dismissed(1))
    assert session.jobs.status is not None
    marking.handle(Accepted(0, ""))
    assert session.jobs.wait(10.0)
    assert labels(session) == ["chair"]
    session.ui_thread.wait()
    assert session.outcome.in_favour, "the mark tells enough"


def test_the_list_tells_how_to_make_the_first_box(session) -> None:
    assert "lick each piece of furniture" in box_list(Inputs(plain_photo()), None)


def test_accepting_all_merges_doubles_and_tells_what_is_absurd(
    session, client: Client, marking: PhotoBoxes, monkeypatch: pytest.MonkeyPatch
) -> None:
    sofa = LabelledBox((300.0, 380.0, 500.0, 470.0), "sofa", "sofa")
    again = LabelledBox((302.0, 381.0, 498.0, 470.0), "sectional sofa", "sectional sofa")
    giant = LabelledBox((100.0, 20.0, 220.0, 460.0), "chair", "chair")
    monkeypatch.setattr(Known, "boxes", lambda self: (sofa, again, giant))
    said: list[str] = []
    client.toast = lambda message, undo: said.append(message)
    marking.accept_all()
    assert labels(session) == ["sofa", "chair"]
    assert "1 proposal was left out because another box shows the same object." in said[-1]
    assert "Chair would be at least 3.3 m high" in said[-1]
    assert client.selected_box == 1
