"""What people said of the photo outlives undo and redo, saving and opening, and the next build."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diorama_app.camera_fixing import camera_height_m, set_camera_height
from diorama_app.corrected_inputs import given_outline, with_correction
from diorama_app.guest import Guest
from diorama_app.room import Room
from diorama_app.viser_adapter import Visitors, create_server, stop_server
from diorama_core.artefacts import Inputs, LabelledBox
from diorama_core.geometry.held import Held
from diorama_core.perception.camera.by_hand import HandHeldCamera
from diorama_core.pipeline import codec
from diorama_core.pipeline.build import embedded_stages
from diorama_core.pipeline.profiles import stages_for
from diorama_core.progress import Progress
from diorama_core.project.build import build_project
from diorama_core.project.storage import Project
from diorama_core.scene import edits
from tests.app.people import join
from tests.app.small_room import PlainLibrary, make_project, plain_photo

TABLE = LabelledBox((240.0, 200.0, 440.0, 420.0), "table", "dining table")
CHAIR = LabelledBox((40.0, 250.0, 160.0, 440.0), "chair", "chair")


def disc(x: float, y: float, radius: float) -> np.ndarray:
    rows, columns = np.mgrid[:480, :640]
    return (columns - x) ** 2 + (rows - y) ** 2 < radius**2


ROUND = disc(340.0, 310.0, 80.0)


@pytest.fixture
def inputs() -> Inputs:
    return Inputs(plain_photo(), (TABLE, CHAIR))


@pytest.fixture
def guest(tmp_path: Path) -> Iterator[Guest]:
    server = create_server(host="127.0.0.1", port=0, label="test", visitors=Visitors("127.0.0.1"))
    room = Room(server, PlainLibrary(), tmp_path / "projects")
    room.open_project(make_project(tmp_path / "projects" / "demo"))
    yield join(room)
    room.close()
    stop_server(server)


def kept(guest: Guest) -> Inputs:
    """What a later session finds."""
    assert guest.room.project is not None
    found = Project.open(guest.room.project.folder).load_inputs()
    assert found is not None
    return found


def test_another_word_keeps_box_and_outline(inputs: Inputs) -> None:
    outlined = with_correction(inputs, TABLE.box, TABLE, ROUND)
    desk = replace(TABLE, category="desk", label="desk")
    renamed = with_correction(outlined, TABLE.box, desk)
    assert renamed.boxes == (desk, CHAIR)
    mask = given_outline(renamed, desk.box)
    assert mask is not None
    np.testing.assert_array_equal(mask, ROUND)


def test_a_box_drawn_anew_takes_the_place_of_the_old_one_and_drops_its_outline(inputs: Inputs) -> None:
    outlined = with_correction(inputs, TABLE.box, TABLE, ROUND)
    moved = replace(TABLE, box=(250.0, 190.0, 450.0, 400.0))
    redrawn = with_correction(outlined, TABLE.box, moved)
    assert redrawn.boxes == (moved, CHAIR)
    assert redrawn.instances is None
    assert redrawn.instance_boxes == ()


def test_a_later_outline_lies_in_front_and_leaves_the_others(inputs: Inputs) -> None:
    both = with_correction(with_correction(inputs, TABLE.box, TABLE, ROUND), CHAIR.box, CHAIR, disc(250, 310, 40))
    assert both.boxes == (TABLE, CHAIR)
    table, chair = given_outline(both, TABLE.box), given_outline(both, CHAIR.box)
    assert table is not None
    assert chair is not None
    np.testing.assert_array_equal(chair, disc(250, 310, 40))
    np.testing.assert_array_equal(table, ROUND & ~chair)


def test_what_was_missed_is_added_once(inputs: Inputs) -> None:
    lamp = LabelledBox((500.0, 50.0, 560.0, 150.0), "lamp", "lamp")
    more = with_correction(inputs, None, lamp)
    assert more.boxes == (TABLE, CHAIR, lamp)
    assert with_correction(more, None, lamp) == more


def test_the_next_build_takes_the_outline_as_it_was_drawn(inputs: Inputs) -> None:
    outlined = with_correction(inputs, TABLE.box, TABLE, ROUND)
    found = embedded_stages(outlined, PlainLibrary()).objects.segment(outlined, Progress())
    table = next(o for o in found if o.label == "dining table")
    np.testing.assert_array_equal(table.mask, ROUND)
    assert table.mask_confidence == 1.0
    assert {o.label for o in found} == {"dining table", "chair"}


def test_corrections_are_undone_redone_and_found_by_the_next_session(guest: Guest) -> None:
    room = guest.room
    before = room.document.inputs
    assert before is not None
    bench = replace(TABLE, category="bench", label="bench")
    said = with_correction(before, TABLE.box, bench, ROUND)
    room.edit("outline", lambda s: edits.rename(s, "table_1", "bench"), by=guest, inputs=said)
    assert kept(guest) == said
    assert room.draft.boxes == (bench,), "the list of boxes follows"
    room.undo(guest)
    assert kept(guest) == before
    assert room.draft.boxes == (TABLE,)
    room.redo(guest)
    assert kept(guest) == said
    project = room.project
    assert project is not None
    room.open_project(Project.open(project.folder))
    assert room.document.inputs == said


def test_boxes_that_wait_for_a_build_stay_when_something_else_is_corrected(guest: Guest) -> None:
    room = guest.room
    room.draft = room.draft.with_box(CHAIR.box, "chair")
    before = room.document.inputs
    assert before is not None
    said = with_correction(before, TABLE.box, replace(TABLE, category="desk", label="desk"))
    room.edit("it is a desk", lambda s: edits.rename(s, "table_1", "desk"), by=guest, inputs=said)
    assert [b.label for b in room.draft.boxes] == ["desk", "chair"]
    added = with_correction(said, None, CHAIR)
    room.edit("insert", lambda s: edits.rename(s, "lamp_1", "other lamp"), by=guest, inputs=added)
    assert [b.label for b in room.draft.boxes] == ["desk", "chair"]
    room.undo(guest)
    assert [b.label for b in room.draft.boxes] == ["desk", "chair"], "a box that was drawn is not lost by undo"


def test_tilt_and_scale_hold_for_every_later_build(tmp_path: Path, inputs: Inputs) -> None:
    said = replace(inputs, held=Held(0.31, 0.02), camera_height_m=1.8)
    for stages in (embedded_stages(said, PlainLibrary()), stages_for("auto", said, PlainLibrary())):
        assert isinstance(stages.camera, HandHeldCamera)
    project = Project.create(tmp_path / "room")
    build_project(project, said, PlainLibrary())
    again = project.load_inputs()
    assert again is not None
    assert again.held == said.held
    scene = build_project(project, again, PlainLibrary()).scene
    assert scene.camera is not None
    assert Held.of(scene.camera.T_world_camera[:3, :3]).tilt_rad == pytest.approx(0.31, abs=1e-6)
    assert camera_height_m(scene) == pytest.approx(1.8)


def test_a_known_length_is_kept_as_the_height_of_the_camera(guest: Guest) -> None:
    set_camera_height(guest, 1.9)
    assert kept(guest).camera_height_m == pytest.approx(1.9)
    guest.room.undo(guest)
    assert kept(guest).camera_height_m is None


def test_inputs_about_whose_camera_nothing_was_said_are_the_bytes_they_were(inputs: Inputs) -> None:
    assert b"held" not in codec.dump(inputs)
    assert b"camera_height" not in codec.dump(inputs)
    said = replace(inputs, held=Held(0.1, 0.0), camera_height_m=1.5)
    assert codec.load(codec.dump(said)) == said
    assert said.of_any_camera == inputs
