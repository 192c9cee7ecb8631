"""Small pictures: named at once, made when a browser asks."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from diorama_app.viewport.thumbnails import Thumbnails
from diorama_core.library.user_library import ShapeRecords
from tests.app.small_room import PlainLibrary


@pytest.fixture
def thumbnails() -> Iterator[Thumbnails]:
    library = PlainLibrary()
    made = Thumbnails(library, ShapeRecords(library))
    yield made
    made.stop()


def name_in(html: str) -> str:
    found = re.search(r'src="pictures/([0-9a-f]+\.png)"', html)
    assert found is not None
    return found[1]


def test_a_picture_is_made_for_the_name_in_the_html(thumbnails: Thumbnails) -> None:
    own, red = (thumbnails.html("chair_a", paint) for paint in ((None, None), ((0.9, 0.1, 0.1), None)))
    assert name_in(own) == name_in(thumbnails.html("chair_a"))
    assert name_in(own) != name_in(red)
    first, second = (thumbnails.png(name_in(h)).result(30) for h in (own, red))
    assert first is not None
    assert first.startswith(b"\x89PNG")
    assert first != second


def test_what_is_not_known_has_no_picture(thumbnails: Thumbnails) -> None:
    assert "img" not in thumbnails.html("no such shape")
    assert thumbnails.png("0123.png").result(5) is None
