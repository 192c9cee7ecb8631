from __future__ import annotations

from dataclasses import replace

import numpy as np

from diorama_core.multiview.agreement import with_agreeing_boxes
from diorama_core.multiview.joining import RoomPhoto, Track, fitted_track
from diorama_core.multiview.settings import SETTINGS
from tests.multiview.rooms import CAMERAS, THINGS, photo

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
    return photos, fitted_track(tuple((number, 0) for number in range(len(CAMERAS))), photos)


def off(track: Track) -> float:
    """How far its footprint is from the sofa's place, in metres."""
    return float(np.linalg.norm(track.cuboid.centre[:2] - THINGS[SOFA].centre[:2]))


def test_boxes_that_agree_all_count() -> None:
    photos, track = photographed()
    found = with_agreeing_boxes(track, photos)
    assert found.left_out == ()
    assert found.fitted == track.boxes
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
    both = fitted_track(((0, 0), (1, 0)), photos)
    assert both.cuboid.cost > SETTINGS.left_out_cost
    found = with_agreeing_boxes(both, photos)
    assert found.fitted == ((0, 0),)
    np.testing.assert_array_equal(found.cuboid.size_m, photos[0].alone[0].size_m)
