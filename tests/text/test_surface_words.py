from __future__ import annotations

import pytest

from diorama_core.text.surface_words import covering_in_words
from tests.text.edited import living_room


@pytest.mark.parametrize(
    ("words", "pattern"),
    [("brick", "brick"), ("oak boards", "boards"), ("white metro tiles", "metro"), ("light blue", "paint"),
     ("striped wallpaper", "stripes"), ("wooden", "boards"), ("grey carpet", "carpet"),
     ("walnut herringbone", "herringbone")],
)  # fmt: skip
def test_coverings_have_their_words(words: str, pattern: str) -> None:
    found = covering_in_words(words, living_room().plane("floor"))
    assert found is not None
    assert found.pattern == pattern


@pytest.mark.parametrize("words", ["zorkmid", "the lamp", "", "darker lamp"])
def test_other_words_name_no_covering(words: str) -> None:
    assert covering_in_words(words, living_room().plane("floor")) is None


def test_darker_is_of_what_there_is() -> None:
    plane = living_room().plane("wall_0")
    darker = covering_in_words("a bit darker", plane)
    assert darker is not None
    assert sum(darker.colour) < sum(plane.colour)
