"""What plain words and data sets' labels mean."""

from __future__ import annotations

import pytest

from diorama_core.library.hyponyms import FREQUENCIES, meanings
from diorama_core.library.labels import understand_label
from diorama_core.library.taxonomy import CATEGORIES, UNKNOWN

NAMES = {c.name for c in CATEGORIES}


def test_every_row_speaks_of_known_kinds() -> None:
    assert set(FREQUENCIES) <= NAMES


@pytest.mark.parametrize("name", [c.name for c in CATEGORIES if c is not UNKNOWN])
def test_meanings_are_probabilities_that_include_the_word_itself(name) -> None:
    shares = meanings(name, name)
    assert sum(shares.values()) == pytest.approx(1.0)
    assert shares[name] > 0
    assert list(shares.values()) == sorted(shares.values(), reverse=True)


@pytest.mark.parametrize(
    ("label", "kind"),
    [("chair", "office chair"), ("Chairs", "armchair"), ("chair 2", "office chair"), ("red chair", "office chair"),
     ("table", "desk"), ("cabinet", "filing cabinet"), ("lamp", "floor lamp"), ("shelf", "bookshelf"),
     ("light", "ceiling lamp"), ("kitchen_dining_room_table", "desk")],
)  # fmt: skip
def test_loose_words_may_mean(label, kind) -> None:
    assert meanings(label, understand_label(label).category.name)[kind] > 0.02


@pytest.mark.parametrize("label", ["dining chair", "swivel chair", "wing chair", "bedside table"])
def test_words_that_say_which_leave_little_to_others(label) -> None:
    category = understand_label(label).category.name
    assert meanings(label, category)[category] > 0.85


def test_something_without_a_name_may_be_anything_common_objects_first() -> None:
    shares = meanings("object", UNKNOWN.name)
    assert set(shares) == NAMES - {UNKNOWN.name}
    assert next(iter(shares)) == "chair"
