from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from diorama_core.artefacts import LabelledBox, Photo
from diorama_core.models.room_surfaces import CELL_PX, RoomSurfaces, SurfaceReader, elevation_sines
from diorama_core.multiview.sphere_views import (
    SphereBox,
    merge_detections,
    picture_boxes,
    project_to_views,
    sphere_surfaces,
    sphere_views,
    to_sphere_boxes,
    view_photo,
)

SIZE = (2048, 1024)
VIEWS = sphere_views(SIZE[0])
CHAIR = LabelledBox((0.0, 0.0, 1.0, 1.0), "chair", "chair")


@given(st.floats(-3.14, 3.14), st.floats(0.03, 0.3), st.floats(-0.9, -0.3), st.floats(0.1, 0.8))
def test_every_narrow_thing_is_whole_in_some_view_and_comes_back(
    a: float, half: float, low: float, tall: float
) -> None:
    thing = SphereBox(a, half, low, low + tall, CHAIR)
    shown = [(view, box) for view in VIEWS if (box := view.project(thing)) is not None]
    view, box = min(shown, key=lambda row: abs(thing.azimuth_from(row[0].azimuth)))
    assert 0 < box.box[0] < box.box[2] < view.intrinsics.width
    back = view.to_sphere(box)
    assert back.azimuth_from(a) == pytest.approx(0.0, abs=0.02)
    assert back.half_width == pytest.approx(half, abs=1e-6)


def test_a_thing_at_the_seam_is_one() -> None:
    parts = [
        LabelledBox((1990.0, 500.0, 2048.0, 700.0), "chair", "chair"),
        LabelledBox((0.0, 510.0, 60.0, 690.0), "chair", "chair"),
    ]
    apart = LabelledBox((0.0, 100.0, 50.0, 200.0), "picture", "picture")
    things = to_sphere_boxes([*parts, apart], SIZE, np.eye(3))
    assert len(things) == 2
    whole = next(t for t in things if t.labelled.category == "chair")
    assert whole.half_width == pytest.approx(np.pi * 118 / 2048)
    assert whole.azimuth == pytest.approx(np.pi / 2, abs=0.01)  # the seam is behind: +Y


@given(st.floats(0, 2046), st.floats(20, 400), st.floats(300, 500), st.floats(30, 400))
def test_boxes_of_the_picture_come_back_also_across_the_seam(x: float, wide: float, y: float, tall: float) -> None:
    drawn = LabelledBox((x, y, x + wide, y + tall), "chair", "chair")
    things = to_sphere_boxes([drawn], SIZE, np.eye(3))
    boxes = picture_boxes(things, SIZE, np.eye(3))
    assert len(boxes) == (2 if x + wide > SIZE[0] + 2 else 1)
    assert boxes[0].box[0] == pytest.approx(x, abs=0.01)
    beyond = 0.0 if x + wide <= SIZE[0] + 2 else SIZE[0]
    assert boxes[-1].box[2] == pytest.approx(min(x + wide - beyond, SIZE[0]), abs=0.01)
    assert all(b.box[1::2] == pytest.approx((y, y + tall), abs=0.01) for b in boxes)
    (again,) = to_sphere_boxes(boxes, SIZE, np.eye(3))
    assert again.half_width == pytest.approx(things[0].half_width, abs=1e-4)


def test_views_are_marked_with_the_best_one_first_and_what_is_found_twice_is_one() -> None:
    thing = SphereBox(0.5, 0.2, -0.4, 0.1, CHAIR)
    photos = [(v, Photo(np.zeros((v.intrinsics.height, v.intrinsics.width, 3), np.uint8), "p", SIZE)) for v in VIEWS]
    posed, seen = project_to_views(photos, [thing], 1.4)
    nearest = min(range(len(VIEWS)), key=lambda n: abs(thing.azimuth_from(VIEWS[n].azimuth)))
    assert seen[0][0] == (nearest, 0)
    assert len(seen[0]) >= 2
    assert all(p.camera.position[2] == 1.4 for p in posed)
    found = merge_detections([(v, p.inputs.boxes) for v, p in zip(VIEWS, posed, strict=True)])
    assert len(found) == 1
    assert found[0].azimuth_from(0.5) == pytest.approx(0.0, abs=0.02)


def test_a_view_s_picture_has_its_camera_s_size() -> None:
    photo = view_photo(np.zeros((128, 256, 3), np.uint8), np.eye(3), VIEWS[1], "a.png")
    k = VIEWS[1].intrinsics
    assert (photo.width, photo.height) == (k.width, k.height)


class HorizonReader(SurfaceReader):
    """Tells floor below a low elevation and ceiling above a high one."""

    def read(self, rgb: np.ndarray, camera: Camera) -> RoomSurfaces:
        rise = elevation_sines(camera, (rgb.shape[0] // CELL_PX, rgb.shape[1] // CELL_PX))
        kinds = np.where(rise < np.sin(-0.3), 0, np.where(rise > np.sin(0.5), 2, 1))
        return np.moveaxis(np.eye(3, dtype=np.float32)[kinds], -1, 0)


def test_what_views_show_of_floor_and_ceiling_is_one_map_all_round() -> None:
    level = np.zeros((128, 256, 3), np.uint8)
    shares = sphere_surfaces(level, HorizonReader(Path("none"), "none"))
    elevation = np.pi * (0.5 - (np.arange(shares.shape[1]) + 0.5) / shares.shape[1])
    told = np.abs(elevation) < 1.0
    expected = np.where(elevation < -0.3, 0, np.where(elevation > 0.5, 2, 1))
    clear = told & (np.abs(elevation + 0.3) > 0.03) & (np.abs(elevation - 0.5) > 0.03)
    assert (shares.argmax(axis=0)[clear] == expected[clear, None]).all()
    assert (shares.max(axis=0)[clear] > 0.9).all()
    np.testing.assert_allclose(shares[:, 0], 1 / 3, atol=1e-6, err_msg="no view looks straight up")
