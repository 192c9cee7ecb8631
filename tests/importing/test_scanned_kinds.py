from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import InputError
from diorama_core.importing.measured_cloud import measured_cloud
from diorama_core.importing.measured_room import opened_room
from diorama_core.importing.measured_types import MeasuredBox, MeasuredRoom
from diorama_core.importing.point_files import read_points
from diorama_core.importing.scanned_kinds import with_scanned_kinds
from diorama_core.library.taxonomy import broad
from diorama_core.synthesis.scan import write_scan
from tests.importing.furnished_scans import living_room, searched


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> MeasuredRoom:
    _, frames = living_room()
    return measured_cloud(read_points(write_scan(tmp_path_factory.mktemp("scan"), frames)))


def right_kinds(room: MeasuredRoom) -> set[str]:
    """Kinds of furniture that stand in the opened room where the true one has the same."""
    truth, _ = living_room()
    scene = opened_room(room, searched()).scene
    right = set()
    for item in truth.objects:
        for found in scene.objects:
            near = np.linalg.norm(found.pose.position[:2] - item.pose.position[:2]) < 0.3
            if near and broad(found.category) == broad(item.category):
                right.add(broad(item.category))
    return right


def test_photos_tell_kinds_that_sizes_do_not(measured: MeasuredRoom) -> None:
    assert len(measured.photos) == 24
    by_size, with_photos = right_kinds(measured), right_kinds(with_scanned_kinds(measured, searched()))
    assert {"sofa", "plant", "coffee table", "tv stand"} <= with_photos
    assert len(with_photos) > len(by_size)


def test_shares_are_probabilities_and_know_the_size(measured: MeasuredRoom) -> None:
    found = with_scanned_kinds(measured, searched(), look=False)
    assert len(found.boxes) == len(measured.boxes)
    for box in found.boxes:
        assert box.kinds_know_size
        assert sum(box.kinds.values()) == pytest.approx(1.0)


def test_boxes_without_points_keep_their_kinds() -> None:
    box = MeasuredBox("chair", {"chair": 1.0}, np.eye(3), np.array([0, 0, 0.4]), np.array([0.5, 0.5, 0.8]))
    room = MeasuredRoom((), (box,))
    assert with_scanned_kinds(room, searched()).boxes == (box,)


def test_a_damaged_photo_is_one_clear_line(measured: MeasuredRoom, tmp_path: Path) -> None:
    damaged = tmp_path / "frame_00001.jpg"
    damaged.write_bytes(b"no picture")
    photos = tuple(replace(photo, picture=damaged) for photo in measured.photos)
    with pytest.raises(InputError, match=r"frame_00001.jpg is not a whole picture"):
        with_scanned_kinds(replace(measured, photos=photos), searched())
