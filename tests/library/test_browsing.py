from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypedDict, Unpack

from diorama_core.library.browsing import Filters, browse, one_of_each
from diorama_core.library.record import Shape


def shape(name: str, category: str, style: str, longest: float) -> Shape:
    return Shape(id=name, category=category, caption=name, size_m=(0.1, longest, 0.1), style=style)


SHAPES = (
    shape("sofa", "sofa", "modern", 2.0),
    shape("loveseat", "sofa", "classic", 1.4),
    shape("stool", "stool", "modern", 0.4),
    shape("mine", "stool", "", 0.5),
)


class Known(TypedDict, total=False):
    favourites: Sequence[str]
    recent: Sequence[str]
    is_own: Callable[[str], bool]
    has_place: Callable[[Shape], bool]


def ids(filters: Filters, **known: Unpack[Known]) -> list[str]:
    return [s.id for s in browse(SHAPES, filters, **known)]


def test_filters_are_taken_together() -> None:
    assert ids(Filters()) == ["sofa", "loveseat", "stool", "mine"]
    assert not Filters().any
    assert ids(Filters(category="sofa")) == ["sofa", "loveseat"]
    assert ids(Filters(category="sofa", style="classic")) == ["loveseat"]
    assert [ids(Filters(size=s)) for s in ("small", "medium", "large")] == [["stool"], ["loveseat", "mine"], ["sofa"]]
    assert ids(Filters(room="living")) == ["sofa", "loveseat"]
    assert ids(Filters(fitting=True), has_place=lambda s: s.size_m[1] < 1.0) == ["stool", "mine"]


def test_shelves_hold_what_is_marked_used_and_owned() -> None:
    assert ids(Filters(shelf="favourites"), favourites=("stool", "gone")) == ["stool"]
    assert ids(Filters(shelf="recent"), recent=("mine", "sofa")) == ["mine", "sofa"], "the last first"
    assert ids(Filters(shelf="own"), is_own=lambda i: i == "mine") == ["mine"]
    assert ids(Filters(shelf="own")) == []


def test_whether_there_is_a_place_is_asked_of_what_passes_everything_else() -> None:
    asked: list[str] = []

    def has_place(s: Shape) -> bool:
        asked.append(s.id)
        return True

    ids(Filters(category="stool", fitting=True), has_place=has_place)
    assert asked == ["stool", "mine"]


def test_one_of_each_category() -> None:
    assert [s.id for s in one_of_each(SHAPES)] == ["sofa", "stool"]
