"""Kinds found by what they are for."""

from __future__ import annotations

import pytest

from diorama_core.library.catalogue import built_in_library
from diorama_core.library.definitions import is_description, kinds_described
from diorama_core.library.search import find
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN

DESCRIPTIONS = (
    ("keeps food cold", ("refrigerator",)),
    ("something to sleep on", ("bed", "bunk bed", "day bed", "crib")),
    ("heats up leftovers in seconds", ("microwave",)),
    ("where guests hang their jackets", ("coat rack",)),
    ("lets a baby eat with the family", ("high chair",)),
    ("dries wet laundry", ("dryer",)),
    ("tells what time it is", ("clock", "mantel clock", "grandfather clock")),
    ("to put my books on", ("bookshelf", "shelves")),
    ("blocks sunlight from the window", ("curtain", "blinds")),
    ("rest your feet on it after work", ("ottoman",)),
    ("somewhere to throw rubbish away", ("trash can",)),
    ("browns slices of bread", ("toaster",)),
    ("boils water for tea", ("kettle",)),
    ("cleans dirty dishes by itself", ("dishwasher",)),
    ("makes espresso in the morning", ("coffee machine",)),
    ("two children sleep one above the other", ("bunk bed",)),
    ("grows leaves and needs watering", ("plant", "hanging plant")),
    ("shows films and the news", ("television",)),
    ("lights up a dark corner from the ground", ("floor lamp",)),
    ("soft thing under your head at night", ("pillow",)),
    ("to wash your hands in", ("sink",)),
    ("warms the room in winter", ("radiator", "heater", "fireplace")),
    ("hides clothes behind doors", ("wardrobe",)),
    ("seat for one with padded arms", ("armchair", "recliner")),
    ("splits one room into two", ("room divider",)),
    ("to type letters at with a computer", ("desk", "keyboard")),
    ("cools the air in summer", ("air conditioner", "fan", "ceiling fan")),
    ("prints documents on paper", ("printer",)),
    ("carries clothes on a trip", ("suitcase",)),
    ("holds cut flowers in water", ("vase",)),
)
"""Written before the definitions were compared with them, and not used to change either."""


def test_descriptions_find_their_kind() -> None:
    library = built_in_library()
    first = five = 0
    for text, kinds in DESCRIPTIONS:
        found = [s.category for s in find(library, text, 5).shapes]
        first += bool(found) and found[0] in kinds
        five += bool(set(found) & set(kinds))
    assert first >= 24
    assert five >= 26


def test_every_kind_is_found_by_its_own_definition() -> None:
    from diorama_core.library.definitions import _lines

    assert set(_lines()) == {c.name for c in CATEGORIES if c is not UNKNOWN}
    for kind, text in _lines().items():
        assert max(kinds_described(text).items(), key=lambda pair: pair[1])[0] == kind


@pytest.mark.parametrize(
    ("text", "is_one"),
    [
        ("keeps food cold", True), ("something to sit on", True), ("where coats hang", True), ("sofa", False),
        ("oak bookcase with doors", False), ("shelves", False), ("desk for two monitors", False),
    ],
)  # fmt: skip
def test_names_are_no_descriptions(text: str, is_one: bool) -> None:
    assert is_description(text) == is_one


def test_nothing_is_described_by_nonsense() -> None:
    assert kinds_described("qwxzzk of the") == {}
