"""What is read of a project once more."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from diorama_app.projects.begin import begin_project, keep_given
from diorama_app.projects.reading_again import upload_again, with_depth
from diorama_app.projects.uploads import Upload
from diorama_core.errors import InputError
from diorama_core.perception.inputs import read_inputs
from diorama_core.perception.inputs.depth.scale import DepthAnswer
from diorama_core.perception.inputs.source import Source
from diorama_core.project.storage import Project
from tests.perception.inputs.files import depth_png, encoded

PHOTO = encoded(Image.fromarray(np.full((48, 64, 3), 90, np.uint8)))
DEPTH = depth_png(np.full((48, 64), 2500, np.uint16))
LEVELS = Source(b"\2" * 64 * 48, "confidence.bin")


@pytest.fixture
def project(tmp_path: Path) -> Project:
    made = begin_project(tmp_path, "room.png", read_inputs(PHOTO, name="room.png"), PHOTO)
    keep_given(made, Upload(PHOTO, "room.png", Source(DEPTH, "d.png", companions=(LEVELS,)), depth_scale=500.0))
    return made


def test_what_was_given_and_said_is_taken_again(project: Project) -> None:
    inputs = project.load_inputs()
    again = upload_again(project, inputs, {}, None, None, turn=True)
    assert (again.photo, again.depth_scale, again.half_turn, again.bend) == (PHOTO, 500.0, True, 0.0)
    assert isinstance(again.depth, Source)
    assert [c.data for c in again.depth.companions] == [LEVELS.data]
    other = upload_again(project, inputs, {"depth": Source(DEPTH + b" ", "e.png")}, None, None)
    assert other.depth_scale is None, "that was said of another map"
    answered = upload_again(project, inputs, {}, DepthAnswer("", 256.0), (9.0, 9.0, 4.0, 4.0))
    assert (answered.depth_scale, answered.intrinsics) == (256.0, (9.0, 9.0, 4.0, 4.0))


def test_confidence_needs_its_depth(project: Project) -> None:
    found = with_depth({"confidence": LEVELS}, project)
    assert (found["depth"].data, found["depth"].companions) == (DEPTH, (LEVELS,))
    with pytest.raises(InputError, match="add the depth map, too"):
        with_depth({"confidence": LEVELS}, None)
