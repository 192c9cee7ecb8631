from __future__ import annotations

from pathlib import Path

import pytest

from diorama_core.library.catalogue import BuiltInLibrary, built_in_library
from diorama_core.library.search import search


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> BuiltInLibrary:
    folder: Path = tmp_path_factory.mktemp("cache")
    return built_in_library(folder)


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
