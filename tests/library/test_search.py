from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from diorama_core.library.catalogue import BuiltInLibrary, built_in_library
from diorama_core.library.ingest.sink import Ingested
from diorama_core.library.language import SizeLimit, size_limits
from diorama_core.library.naming import understand
from diorama_core.library.record import Shape
from diorama_core.library.search import TextIndex, find, is_description, kinds_described, search
from diorama_core.library.store import StoredLibrary
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


@pytest.fixture(scope="module")
def library() -> BuiltInLibrary:
    return built_in_library()


@pytest.mark.parametrize(
    ("text", "category"),
    [
        ("couch", "sofa"), ("settees", "sofa"), ("bedside table", "night stand"), ("nightstand", "night stand"),
        ("telly", "television"), ("bookcases", "bookshelf"), ("sofaa", "sofa"), ("potted plant", "plant"),
    ],
)  # fmt: skip
def test_synonyms_plurals_and_slips(library: BuiltInLibrary, text: str, category: str) -> None:
    found = search(library, text, 3)
    assert found
    assert {s.category for s in found} == {category}


@pytest.mark.parametrize(
    ("text", "shape_id"),
    [
        ("round oak table", "table-round-oak"), ("brown leather chesterfield", "sofa-chesterfield"),
        ("oak bookcase", "bookshelf-oak-four"), ("rocking chair", "armchair-rocking"),
    ],
)  # fmt: skip
def test_words_of_the_caption_rank_first(library: BuiltInLibrary, text: str, shape_id: str) -> None:
    assert search(library, text, 1)[0].id == shape_id


def test_style_words_count(library: BuiltInLibrary) -> None:
    assert {s.style for s in search(library, "industrial table", 2)} == {"industrial"}


def test_no_words_list_everything_in_order(library: BuiltInLibrary) -> None:
    assert search(library, "  ", 5) == library.shapes()[:5]


def test_nonsense_finds_nothing(library: BuiltInLibrary) -> None:
    assert search(library, "qwxzzk") == ()
    assert kinds_described("qwxzzk of the") == {}


def test_meaning_counts(library: BuiltInLibrary) -> None:
    wooden = search(library, "wooden armchair", 3)
    assert {s.category for s in wooden} == {"armchair"}
    assert all(any(w in s.caption for w in ("oak", "walnut", "mahogany", "wooden", "pine")) for s in wooden)
    assert "sofa" in {s.category for s in search(library, "grey sofa", 3)}
    assert "grey" in search(library, "gray sofa", 1)[0].caption


def test_comparative_sizes_order_a_category(library: BuiltInLibrary) -> None:
    def volumes(text: str) -> list[float]:
        return [float(np.prod(s.size_m)) for s in search(library, text, 3)]

    assert max(volumes("small table")) < min(volumes("large table"))
    heights = [s.size_m[2] for s in search(library, "tall bookshelf", 3)]
    assert min(heights) > np.median([s.size_m[2] for s in library.in_category("bookshelf")])


def test_a_size_in_the_text_finds_that_size(library: BuiltInLibrary) -> None:
    desk = library.in_category("desk")[0]
    x, y, z = desk.size_m
    assert search(library, f"desk {100 * y:.0f} x {100 * x:.0f} x {100 * z:.0f} cm", 1)[0].size_m == desk.size_m


def test_special_kinds_follow_the_general_one(library: BuiltInLibrary) -> None:
    kinds = [s.category for s in search(library, "chair", 200)]
    assert kinds[0] == "chair"
    assert "high chair" in kinds
    assert kinds.index("high chair") > len(library.in_category("chair")) - 1


def test_unknown_nouns_are_noted_and_describing_words_are_not(library: BuiltInLibrary) -> None:
    found = find(library, "chifforobe", 3)
    assert {s.category for s in found.shapes} == {"wardrobe"}
    assert "nearest is 'wardrobe'" in found.note
    assert find(library, "oak").note == ""
    assert "not known" in find(library, "qwxzzk").note


def test_a_shapes_own_synonyms_are_found() -> None:
    record = Shape("x1", "box", "a plain thing", (0.4, 0.4, 0.4), synonyms=("tea caddy",))
    assert TextIndex([record]).scores(understand("caddies"))[0] > 0


def test_the_index_follows_a_library_that_grows(tmp_path: Path) -> None:
    store = StoredLibrary(tmp_path, create=True)
    assert search(store, "sofa") == ()
    record = Shape("mine", "sofa", "my own settee", (0.9, 1.9, 0.8))
    store.add(Ingested(record, b"", None, "key"))
    assert search(store, "couch") == (record,)


def test_name_colour_and_limit_of_size_in_one_query(library: BuiltInLibrary) -> None:
    found = search(library, "small black chair under 50 cm", 4)
    assert all("chair" in s.category and s.size_m[1] <= 0.5 for s in found)
    assert any("black" in s.caption for s in found)
    high = search(library, "bookshelf at least 2 m high", 3)
    assert all(s.category == "bookshelf" and s.size_m[2] >= 2.0 for s in high)


def test_limits_of_size_are_read_and_left_out_of_the_words() -> None:
    rest, limits = size_limits("black chair under 50 cm and over 1.2 m tall")
    assert rest.split() == ["black", "chair", "and"]
    assert limits == (SizeLimit("width", 0.5, True), SizeLimit("height", 1.2, False))
    assert size_limits("lamp under the desk") == ("lamp under the desk", ())


def test_colours_count_in_descriptions(library: BuiltInLibrary) -> None:
    found = search(library, "something white to keep food cold", 2)
    assert {s.category for s in found} == {"refrigerator"}
    assert any("white" in s.caption for s in found)


def test_descriptions_find_their_kind(library: BuiltInLibrary) -> None:
    first = five = 0
    for text, kinds in DESCRIPTIONS:
        found = [s.category for s in find(library, text, 5).shapes]
        first += bool(found) and found[0] in kinds
        five += bool(set(found) & set(kinds))
    assert first >= 24
    assert five >= 26


def test_every_kind_is_found_by_its_own_definition() -> None:
    from diorama_core.library.search import _lines

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
