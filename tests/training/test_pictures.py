"""Pictures of a room: what is seen has a box, a kind and a form; a file gives back what was written."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from diorama_core.errors import Cancelled
from diorama_core.library.catalogue import built_in_library
from diorama_core.library.form import MEASURED
from diorama_core.progress import CancelToken, Progress, ProgressEvent
from diorama_core.training import pictures
from diorama_core.training.pictures import (
    BoxStatistics,
    PictureFiles,
    category_names,
    count_pictures,
    make_files,
    make_pictures,
    read_boxes,
    read_picture,
    visible_boxes,
)


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A folder with two small pictures of one room."""
    folder = tmp_path_factory.mktemp("pictures")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pictures, "VIEWS", 2)
        patch.setattr(pictures, "SIZE", (256, 192))
        assert make_pictures(folder, built_in_library(), range(3, 4)) == 1
        yield folder


def test_a_room_is_rendered_once_with_kinds_and_forms(made: Path) -> None:
    library = built_in_library()
    assert make_pictures(made, library, range(3, 4)) == 0
    path, names = made / "room_000003.npz", category_names(library)
    assert count_pictures(path) == 2
    picture = read_picture(path, 0)
    assert picture.rgb.shape == (pictures.SIZE[1], pictures.SIZE[0], 3)
    assert len(picture.boxes) == len(picture.categories) == len(picture.pixels) == len(picture.forms) > 2
    base = MEASURED.index("base")
    for category, form in zip(picture.categories, picture.forms, strict=True):
        if names[category] in ("table", "chair", "sofa"):
            assert form[base] >= 0
        if names[category] in ("picture", "vase"):
            assert form[base] == -1
    boxes, categories, size = read_boxes(path, 0)
    np.testing.assert_array_equal(boxes, picture.boxes)
    np.testing.assert_array_equal(categories, picture.categories)
    assert size == pictures.SIZE


@pytest.mark.parametrize(("pixels", "seen"), [(3, False), (12, True)])
def test_what_is_hardly_seen_has_no_box(pixels: int, seen: bool) -> None:
    ids = np.full((40, 40), -1, np.int32)
    ids[5 : 5 + pixels, 7 : 7 + pixels] = 1
    boxes, visible, counted = visible_boxes(ids, 3)
    assert list(visible) == ([1] if seen else [])
    if seen:
        assert boxes[0].tolist() == [7, 5, 7 + pixels, 5 + pixels]
        assert counted[0] == pixels**2


def test_statistics_draw_boxes_of_the_asked_proportions(made: Path) -> None:
    files = PictureFiles.of(made)
    statistics = BoxStatistics.of(files, 147)
    assert statistics.counts.sum() == sum(len(read_picture(*picture).boxes) for picture in files.pictures)
    assert files.rooms == (made / "room_000003.npz",)
    drawn = statistics.draw(int(np.argmin(statistics.counts)), (2.0, 1.0), np.random.default_rng(0))
    assert drawn[5] == pytest.approx(np.log(2.0))
    assert drawn[3] - drawn[4] == pytest.approx(np.log(2.0))


def test_what_is_there_is_not_made_again(tmp_path: Path) -> None:
    folder, asked = tmp_path / "new" / "rooms", list[int]()

    def made(seed: int) -> bytes:
        asked.append(seed)
        return str(seed).encode()

    assert make_files(folder, range(3, 5), "room_{:06d}.npz".format, made) == 2
    assert make_files(folder, range(2, 6), "room_{:06d}.npz".format, made) == 2
    assert asked == [3, 4, 2, 5]
    assert {p.name: p.read_text() for p in folder.iterdir()} == {f"room_{n:06d}.npz": str(n) for n in range(2, 6)}


def test_a_cancelled_run_keeps_what_it_made(tmp_path: Path) -> None:
    token = CancelToken()

    def stop_at_the_third(event: ProgressEvent) -> None:
        if event.message == "2":
            token.cancel()

    with pytest.raises(Cancelled):
        make_files(tmp_path, range(9), "{}.npz".format, lambda _: b"x", Progress(stop_at_the_third, token))
    kept = len(list(tmp_path.iterdir()))
    assert 2 <= kept <= 3
    assert make_files(tmp_path, range(9), "{}.npz".format, lambda _: b"x") == 9 - kept
