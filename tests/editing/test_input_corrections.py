"""What people said of the photo outlives undo and redo, saving and opening, and the next build."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_app.reconstruction.camera_correction import camera_height_m
from diorama_core.artefacts import Inputs, LabelledBox
from diorama_core.editing.input_corrections import (
    boxes_json,
    find_outline,
    label_box,
    same_object,
    with_box_at,
    with_boxes_added,
    with_correction,
    without_box,
)
from diorama_core.geometry.rotations import CameraAttitude
from diorama_core.perception.camera.estimate import GivenAttitudeCamera
from diorama_core.perception.inputs import read_inputs
from diorama_core.pipeline import codec
from diorama_core.pipeline.presets import stages_for
from diorama_core.pipeline.stages import embedded_stages
from diorama_core.progress import Progress
from diorama_core.project.build import build_project
from diorama_core.project.storage import Project
from tests.app.small_room import PlainLibrary, plain_photo

TABLE = LabelledBox((240.0, 200.0, 440.0, 420.0), "table", "dining table")
CHAIR = LabelledBox((40.0, 250.0, 160.0, 440.0), "chair", "chair")


def disc(x: float, y: float, radius: float) -> np.ndarray:
    rows, columns = np.mgrid[:480, :640]
    return (columns - x) ** 2 + (rows - y) ** 2 < radius**2


ROUND = disc(340.0, 310.0, 80.0)


@pytest.fixture
def inputs() -> Inputs:
    return Inputs(plain_photo(), (TABLE, CHAIR))


def test_another_word_keeps_box_and_outline(inputs: Inputs) -> None:
    outlined = with_correction(inputs, TABLE.box, TABLE, ROUND)
    ui_thread = replace(TABLE, category="desk", label="desk")
    renamed = with_correction(outlined, TABLE.box, ui_thread)
    assert renamed.boxes == (ui_thread, CHAIR)
    mask = find_outline(renamed, ui_thread.box)
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
    table, chair = find_outline(both, TABLE.box), find_outline(both, CHAIR.box)
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


def test_boxes_are_drawn_named_moved_and_deleted(inputs: Inputs) -> None:
    outlined = with_correction(inputs, TABLE.box, TABLE, ROUND)
    couch = label_box((10.0, 20.0, 110.0, 220.0), "couch")
    assert couch.category == "sofa"
    marked = replace(outlined, boxes=(*outlined.boxes, couch))
    desk = with_box_at(marked, 0, label_box(TABLE.box, "desk"))
    assert [b.label for b in desk.boxes] == ["desk", "chair", "couch"]
    assert find_outline(desk, TABLE.box) is not None, "another name keeps the outline"
    moved = with_box_at(desk, 0, replace(desk.boxes[0], box=(250.0, 200.0, 440.0, 420.0)))
    assert moved.instance_boxes == (), "another box drops it"
    assert [b.label for b in without_box(moved, 1).boxes] == ["desk", "couch"]


def test_detected_boxes_join_those_that_are_there(inputs: Inputs) -> None:
    near = replace(TABLE, box=(245.0, 205.0, 440.0, 420.0))
    lamp = LabelledBox((500.0, 50.0, 560.0, 150.0), "lamp", "lamp")
    assert with_boxes_added(inputs, [near, lamp]).boxes == (TABLE, CHAIR, lamp)
    assert with_boxes_added(replace(inputs, boxes=()), [lamp]).boxes == (lamp,)


def test_drawn_boxes_go_back_to_the_files_pixels() -> None:
    photo = plain_photo()
    boxes = [label_box((10.0, 20.0, 110.0, 220.0), "couch"), label_box((5.0, 5.0, 50.0, 60.0), "chair")]
    buffer = io.BytesIO()
    Image.fromarray(photo.rgb).save(buffer, "PNG")
    again = read_inputs(buffer.getvalue(), name="p.png", boxes=boxes_json(boxes, photo))
    assert [b.box for b in again.inputs.boxes] == [b.box for b in boxes]


def test_tilt_and_scale_hold_for_every_later_build(tmp_path: Path, inputs: Inputs) -> None:
    said = replace(inputs, camera_attitude=CameraAttitude(0.31, 0.02), camera_height_m=1.8)
    for stages in (embedded_stages(said, PlainLibrary()), stages_for("auto", said, PlainLibrary())):
        assert isinstance(stages.camera, GivenAttitudeCamera)
    project = Project.create(tmp_path / "room")
    build_project(project, said, PlainLibrary())
    again = project.load_inputs()
    assert again is not None
    assert again.camera_attitude == said.camera_attitude
    scene = build_project(project, again, PlainLibrary()).scene
    assert scene.camera is not None
    assert CameraAttitude.of(scene.camera.T_world_camera[:3, :3]).pitch_rad == pytest.approx(0.31, abs=1e-6)
    assert camera_height_m(scene) == pytest.approx(1.8)


def test_inputs_about_whose_camera_nothing_was_said_are_the_bytes_they_were(inputs: Inputs) -> None:
    assert b"camera_attitude" not in codec.dump(inputs)
    assert b"camera_height" not in codec.dump(inputs)
    said = replace(inputs, camera_attitude=CameraAttitude(0.1, 0.0), camera_height_m=1.5)
    assert codec.load(codec.dump(said)) == said
    assert said.without_camera == inputs


def test_the_same_object_is_the_one_that_overlaps_most() -> None:
    boxes = (LabelledBox((0.0, 0.0, 10.0, 10.0), "chair", "chair"), LabelledBox((8.0, 0.0, 18.0, 10.0), "sofa", "sofa"))
    assert same_object(boxes, (9.0, 0.0, 18.0, 10.0)) == 1
    assert same_object(boxes, (40.0, 0.0, 50.0, 10.0)) is None
    assert same_object((), (0.0, 0.0, 10.0, 10.0)) is None
