"""Words that are used loosely, and labels of data sets."""

from __future__ import annotations

from diorama_core.library.loose_words import LABELS, MEANINGS
from diorama_core.library.taxonomy import CATEGORIES

NAMES = {c.name for c in CATEGORIES}


def test_every_row_speaks_of_known_kinds() -> None:
    assert {kind for row in MEANINGS.values() for kind in row} <= NAMES
    assert set(LABELS.values()) <= NAMES | set(MEANINGS)


def test_no_word_has_two_rows() -> None:
    assert not set(LABELS) & set(MEANINGS)
