from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from diorama_core.errors import InputError
from diorama_core.importing.measured_cloud import measure_cloud
from diorama_core.importing.measured_room import open_room
from diorama_core.importing.measured_types import MeasuredBox, MeasuredRoom
from diorama_core.importing.point_files import read_points
from diorama_core.importing.scanned_kinds import ScannedSurface, unit_surface, with_scanned_kinds
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.taxonomy import broad
from diorama_core.scene.types import yaw_rotation
from diorama_core.synthesis.scan import write_scan
from tests.importing.furnished_scans import living_room, searched

LIBRARY = built_in_library()


@pytest.fixture(scope="module")
def measured(tmp_path_factory: pytest.TempPathFactory) -> MeasuredRoom:
    _, frames = living_room()
    return measure_cloud(read_points(write_scan(tmp_path_factory.mktemp("scan"), frames)))


def right_kinds(room: MeasuredRoom) -> set[str]:
    """Kinds of furniture that stand in the opened room where the true one has the same."""
    truth, _ = living_room()
    scene = open_room(room, searched()).scene
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


def scanned(category: str, turn: float = 0.0, number: int = 1) -> MeasuredBox:
    """A shape of the library as a box with points of its surface, seen from above and from the sides."""
    shape = LIBRARY.in_category(category)[number]
    points = np.asarray(trimesh.sample.sample_surface(LIBRARY.mesh(shape.id), 3000, seed=3)[0])
    R, centre = yaw_rotation(turn), np.array([1.0, 2.0, shape.size_m[2] / 2])
    size = np.array(shape.size_m)
    return MeasuredBox("object", {}, R, centre, size, points=points @ R.T + centre)


@pytest.mark.parametrize(("category", "others"), [("chair", ("cabinet", "box")), ("table", ("cabinet", "bed"))])
def test_the_own_kind_is_nearest_to_the_points(category: str, others: tuple[str, ...]) -> None:
    surface = ScannedSurface.of(scanned(category, turn=0.7))
    own = surface.misfit_of_kind(category, LIBRARY)
    for other in others:
        misfit = surface.misfit_of_kind(other, LIBRARY)
        assert own < misfit - 0.01


def test_the_shape_itself_fits_in_its_own_turn() -> None:
    box = scanned("chair")
    misfits = ScannedSurface.of(box).misfits(LIBRARY.in_category("chair")[1], LIBRARY)
    assert int(np.argmin(misfits)) == 0
    assert misfits[0] < 0.04


def test_a_thin_thing_is_not_turned_across_its_box() -> None:
    seen = np.random.default_rng(0).uniform(-0.5, 0.5, (400, 3)) * [0.02, 0.54, 0.86]
    box = MeasuredBox("object", {}, np.eye(3), np.zeros(3), np.array([0.02, 0.54, 0.86]), points=seen)
    _, quarters = ScannedSurface.of(box).fits("picture", LIBRARY)
    assert quarters % 2 == 0
    across = MeasuredBox("object", {}, np.eye(3), np.zeros(3), np.array([0.54, 0.02, 0.86]), points=seen[:, [1, 0, 2]])
    _, quarters = ScannedSurface.of(across).fits("picture", LIBRARY)
    assert quarters % 2 == 1


def test_a_kind_without_shapes_says_nothing() -> None:
    assert ScannedSurface.of(scanned("chair")).misfit_of_kind("unicorn", LIBRARY) is None


def test_a_box_without_points_has_no_surface() -> None:
    with pytest.raises(ValueError, match="no points"):
        ScannedSurface.of(MeasuredBox("object", {}, np.eye(3), np.zeros(3), np.ones(3)))


def test_surfaces_fill_the_unit_box() -> None:
    points = unit_surface(LIBRARY.in_category("table")[0], LIBRARY)
    assert np.abs(points).max() == pytest.approx(0.5, abs=0.02)
