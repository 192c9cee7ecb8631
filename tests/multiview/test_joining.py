from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from diorama_core.artefacts import DetectedObject
from diorama_core.multiview.joining import (
    RoomPhoto,
    Track,
    edges_cut_short,
    fit_track,
    join_objects,
    with_agreeing_boxes,
)
from diorama_core.multiview.settings import SETTINGS
from tests.multiview.rooms import CAMERAS, THINGS, photo


@pytest.mark.parametrize("error_m", [0.3, -0.3])
def test_boxes_of_one_thing_become_one_object(error_m: float) -> None:
    photos, whose = zip(*(photo(c, error_m=error_m) for c in CAMERAS), strict=True)
    tracks = join_objects(photos)
    assert len(tracks) == len(THINGS)
    for track in tracks:
        assert len({whose[number][box] for number, box in track.boxes}) == 1
        assert len({number for number, _ in track.boxes}) == len(track.boxes), "one box a photo"
    boxes = [b for t in tracks for b in t.boxes]
    assert len(boxes) == len(set(boxes)) == sum(len(p.alone) for p in photos), "every box is of one object"


def test_one_photo_alone_is_what_it_says() -> None:
    one, _ = photo(CAMERAS[0])
    tracks = join_objects((one,))
    assert [t.boxes for t in tracks] == [((0, k),) for k in range(len(one.alone))]
    assert all((t.cuboid.centre == a.centre).all() for t, a in zip(tracks, one.alone, strict=True))


def test_things_of_other_kinds_are_never_joined() -> None:
    first, _ = photo(CAMERAS[0], THINGS[:1])
    second, _ = photo(CAMERAS[1], (THINGS[3],))
    assert len(join_objects((first, second))) == 2


SOFA = 0


def photographed(cut_short_in: int | None = None) -> tuple[list[RoomPhoto], Track]:
    """Three photos of a sofa, in one of them half of it hidden without anybody saying so."""
    photos = []
    for number, seen in enumerate(CAMERAS):
        one, _ = photo(seen, THINGS[SOFA : SOFA + 1])
        if number == cut_short_in:
            boxes = one.boxes.observations.box_px.copy()
            boxes[0, 2] = boxes[0, [0, 2]].mean()
            boxes[0, 1] = boxes[0, [1, 3]].mean()
            one = replace(one, boxes=replace(one.boxes, observations=replace(one.boxes.observations, box_px=boxes)))
        photos.append(one)
    return photos, fit_track(tuple((number, 0) for number in range(len(CAMERAS))), photos)


def off(track: Track) -> float:
    """How far its footprint is from the sofa's place, in metres."""
    return float(np.linalg.norm(track.cuboid.centre[:2] - THINGS[SOFA].centre[:2]))


def test_boxes_that_agree_all_count() -> None:
    photos, track = photographed()
    found = with_agreeing_boxes(track, photos)
    assert found.left_out == ()
    assert found.inliers == track.boxes
    assert found.cuboid is track.cuboid


def test_a_box_that_no_other_photo_agrees_with_is_left_out_of_the_fit_and_stays_the_objects() -> None:
    photos, track = photographed(cut_short_in=1)
    assert track.cuboid.cost > SETTINGS.left_out_cost
    found = with_agreeing_boxes(track, photos)
    assert found.left_out == ((1, 0),)
    assert found.boxes == track.boxes
    assert off(found) < off(track)


def test_of_two_photos_that_disagree_the_one_that_shows_more_counts_alone() -> None:
    photos, _ = photographed(cut_short_in=1)
    both = fit_track(((0, 0), (1, 0)), photos)
    assert both.cuboid.cost > SETTINGS.left_out_cost
    found = with_agreeing_boxes(both, photos)
    assert found.inliers == ((0, 0),)
    np.testing.assert_array_equal(found.cuboid.size_m, photos[0].alone[0].size_m)


def marked(name: str, box: tuple[int, int, int, int]) -> DetectedObject:
    mask = np.zeros((100, 200), dtype=bool)
    mask[box[1] : box[3], box[0] : box[2]] = True
    return DetectedObject(name, "table", "table", tuple(float(v) for v in box), mask, 1, 0.9)


TABLE, CHAIR = marked("table", (40, 30, 120, 60)), marked("chair", (110, 35, 150, 95))
BOXES = np.array([TABLE.box, CHAIR.box])


def test_an_edge_beside_something_nearer_is_cut_short() -> None:
    found = edges_cut_short([TABLE, CHAIR], BOXES, np.array([3.0, 2.0]))
    np.testing.assert_array_equal(found[0], [False, False, True, False])
    assert not found[1].any()


def test_what_is_farther_hides_nothing() -> None:
    found = edges_cut_short([TABLE, CHAIR], BOXES, np.array([2.0, 3.0]))
    assert not found[0].any()
    np.testing.assert_array_equal(found[1], [True, True, False, False])


def test_the_picture_s_border_hides_nothing() -> None:
    alone = marked("table", (0, 0, 200, 100))
    assert not edges_cut_short([alone], np.array([alone.box]), np.array([2.0])).any()
    assert edges_cut_short([], np.zeros((0, 4)), np.zeros(0)).shape == (0, 4)
