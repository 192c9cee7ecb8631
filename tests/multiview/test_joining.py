from __future__ import annotations

import pytest

from diorama_core.multiview.joining import joined_objects
from tests.multiview.rooms import CAMERAS, THINGS, photo


@pytest.mark.parametrize("error_m", [0.0, 0.3, -0.3])
def test_boxes_of_one_thing_become_one_object(error_m: float) -> None:
    photos, whose = zip(*(photo(c, error_m=error_m) for c in CAMERAS), strict=True)
    tracks = joined_objects(photos)
    assert len(tracks) == len(THINGS)
    for track in tracks:
        assert len({whose[number][box] for number, box in track.boxes}) == 1
        assert len({number for number, _ in track.boxes}) == len(track.boxes), "one box a photo"
    boxes = [b for t in tracks for b in t.boxes]
    assert len(boxes) == len(set(boxes)) == sum(len(p.alone) for p in photos), "every box is of one object"


def test_one_photo_alone_is_what_it_says() -> None:
    one, _ = photo(CAMERAS[0])
    tracks = joined_objects((one,))
    assert [t.boxes for t in tracks] == [((0, k),) for k in range(len(one.alone))]
    assert all((t.cuboid.centre == a.centre).all() for t, a in zip(tracks, one.alone, strict=True))


def test_things_of_other_kinds_are_never_joined() -> None:
    first, _ = photo(CAMERAS[0], THINGS[:1])
    second, _ = photo(CAMERAS[1], (THINGS[3],))
    assert len(joined_objects((first, second))) == 2
