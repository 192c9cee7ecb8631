"""Rooms built as a script builds them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import diorama_core as diorama
from diorama_core.artefacts import CameraEstimate, Inputs
from diorama_core.errors import InputError
from diorama_core.perception.camera.estimate import EmbeddedCamera
from diorama_core.progress import Progress, ProgressEvent
from diorama_core.scene.room_edits import KNOWN_LENGTH_SIGMA, floor_height
from tests.cli.room_photo import BOXES, room_picture, write_room
from tests.few_shapes import few_shapes, stored_seats


def test_arrays_and_files_give_the_same_scene(room: diorama.Reconstruction, tmp_path: Path) -> None:
    photo, boxes = write_room(tmp_path)
    library = stored_seats()
    built = diorama.build(str(photo), boxes=boxes, profile="embedded", library=library, output=tmp_path / "room")
    assert built.scene == room.scene
    assert diorama.load(tmp_path / "room").scene == built.scene


def test_one_stage_can_be_replaced_and_products_are_done_by_one_thread(room: diorama.Reconstruction) -> None:
    threads: set[int] = set()

    @dataclass(frozen=True)
    class Wider:
        """The embedded camera with a shorter focal length."""

        def estimate(self, inputs: Inputs, progress: Progress) -> CameraEstimate:
            threads.update(p["num_threads"] for p in threadpool_info() if p["user_api"] == "blas")
            found = EmbeddedCamera().estimate(inputs, progress)
            k = found.best.intrinsics
            best = replace(found.best, intrinsics=replace(k, fx=0.8 * k.fx, fy=0.8 * k.fy))
            return replace(found, hypotheses=(best,))

    with threadpool_limits(2, "blas"):  # whatever the program has set
        wider = diorama.build(
            room_picture(),
            boxes=BOXES[:1],
            profile="embedded",
            library=stored_seats(),
            stages=lambda stages: replace(stages, camera=Wider()),
        )
    assert threads == {1}
    assert wider.scene.camera is not None
    assert room.scene.camera is not None
    assert wider.scene.camera.intrinsics.fx == pytest.approx(0.8 * room.scene.camera.intrinsics.fx)


def test_remarks_and_progress_reach_the_caller_and_a_library_can_be_given() -> None:
    said: list[str] = []
    events: list[ProgressEvent] = []
    odd = [{"bbox": [250, 20, 400, 140], "class": "floor lamp"}]
    built = diorama.build(
        room_picture(),
        boxes=odd,
        library=few_shapes(),
        warn=said.append,
        camera_height_m=2.0,
        progress=Progress(events.append),
    )
    assert said
    assert tuple(said) == built.warnings
    assert built.library_name is None
    assert events[-1].fraction == pytest.approx(1.0)
    assert [e.fraction for e in events] == sorted(e.fraction for e in events)
    assert built.scene.camera is not None
    assert built.scene.camera.position[2] - floor_height(built.scene) == pytest.approx(2.0)
    assert built.scene.scale_sigma == KNOWN_LENGTH_SIGMA


def test_a_camera_stands_in_a_room() -> None:
    with pytest.raises(InputError, match="200 m above the floor is not possible"):
        diorama.build(room_picture(), boxes=BOXES, profile="embedded", camera_height_m=200.0)
